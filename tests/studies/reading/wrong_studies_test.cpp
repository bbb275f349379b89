#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "studies/reading/study.hpp"
#include "tests/results/temporary_directory.hpp"
#include "tests/studies/small_studies.hpp"

namespace wrong_studies_test {
namespace {

using frahm::studies::read_study;
using frahm::studies::StudyError;

const std::filesystem::path folder = FRAHM_SOURCE_DIR "/tests/studies/reading/wrong";
constexpr std::size_t least_studies = 45;  // so that an empty folder does not pass

std::vector<std::filesystem::path> wrong_studies() {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".toml") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

struct Refusal {
  std::string rule;     // its key
  std::string message;  // without the study's path
};

Refusal refusal_of(const std::filesystem::path& path) {
  try {
    read_study(path);
  } catch (const StudyError& error) {
    const std::string message = error.what(), before = path.string() + ":";
    CHECK_THAT(message, Catch::StartsWith(before));
    return {std::string(error.rule().key), message.substr(std::min(before.size(), message.size()))};
  }
  return {"none", "the study was read"};
}

// The first line of each wrong study, such as
//   # expect: 12:9 unknown_key | element "guide" | "stifness" | "stiffness"
// says where it is refused, the rule that it breaks, and what the message names, in this order.
struct Expected {
  std::string place, rule;
  std::vector<std::string> names;
};

Expected expected_of(const std::filesystem::path& path) {
  const std::string mark = "# expect: ";
  std::string line;
  std::getline(std::ifstream(path), line);
  REQUIRE(line.starts_with(mark));
  std::vector<std::string> parts;
  for (std::string rest = line.substr(mark.size());;) {
    const std::size_t end = rest.find(" | ");
    parts.push_back(rest.substr(0, end));
    if (end == std::string::npos) break;
    rest.erase(0, end + 3);
  }
  const std::size_t space = parts.front().find(' ');
  REQUIRE(space != std::string::npos);
  return {parts.front().substr(0, space), parts.front().substr(space + 1), {parts.begin() + 1, parts.end()}};
}

TEST_CASE("every wrong study is refused at its place, by the rule it breaks, with the name that breaks it") {
  const auto paths = wrong_studies();
  CHECK(paths.size() >= least_studies);
  for (const auto& path : paths) {
    const Expected expected = expected_of(path);
    const Refusal refusal = refusal_of(path);
    INFO(path.filename().string() << ": " << refusal.rule << ": " << refusal.message);
    CHECK(refusal.rule == expected.rule);
    CHECK_THAT(refusal.message, Catch::StartsWith(expected.place + ": "));
    std::size_t at = 0;
    for (const std::string& name : expected.names) {
      INFO("named: " << name);
      at = refusal.message.find(name, at);
      REQUIRE(at != std::string::npos);
      at += name.size();
    }
  }
}

TEST_CASE("more parameters than a study may have are refused at their section") {
  const TemporaryDirectory made;
  const std::filesystem::path path = made / "many.toml";
  const auto write = [&](int parameters) {
    std::ofstream file(path);
    file << "[study]\nschema = 1\nkind = \"sweep\"\nunits = \"dimensionless\"\n[parameters]\nr = 0.9\n";
    for (int i = 1; i < parameters; ++i) file << 'p' << i << " = 1\n";
    file << "[[mass]]\nname = \"main\"\nmass = 1\n[[element]]\nname = \"spring\"\ntype = \"spring\"\n"
            "between = [\"ground\", \"main\"]\nstiffness = 1\n[excitation]\nfrequency = \"r\"\n"
            "[[excitation.force]]\non = \"main\"\namplitude = 1\n"
         << small_studies::axis("r", 0.2, 0.4, 3);
  };
  write(2001);
  const Refusal refusal = refusal_of(path);
  CHECK(refusal.rule == "too_large");
  CHECK_THAT(refusal.message,
             Catch::Contains("[parameters]") && Catch::Contains("2001") && Catch::Contains("at most 2000"));
  write(2000);
  CHECK(refusal_of(path).rule == "none");
}

// A few whole sentences, so that what users read is seen by somebody when it changes.
TEST_CASE("a refusal says what was found, the rule and the nearest name") {
  const std::map<std::string, std::string> sentences{
      {"axis_parameter_unknown",
       "34:13: axis \"omgea\": parameter: no parameter is called \"omgea\"; did you mean \"omega\"?"},
      {"axis_points_missing", "33:1: axis \"omega\": the key \"points\" is missing"},
      {"axis_unit_of_another_dimension",
       "35:8: axis \"omega\": unit: the unit \"kg\" is that of a mass, but an angular frequency is expected "
       "(such as rad/s, rpm or Hz); the parameter is used as [excitation]: frequency"},
      {"element_without_moving_node",
       "23:11: element \"damper\": between: neither \"ground\" nor \"base\" is a mass, so nothing moves the "
       "element freely"},
      {"mass_negative", "12:8: mass \"main\": mass: is -102.66 kg; must be >= 0"},
      {"compare_law_and_profile",
       "40:1: [compare]: needs either \"law\", another friction law, \"taylor_order\", another crank "
       "profile, "
       "or \"show\", another of several responses; it has law and taylor_order"},
      {"data_comma_mixed",
       "11:8: [[identify.record]] \"low\": data/decay_comma_mixed.csv:3: separated by commas, but line 1 by "
       "semicolons; all rows are separated alike, and decimals are written with a point"},
      {"mass_floating_two",
       "14:1: the masses \"tmd\" and \"tip\" float free: no chain of springs leads to ground or to a node of "
       "prescribed motion, so the stiffness matrix is not positive definite; a weak spring to ground, with a "
       "frequency far below those of interest, holds them"},
      {"output_orbit_out_of_range",
       "24:11: element \"damper\": damping: is -1 N s/m at c = -1 N s/m ([output]: orbits); must be >= 0"},
      {"transient_coordinate_without_axis",
       "36:3: the section \"coordinate\" is not part of a transient: without an [[axis]] it computes one "
       "motion, "
       "not a map"},
      {"expression_function_unknown",
       "24:12: element \"damper\": damping: no function is called \"squrt\"; did you mean \"sqrt\"?"},
      {"units_unknown",
       "5:9: [study]: units: \"imperial\" is not possible here; write \"SI\" or \"dimensionless\""},
  };
  for (const auto& [study, sentence] : sentences) {
    INFO(study);
    CHECK_THAT(refusal_of(folder / (study + ".toml")).message, Catch::StartsWith(sentence + "\n"));
  }
}

}  // namespace
}  // namespace wrong_studies_test
