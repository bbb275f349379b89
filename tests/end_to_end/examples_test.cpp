// The examples in the documents: whole studies are right, commands and their options exist.

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/end_to_end/runs.hpp"

namespace frahm::examples_test {
namespace {

namespace fs = std::filesystem;

const fs::path root = FRAHM_SOURCE_DIR;

// A block of code in a document.
struct Example {
  std::string document, language, text;
};

std::vector<Example> examples() {
  std::vector<fs::path> documents;
  for (const auto& entry : fs::directory_iterator(root)) documents.push_back(entry.path());
  for (const char* room : {"engine", "results", "solvers", "studies", "tests"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / room)) documents.push_back(entry.path());
  }
  std::vector<Example> found;
  for (const fs::path& document : documents) {
    if (document.extension() != ".md" || document.string().find("node_modules") != std::string::npos)
      continue;
    std::ifstream stream(document);
    bool in_block = false;
    for (std::string line; std::getline(stream, line);) {
      if (line.starts_with("```")) {
        in_block = !in_block;
        if (in_block) found.push_back({document.string(), line.substr(3), ""});
      } else if (in_block) {
        found.back().text += line + "\n";
      }
    }
  }
  return found;
}

bool is_whole_study(const Example& example) {
  const auto has = [&](const char* section) { return example.text.find(section) != std::string::npos; };
  return example.language == "toml" && has("[study]") && has("schema") && has("[[mass]]");
}

// The words of a line, without comment and quotes.
std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line.substr(0, line.find(" #")));
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

TEST_CASE("every whole study in the documents is right") {
  const runs::Folder folder;
  int studies = 0;
  for (const Example& example : examples()) {
    if (!is_whole_study(example)) continue;
    const runs::Outcome checked = runs::frahm({"check", folder.write("example.toml", example.text)});
    INFO(example.document << '\n' << checked.err);
    CHECK(checked.code == 0);
    ++studies;
  }
  CHECK(studies >= 1);
}

TEST_CASE("the commands in the documents and their options exist") {
  const std::regex option(R"(--[a-z][a-z-]*)");
  int commands = 0;
  for (const Example& example : examples()) {
    if (example.language != "sh") continue;
    std::istringstream lines(example.text);
    for (std::string line; std::getline(lines, line);) {
      const std::size_t at = line.find("frahm ");
      if (at == std::string::npos || line.find('#') < at) continue;
      const std::vector<std::string> words = words_of(line.substr(at));
      if (words.size() < 2 || words[1].starts_with("--") || words[1].find('/') != std::string::npos) continue;
      INFO(example.document << ": " << line);
      const runs::Outcome help = runs::frahm({words[1], "--help"});
      CHECK(help.code == 0);
      for (const std::string& word : words) {
        std::smatch name;
        if (!std::regex_search(word, name, option, std::regex_constants::match_continuous)) continue;
        INFO(name.str());
        CHECK(help.out.find(name.str()) != std::string::npos);
      }
      ++commands;
    }
  }
  CHECK(commands > 15);
}

TEST_CASE("the first study of the README runs as it says") {
  const runs::Folder folder;
  for (const Example& example : examples()) {
    if (example.document != (root / "README.md").string() || !is_whole_study(example)) continue;
    const std::string study = folder.write("machine.toml", example.text), file = folder / "machine.h5";
    CHECK(runs::frahm({"point", study, "--at", "speed=600 rpm,F=40"}).code == 0);
    REQUIRE(runs::frahm({"run", study, "-o", file, "--progress", "none"}).code == 0);
    CHECK(runs::read_map(file)["machine_peak"].size() == 4 * 451);
    return;
  }
  FAIL("the README has no study");
}

TEST_CASE("the walk-through ends with the numbers that it tells") {
  const runs::Folder folder;
  std::string study, told;
  for (const Example& example : examples()) {
    if (!example.document.ends_with("walkthrough.md")) continue;
    if (is_whole_study(example)) study = example.text;
    if (example.language == "text") told = example.text;
  }
  const std::string place = folder.write("two_absorbers.toml", study), result = folder / "two_absorbers.h5";
  const runs::Outcome run = runs::frahm({"run", place, "-o", result, "--progress", "none"});
  REQUIRE(run.code == 0);
  REQUIRE(told.size() > 100);
  // The optimum is known to its KKT residual, so that its last digits are the machine's own.
  const auto cut = [](const std::string& text) {
    return std::regex_replace(text, std::regex(R"((\d\.\d{5})\d+)"), "$1");
  };
  std::istringstream lines(told);
  for (std::string line; std::getline(lines, line);) {
    INFO(line << "\nis not in\n" << run.out);
    CHECK(cut(run.out).find(cut(line)) != std::string::npos);
  }
  const std::string sweep = folder / "optimum.toml";
  CHECK(runs::frahm({"export", result, "--sweep", sweep}).code == 0);
  CHECK(runs::frahm({"check", sweep}).code == 0);
}

}  // namespace
}  // namespace frahm::examples_test
