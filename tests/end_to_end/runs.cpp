#include "tests/end_to_end/runs.hpp"

#include <stdlib.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "studies/program/program.hpp"
#include "tests/study_path.hpp"

namespace runs {
namespace {

// Takes what is written to stderr as long as it lives.
class Stderr {
 public:
  Stderr() : before_(std::cerr.rdbuf(text_.rdbuf())) {}
  ~Stderr() { std::cerr.rdbuf(before_); }
  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::streambuf* before_;
};

}  // namespace

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

Outcome frahm(const std::vector<std::string>& arguments) {
  std::vector<const char*> argv{"frahm"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  const Stderr err;
  std::ostringstream out;
  const int code = ::frahm::studies::run_program(static_cast<int>(argv.size()), argv.data(), out);
  return {code, out.str(), err.text()};
}

std::string reduced(const std::string& name, const std::map<std::string, int>& points) {
  std::istringstream text(text_of(study_path(name)));
  std::string result, line, parameter;
  while (std::getline(text, line)) {
    if (line.starts_with("parameter = ")) parameter = line.substr(13, line.size() - 14);
    const auto wanted = points.find(parameter);
    if (line.starts_with("points = ") && wanted != points.end()) {
      line = "points = " + std::to_string(wanted->second);
    }
    result += line + '\n';
  }
  return result;
}

std::string replaced(std::string text, const std::string& passage, const std::string& by) {
  const std::size_t place = text.find(passage);
  if (place == std::string::npos) throw std::runtime_error("the study has no \"" + passage + "\"");
  return text.replace(place, passage.size(), by);
}

Folder::Folder() {
  std::string path = (std::filesystem::temp_directory_path() / "frahm-end-to-end-XXXXXX").string();
  if (::mkdtemp(path.data()) == nullptr) throw std::runtime_error("cannot make " + path);
  path_ = path;
}

Folder::~Folder() {
  std::filesystem::remove_all(path_);
}

std::string Folder::write(const std::string& name, const std::string& text) const {
  std::ofstream(path_ / name) << text;
  return *this / name;
}

std::vector<std::string> Folder::names() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(path_)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

const std::vector<double>& Map::coordinate(const std::string& name) const {
  for (const auto& axis : layout.axes) {
    for (const auto& each : axis.coordinates) {
      if (each.name == name) return each.values;
    }
  }
  throw std::out_of_range("no coordinate " + name);
}

const std::vector<double>& Map::operator[](const std::string& name) const {
  return values.at(name);
}

Map read_map(const std::string& path) {
  const ::frahm::results::MapReader reader(path);
  Map map{.layout = reader.layout(), .values = {}};
  std::vector<std::uint64_t> start, count;
  for (const auto& axis : map.layout.axes) {
    start.push_back(0);
    count.push_back(axis.size);
  }
  for (std::size_t v = 0; v < map.layout.variables.size(); ++v) {
    map.values[map.layout.variables[v].name] = reader.read(v, start, count);
  }
  return map;
}

Map run_study(const std::string& text) {
  const Folder folder;
  const std::string study = folder.write("study.toml", text);
  const Outcome outcome =
      frahm({"run", study, "-o", folder / "study.h5", "--threads", "1", "--progress", "none"});
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  CHECK(folder.names() == std::vector<std::string>{"study.h5", "study.toml"});
  return read_map(folder / "study.h5");
}

}  // namespace runs
