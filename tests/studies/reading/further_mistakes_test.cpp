#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "studies/reading/parse_study.hpp"
#include "tests/studies/small_studies.hpp"

namespace further_mistakes_test {
namespace {

using namespace small_studies;

// The study with parts of its text replaced.
std::string with(std::string text, const std::vector<std::pair<std::string, std::string>>& changes) {
  for (const auto& [old, now] : changes) {
    REQUIRE(text.find(old) != std::string::npos);
    text.replace(text.find(old), old.size(), now);
  }
  return text;
}

const std::string study = oscillator() + axis("r", 0.2, 2, 31) + "[output]\nprecision = \"single\"\n";

std::string refusal_of(const std::string& text) {
  try {
    frahm::studies::parse_study(text, "s.toml");
  } catch (const frahm::studies::StudyError& error) {
    return error.what();
  }
  return "";
}

// Where the mistakes are that are told: "7 12".
std::string lines_of(const std::string& refusal) {
  std::string lines;
  const std::string before = "s.toml:";
  for (std::size_t at = 0; (at = refusal.find(before, at)) != std::string::npos;) {
    at += before.size();
    lines += (lines.empty() ? "" : " ") + refusal.substr(at, refusal.find(':', at) - at);
  }
  return lines;
}

TEST_CASE("a study without mistakes is read") {
  CHECK(refusal_of(study).empty());
}

TEST_CASE("all mistakes of a study are told at once, in the order of the file, with their number") {
  const std::string refusal = refusal_of(with(study, {{"zeta = 0.05", "zeta = \"0.05 +\""},
                                                      {"stiffness = 1", "stiffness = [1]"},
                                                      {"points = 31", "points = 31\nspacin = \"log\""},
                                                      {"\"single\"", "\"singl\""}}));
  CHECK(lines_of(refusal) == "9 18 39 41");
  CHECK_THAT(refusal, Catch::EndsWith("\n4 mistakes"));
}

TEST_CASE("what only follows from a mistake that is told is not told") {
  // Without the parameter f no force is known, without the spring the mass floats.
  CHECK(lines_of(refusal_of(with(study, {{"f = 0.2", "f = \"0.2 +\""}}))) == "8");
  CHECK(lines_of(refusal_of(with(study, {{"\"spring\"\nbetween", "\"sprung\"\nbetween"}}))) == "16");
  CHECK(lines_of(refusal_of(with(study, {{"name = \"main\"", "name = \"the main\""}}))) == "12");
  // An unknown key in place of one that the table needs.
  CHECK(lines_of(refusal_of(with(study, {{"stiffness = 1", "stifness = 1"}}))) == "18");
}

TEST_CASE("two mistakes in one table are both told") {
  CHECK(lines_of(refusal_of(with(study, {{"force = \"f\"", "force = \"f +\"\nslop = 2"}}))) == "28 29");
}

TEST_CASE("what is missing in one table says nothing of another") {
  const std::string refusal =
      refusal_of(with(study, {{"stiffness = 1\n", ""}, {"damping = \"2*zeta\"\n", ""}}));
  CHECK(lines_of(refusal) == "14 18");
}

TEST_CASE("a table that is wrong for the same reason without its parts is told once") {
  CHECK(lines_of(refusal_of(with(study, {{"[[excitation.force]]", "[[excitatio.force]]"}}))) == "31");
}

TEST_CASE("tables are counted as they stand in the file") {
  const std::string refusal = refusal_of(
      with(study, {{"\"spring\"\nbetween", "\"sprung\"\nbetween"}, {"name = \"friction\"", "name = 3"}}));
  CHECK(lines_of(refusal) == "16 25");
  CHECK_THAT(refusal, Catch::Contains("[[element]] 3: name"));
}

TEST_CASE("a name is not told to be unknown where what is left out may have it") {
  CHECK(lines_of(refusal_of(with(study, {{"name = \"main\"", "name = \"m*\""}}))) == "12");
  CHECK(lines_of(refusal_of(with(study, {{"name = \"main\"\n", ""}}))) == "11");
}

TEST_CASE("a text that is no TOML has one mistake") {
  CHECK(lines_of(refusal_of(with(study, {{"k = 1", "k = = 1"}, {"points = 31", "point = 31"}}))) == "10");
}

}  // namespace
}  // namespace further_mistakes_test
