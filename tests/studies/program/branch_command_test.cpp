#include "studies/program/branch_command.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>
#include <string>

#include "results/map_reader.hpp"
#include "solvers/orbits/closed_forms.hpp"
#include "studies/reading/text/study_source.hpp"
#include "tests/results/temporary_directory.hpp"
#include "tests/studies/small_studies.hpp"

namespace branch_command_test {
namespace {

using Catch::Matchers::WithinAbs;
using frahm::studies::branch_command;
using frahm::studies::BranchCommandOptions;
using frahm::studies::StudyError;
namespace rules = frahm::studies::rules;

constexpr double kAgreement = 1e-9;  // with closed forms
const double zeta = 0.05;

struct StudyOnDisk {
  explicit StudyOnDisk(const std::string& text) { std::ofstream(path) << text; }

  TemporaryDirectory folder;
  std::filesystem::path path = folder / "study.toml";
};

const std::string text = small_studies::oscillator() + small_studies::axis("r", 0.3, 2.0, 5);

std::string told(const BranchCommandOptions& options, int code = 0) {
  std::ostringstream out;
  CHECK(branch_command(options, out) == code);
  return out.str();
}

// The number at this column of the line that begins with a word.
double number_in(const std::string& report, const std::string& line, int column) {
  std::istringstream cells(report.substr(report.find("\n" + line)));
  std::string cell;
  for (int i = 0; i <= column; ++i) cells >> cell;
  return std::stod(cell);
}

TEST_CASE("A branch along friction tells where stops begin, as Den Hartog's limit has it") {
  const StudyOnDisk study(text);
  const std::string report = told({.study = study.path,
                                   .along = "f",
                                   .from = "0",
                                   .to = "0.9",
                                   .at = {"r=0.5,f=0.1"},
                                   .progress = frahm::engine::ProgressStyle::none});
  CHECK_THAT(number_in(report, "grazing", 1),
             WithinAbs(frahm::periodic::critical_friction(0.5, zeta), kAgreement));
  CHECK(report.find("friction") != std::string::npos);
  CHECK(report.find("the range of the parameter ends") != std::string::npos);
}

TEST_CASE("The file of a branch has every point, from one end of the axis to the other") {
  const StudyOnDisk study(text);
  const auto file = study.path.parent_path() / "branch.csv";
  told({.study = study.path, .along = "r", .output = file});
  std::ifstream lines(file);
  std::string header, line, first, last;
  std::getline(lines, header);
  CHECK(header.starts_with("r,main_peak,"));
  CHECK(header.ends_with(",largest_multiplier,stable,multiple,special"));
  std::size_t rows = 0;
  for (; std::getline(lines, line); ++rows) (rows == 0 ? first : last) = line;
  CHECK(rows > 50);
  CHECK_THAT(std::stod(first), WithinAbs(0.3, kAgreement));
  CHECK_THAT(std::stod(last), WithinAbs(2.0, kAgreement));
  const double peak = std::stod(last.substr(last.find(',') + 1));
  CHECK_THAT(peak, WithinAbs(frahm::periodic::classical_amplitude(2.0, zeta, 0.2), kAgreement));
}

// Each slider of an iwan element may stop, and they are told as one element.
TEST_CASE(
    "A branch of a system with sliders side by side is kept, its special points by the element's name") {
  const StudyOnDisk study(
      "[study]\nschema = 1\nkind = \"sweep\"\nunits = \"dimensionless\"\n[parameters]\nr = 1\n"
      "[[mass]]\nname = \"m\"\nmass = 1\n"
      "[[element]]\nname = \"k\"\ntype = \"spring\"\nbetween = [\"ground\", \"m\"]\nstiffness = 1\n"
      "[[element]]\nname = \"w\"\ntype = \"iwan\"\nbetween = [\"ground\", \"m\"]\n"
      "stiffnesses = [1, 2]\nforces = [0.1, 0.2]\n"
      "[excitation]\nfrequency = \"r\"\n[[excitation.force]]\non = \"m\"\namplitude = 1\n" +
      small_studies::axis("r", 0.2, 1.0, 5));
  const auto file = study.path.parent_path() / "branch.h5";
  const std::string report = told({.study = study.path, .along = "r", .output = file});
  const frahm::results::MapReader result(file);
  for (const frahm::results::Column& column : result.columns("branches")) {
    if (column.variable.name != "special_element") continue;
    CHECK(std::ranges::count(column.variable.flags, "w", &frahm::results::Flag::meaning) == 1);
    const bool is_special = report.find("special points         none") == std::string::npos;
    CHECK((std::ranges::count(column.values, 2.0) > 0) == is_special);
  }
}

TEST_CASE("A branch without a response to start from says why") {
  const StudyOnDisk study(text);
  const std::string report = told({.study = study.path, .along = "r", .multiple = 2}, 3);
  CHECK(report.find("no response to start from at r = 0.3") != std::string::npos);
}

void check_refusal(const BranchCommandOptions& options, const frahm::studies::Rule& rule,
                   const std::string& named) {
  std::ostringstream out;
  try {
    branch_command(options, out);
    FAIL("accepted, against the rule " << rule.key);
  } catch (const StudyError& error) {
    INFO(error.what());
    CHECK(error.rule() == rule);
    CHECK(std::string(error.what()).find(named) != std::string::npos);
  }
}

TEST_CASE("Wrong use of a branch is refused by what is wrong") {
  const StudyOnDisk study(text);
  check_refusal({.study = study.path, .along = "rr"}, rules::unknown_name, "--along rr");
  check_refusal({.study = study.path, .along = "f"}, rules::wrong_option, "--from");
  check_refusal({.study = study.path, .along = "r", .from = "2", .to = "1"}, rules::wrong_order, "--from 2");
  check_refusal({.study = study.path, .along = "r", .at = {"r=3"}}, rules::out_of_range, "r = 3");
  check_refusal({.study = study.path, .along = "f", .from = "-1", .to = "1"}, rules::out_of_range,
                "friction");
  check_refusal({.study = study.path, .along = "r", .output = "-"}, rules::wrong_option, "--output");
}

TEST_CASE("a range or start that is wrong is told in the study's unit") {
  const StudyOnDisk study(
      "[study]\nschema = 1\nkind = \"sweep\"\n[parameters]\nw = 1\n[[mass]]\nname = \"m\"\nmass = 1\n"
      "[[element]]\nname = \"s\"\ntype = \"spring\"\nbetween = [\"ground\", \"m\"]\nstiffness = 4e4\n"
      "[excitation]\nfrequency = \"w\"\n[[excitation.force]]\non = \"m\"\namplitude = 1\n"
      "[[axis]]\nparameter = \"w\"\nunit = \"Hz\"\nfrom = 1\nto = 2\npoints = 3\n");
  std::ostringstream out;
  CHECK_THROWS_WITH(branch_command({.study = study.path, .along = "w", .from = "30", .to = "20 Hz"}, out),
                    Catch::Contains("--from 30 Hz: must be below --to, 20 Hz"));
  CHECK_THROWS_WITH(branch_command({.study = study.path, .along = "w", .at = {"w=50"}}, out),
                    Catch::Contains("--at w = 50 Hz: must be within the range of the branch, 1 Hz to 2 Hz"));
}

}  // namespace
}  // namespace branch_command_test
