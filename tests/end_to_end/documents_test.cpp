// The documents: links that lead somewhere, a README that stays short, tables that can be read.

#include <catch2/catch.hpp>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "solvers/quantities/quantity_table.hpp"

namespace frahm::documents_test {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_cell = 200;          // characters, for a table that is read on a screen
constexpr std::uintmax_t longest_readme = 12'000;  // bytes

const fs::path root = FRAHM_SOURCE_DIR;

std::vector<fs::path> documents() {
  std::vector<fs::path> found;
  for (const char* file : {"README.md", "CONTRIBUTING.md"}) found.push_back(root / file);
  for (const char* room : {"engine", "results", "solvers", "studies", "tests"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / room)) {
      const bool is_foreign = entry.path().string().find("node_modules") != std::string::npos;
      if (entry.path().extension() == ".md" && !is_foreign) found.push_back(entry.path());
    }
  }
  return found;
}

// The lines outside of code blocks.
std::vector<std::string> lines_of(const fs::path& document) {
  std::ifstream stream(document);
  std::vector<std::string> lines;
  bool in_code = false;
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with("```"))
      in_code = !in_code;
    else if (!in_code)
      lines.push_back(line);
  }
  return lines;
}

// A heading as links name it: small letters, spaces as hyphens, no punctuation.
std::string anchor_of(const std::string& heading) {
  std::string anchor;
  for (const char c : heading.substr(heading.find_first_not_of("# "))) {
    const auto letter = static_cast<unsigned char>(c);
    if (c == ' ') anchor += '-';
    if (std::isalnum(letter) || c == '-' || c == '_') anchor += static_cast<char>(std::tolower(letter));
  }
  return anchor;
}

std::set<std::string> anchors_of(const fs::path& document) {
  std::set<std::string> anchors;
  for (const std::string& line : lines_of(document)) {
    if (line.starts_with("#")) anchors.insert(anchor_of(line));
  }
  return anchors;
}

TEST_CASE("links between documents lead to files and headings that exist") {
  const std::regex link(R"(\]\(([^)#]*)(#[^)]*)?\))");
  std::size_t links = 0;
  for (const fs::path& document : documents()) {
    for (const std::string& line : lines_of(document)) {
      for (std::sregex_iterator at(line.begin(), line.end(), link), end; at != end; ++at) {
        const std::string file = (*at)[1], heading = (*at)[2];
        if (file.find("://") != std::string::npos) continue;
        INFO(document.string() << ": " << at->str());
        const fs::path target = file.empty() ? document : document.parent_path() / file;
        CHECK(fs::exists(target));
        if (!heading.empty() && fs::exists(target)) CHECK(anchors_of(target).contains(heading.substr(1)));
        ++links;
      }
    }
  }
  CHECK(links > 50);
}

TEST_CASE("no cell of a table in the documents is longer than a reader takes in") {
  for (const fs::path& document : documents()) {
    for (const std::string& line : lines_of(document)) {
      if (!line.starts_with("|")) continue;
      std::istringstream cells(line);
      for (std::string cell; std::getline(cells, cell, '|');) {
        INFO(document.string() << ": " << cell);
        CHECK(cell.size() <= longest_cell + 2);
      }
    }
  }
}

TEST_CASE("the glossary has every quantity") {
  std::ifstream stream(root / "studies/glossary.md");
  std::stringstream text;
  text << stream.rdbuf();
  for (const periodic::QuantityRow& row : periodic::quantity_table()) {
    INFO(row.suffix);
    CHECK(text.str().find("`" + std::string(row.suffix) + "`") != std::string::npos);
  }
}

TEST_CASE("the README stays short") {
  CHECK(fs::file_size(root / "README.md") <= longest_readme);
}

}  // namespace
}  // namespace frahm::documents_test
