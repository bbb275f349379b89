#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "studies/reading/study_file.hpp"

namespace {

using frahm::studies::read_study;
using frahm::studies::StudyError;

constexpr std::size_t least_studies = 45;  // so that an empty folder does not pass

std::vector<std::filesystem::path> wrong_studies() {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(FRAHM_SOURCE_DIR "/tests/studies/wrong")) {
    if (entry.path().extension() == ".toml") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

// The first line of each wrong study: `# expect: 12:9: element "guide": ...`.
std::string expected_message(const std::filesystem::path& path) {
  const std::string mark = "# expect: ";
  std::string line;
  std::getline(std::ifstream(path), line);
  REQUIRE(line.starts_with(mark));
  return line.substr(mark.size());
}

// `12:9: `
bool begins_with_place(const std::string& message) {
  unsigned line = 0, column = 0;
  return std::sscanf(message.c_str(), "%u:%u: ", &line, &column) == 2 && line > 0 && column > 0;
}

std::string complaint_about(const std::filesystem::path& path) {
  try {
    read_study(path);
  } catch (const StudyError& error) {
    return error.what();
  }
  return "none: the study was read";
}

TEST_CASE("every wrong study is refused with its place and the message it says it expects") {
  const auto paths = wrong_studies();
  CHECK(paths.size() >= least_studies);
  for (const auto& path : paths) {
    const std::string expected = expected_message(path);
    INFO("expected: " << expected);
    CHECK(begins_with_place(expected));
    CHECK_THAT(complaint_about(path), Catch::StartsWith(path.string() + ":" + expected));
  }
}

}  // namespace
