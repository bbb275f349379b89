#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "results/map_reader.hpp"

// Runs of the program within the test.
namespace runs {

struct Outcome {
  int code = 0;
  std::string out, err;
};

// The program with these arguments, in this process.
Outcome frahm(const std::vector<std::string>& arguments);

// The text of studies/<name>.toml with fewer points on some axes: parameter -> points.
std::string reduced(const std::string& name, const std::map<std::string, int>& points);

// A study's text with one passage, which must be there, replaced.
std::string replaced(std::string text, const std::string& passage, const std::string& by);

std::string text_of(const std::string& path);  // of a file

// A folder of its own, removed with everything in it.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  // Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& text) const;
  std::vector<std::string> names() const;  // of the files in it, sorted

 private:
  std::filesystem::path path_;
};

// A result file with all values of its variables.
struct Map {
  frahm::results::MapLayout layout;
  std::map<std::string, std::vector<double>> values;
  const std::vector<double>& coordinate(const std::string& name) const;
  const std::vector<double>& operator[](const std::string& name) const;
};
Map read_map(const std::string& path);

// A study run to its end on one thread; fails the test if it does not end with code 0.
Map run_study(const std::string& text);

}  // namespace runs
