#include "studies/program/point_command.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "engine/io_error.hpp"
#include "solvers/orbits/closed_forms.hpp"
#include "studies/reading/study/study.hpp"
#include "tests/results/temporary_directory.hpp"
#include "tests/studies/small_studies.hpp"
#include "tests/study_path.hpp"

namespace point_command_test {
namespace {

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using frahm::studies::point_command;
using frahm::studies::PointOptions;
using frahm::studies::StudyError;

constexpr double agreement = 1e-9;  // with closed forms
constexpr double printed = 1e-9;    // ten digits

struct Told {
  int code = 0;
  std::string text;

  bool has(const std::string& part) const { return text.find(part) != std::string::npos; }

  // The number behind a name in the report.
  double number(const std::string& name) const {
    const std::size_t at = text.find("\n" + name + " ");
    if (at == std::string::npos) throw std::runtime_error("the report has no " + name);
    return std::stod(text.substr(at + 1 + name.size()));
  }

  // The value of a quantity in the JSON report.
  double json_number(const std::string& name) const {
    const std::size_t at = text.find("\"value\": ", text.find("\"" + name + "\": {"));
    return std::stod(text.substr(at + std::string("\"value\": ").size()));
  }
};

Told tell(const PointOptions& options) {
  std::ostringstream out;
  const int code = point_command(options, out);
  return {code, out.str()};
}

std::vector<std::vector<std::string>> read_csv(const std::filesystem::path& path) {
  std::vector<std::vector<std::string>> rows;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

TEST_CASE("A point tells its status, every quantity, the modes over the period and the natural frequencies") {
  const Told told = tell({.study = study_path("den_hartog"), .at = {"r=0.9", "f=0.1"}});
  CHECK(told.code == 0);
  CHECK(told.has("status ok\n"));
  CHECK(told.has("  zeta = 0.05\n"));
  CHECK(told.has("  r = 0.9\n"));
  const double exact = frahm::periodic::non_stop_response(0.9, 0.05, 0.1).amplitude;
  CHECK_THAT(told.number("main_amplitude"), WithinAbs(exact, agreement));
  CHECK_THAT(told.number("natural_frequency_1"), WithinAbs(1.0, printed));
  CHECK_THAT(told.number("modal_damping_1"), WithinAbs(0.05, printed));
  CHECK(told.has("non_stop"));
  CHECK(told.has("slides +"));
  CHECK(told.has("slides -"));
  CHECK(told.has("Undamped modes with all friction sliding"));
  CHECK(told.has("With all friction stuck nothing moves."));
}

TEST_CASE("A point of the rig is asked for and told in the units of the study") {
  const Told as_usual = tell({.study = study_path("rig_atlas"), .at = {"omega=250", "I=6.36"}});
  CHECK(as_usual.has("  omega = 250 rpm\n"));
  CHECK(as_usual.has("  A = 29.55 mm\n"));
  const Told in_hertz = tell({.study = study_path("rig_atlas"), .at = {"omega=4.1666666666666667 Hz"}});
  CHECK_THAT(in_hertz.number("main_peak"), WithinRel(as_usual.number("main_peak"), printed));
  CHECK(as_usual.number("energy_balance") < 1e-10);
  CHECK(as_usual.number("floquet_radius") < 1.0);
}

TEST_CASE("The same point is one JSON object, with null where there is no value") {
  const Told json = tell({.study = study_path("den_hartog"), .at = {"r=0.9", "f=0.1"}, .json = true});
  const double exact = frahm::periodic::non_stop_response(0.9, 0.05, 0.1).amplitude;
  CHECK(json.code == 0);
  CHECK_THAT(json.json_number("main_amplitude"), WithinAbs(exact, agreement));
  CHECK(json.json_number("friction_regime") == 2.0);
  CHECK(json.has("\"meaning\": \"non_stop\""));
  CHECK(json.has("\"sliding\": ["));

  const Told none = tell({.study = study_path("den_hartog"), .at = {"r=1", "f=0.5", "zeta=0"}, .json = true});
  CHECK(none.has("\"status\": \"unbounded\""));
  CHECK(none.has("\"value\": null"));
  CHECK_FALSE(none.has(" nan"));
}

TEST_CASE("A point without a response says why and shows no numbers for it") {
  const Told told = tell({.study = study_path("den_hartog"), .at = {"r=1", "f=0.5", "zeta=0"}});
  CHECK(told.code == 0);
  CHECK(told.has("status unbounded: an undamped mode"));
  CHECK_FALSE(told.has(" nan"));
  CHECK_FALSE(told.has("slides"));
}

TEST_CASE("A point without an error bound says why, in words and as JSON") {
  const std::vector<std::string> damped{"r=0.9", "f=0"}, undamped{"r=0.9", "f=0", "zeta=0"};
  CHECK_FALSE(tell({.study = study_path("den_hartog"), .at = damped}).has("no error bound"));
  const Told told = tell({.study = study_path("den_hartog"), .at = undamped});
  CHECK(told.has("status ok\n"));
  CHECK(told.has("\nno error bound: nothing damps the motion"));
  const Told json = tell({.study = study_path("den_hartog"), .at = undamped, .json = true});
  CHECK(json.has("\"why_no_error_bound\": \"nothing damps the motion"));
}

TEST_CASE("A point whose matrices have no meaning has failed, as it would in a map") {
  TemporaryDirectory directory;
  std::ofstream(directory / "weightless.toml") << R"([study]
schema = 1
kind = "sweep"
units = "dimensionless"
[parameters]
mass = 1
r = 0.5
[[mass]]
name = "main"
mass = "mass"
[[element]]
name = "spring"
type = "spring"
between = ["ground", "main"]
stiffness = 1
[excitation]
frequency = "r"
[[excitation.force]]
on = "main"
amplitude = 1
[[axis]]
parameter = "r"
from = 0.1
to = 0.9
points = 3
)";
  const Told told = tell({.study = directory / "weightless.toml", .at = {"mass=0"}});
  INFO(told.text);
  CHECK(told.code == 3);
  CHECK(told.has("status failed: "));
  CHECK(tell({.study = directory / "weightless.toml"}).code == 0);
  CHECK(tell({.study = directory / "weightless.toml", .set = {"mass=0"}}).code == 3);
}

TEST_CASE("A history is a CSV file of one period with names and their units above it") {
  TemporaryDirectory directory;
  const auto path = directory / "history.csv";
  const Told told = tell({.study = study_path("rig_atlas"), .at = {"omega=250"}, .history = path});
  const auto rows = read_csv(path);
  REQUIRE(rows.size() == 1 + 513);
  CHECK(rows[0][0] == "time [s]");
  CHECK(rows[0][1] == "main_displacement [m]");
  CHECK(std::find(rows[0].begin(), rows[0].end(), "tmd_friction_force [N]") != rows[0].end());
  CHECK_THAT(std::stod(rows.back()[0]), WithinRel(0.24, 1e-12));  // 60 / 250 s
  double largest = 0.0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    REQUIRE(rows[i].size() == rows[0].size());
    largest = std::max(largest, std::abs(std::stod(rows[i][1])));
  }
  const double between_samples = 2e-5;  // (pi/512)^2 / 2: how far a maximum may lie above its nearest sample
  CHECK_THAT(largest, WithinRel(told.number("main_peak"), between_samples));
  CHECK_THAT(std::stod(rows.back()[1]), WithinAbs(std::stod(rows[1][1]), 1e-10));
  CHECK(directory.parts() == 0);
}

TEST_CASE("A history that cannot be written is an error, and nothing is left of it") {
  TemporaryDirectory directory;
  const auto nowhere = directory / "no_such_folder/history.csv";
  PointOptions options{.study = study_path("den_hartog"), .history = nowhere};
  CHECK_THROWS_AS(tell(options), frahm::engine::IoError);

  std::filesystem::create_directory(directory / "folder");
  options.history = directory / "folder";
  CHECK_THROWS_AS(tell(options), frahm::engine::IoError);

  options.history = "-";
  CHECK_THROWS_WITH(tell(options), Catch::Contains("--history"));
  options = {
      .study = study_path("den_hartog"), .at = {"r=1,f=0.5,zeta=0"}, .history = directory / "none.csv"};
  CHECK_THROWS_WITH(tell(options), Catch::Contains("unbounded") && Catch::Contains("no time history"));
  CHECK_FALSE(std::filesystem::exists(directory / "none.csv"));
}

TEST_CASE("Wrong names, values and units of a point are told") {
  const auto at = [](const std::string& text) {
    return tell({.study = study_path("rig_atlas"), .at = {text}});
  };
  CHECK_THROWS_WITH(at("omgea=250"), Catch::Contains("omgea") && Catch::Contains("did you mean \"omega\""));
  CHECK_THROWS_WITH(at("omega=250 kg"), Catch::Contains("kg"));
  CHECK_THROWS_WITH(at("omega=-250"), Catch::Contains("must be > 0"));
  CHECK_THROWS_AS(at("omega"), StudyError);
  CHECK_THROWS_AS(tell({.study = "no_such_study.toml"}), StudyError);
}

TEST_CASE("A crank longer than anywhere on the grid is as good at a point, up to the longest that can be") {
  const auto at = [](const std::string& text) {
    return tell({.study = study_path("rig_crank"), .at = {"omega=250 rpm,I=6.36 kg,FP=0", text}});
  };
  CHECK(at("L=32.9 mm").has("status ok"));
  CHECK_THROWS_WITH(
      at("L=32 mm"),
      Catch::Contains("is 0.923438 times the rod at A = 29.55 mm, L = 32 mm; must be at most 0.9 times"));
}

TEST_CASE("the report of a large building has four floors, four elements and modes, and all when asked") {
  const TemporaryDirectory folder;
  PointOptions options{.study = folder / "building.toml"};
  std::ofstream(options.study) << small_studies::building(15, 5, 3);
  const Told excerpt = tell(options);
  options.all = true;
  const Told whole = tell(options);
  INFO(excerpt.text);
  for (const char* shown : {"floor1_peak", "floor6_peak", "floor10_peak", "floor15_peak", "spring1_stroke",
                            "natural_frequency_4", "transmitted_force"})
    CHECK_NOTHROW(excerpt.number(shown));
  for (const char* left_out : {"floor2_peak", "spring15_stroke", "natural_frequency_5"}) {
    CHECK_THROWS(excerpt.number(left_out));
    CHECK_NOTHROW(whole.number(left_out));
  }
  CHECK(excerpt.has(" quantities; --all shows all\n"));
  CHECK(excerpt.has("\n  12 of 15 modes, at 8 of 15 masses; --all shows all\n"));
  CHECK(!whole.has("--all"));
}

}  // namespace
}  // namespace point_command_test
