#include "studies/program/record_table.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <numbers>
#include <sstream>
#include <string>

#include "studies/reading/parse_study.hpp"
#include "tests/studies/temporary_folder.hpp"

namespace record_table_test {
namespace {

using namespace frahm::studies;
using Catch::Contains;

// What is told of records beside one mode of a period [s].
std::string told(const TemporaryFolder& folder, const std::string& record, double period,
                 const std::string& axis = "") {
  const Study study = parse_study(
      "[study]\nschema = 1\nkind = \"transient\"\n[[mass]]\nname = \"roof\"\nmass = 2\n"
      "[[element]]\nname = \"columns\"\ntype = \"spring\"\nbetween = [\"base\", \"roof\"]\nstiffness = 800\n"
      "[excitation]\n[[excitation.record]]\nacceleration_of = \"base\"\n" +
          record + "[transient]\n" + axis,
      folder / "study.toml");
  std::ostringstream out;
  print_records(study, {.frequency = {2.0 * std::numbers::pi / period}, .damping = {0.0}, .shape = {{1.0}}},
                out);
  return out.str();
}

TEST_CASE("A record is told by its samples, its peak, its ends and its baseline") {
  const TemporaryFolder folder;
  folder.write("quiet.csv", "0,0\n1,1\n2,0\n3,-1\n4,0\n");
  const std::string text = told(folder, "file = \"quiet.csv\"\n", 20.0);
  CHECK_THAT(text, Contains("record     acceleration of \"base\" by quiet.csv: 5 samples, every 1 s, 4 s; "
                            "straight lines between them\n"));
  CHECK_THAT(text, Contains("peak 1 m/s2 at 1 s; 0 at its start, 0 at its end\n"));
  CHECK_THAT(text, Contains("at the end 0 m/s (largest 1 m/s) and 2 m (largest 2 m)"));
  CHECK_THAT(text, !Contains("warning"));
}

TEST_CASE("A baseline that drifts and samples too coarse for the first mode are warned of") {
  const TemporaryFolder folder;
  folder.write("drift.csv", "0,0\n1,1\n2,1\n3,0\n");
  const std::string text = told(folder, "file = \"drift.csv\"\n", 5.0);
  CHECK_THAT(text, Contains("warning: acceleration of \"base\" by drift.csv: the support keeps a velocity"));
  CHECK_THAT(text,
             Contains("warning: acceleration of \"base\": mode 1 (period 5 s) has 5 samples per period"));
}

TEST_CASE("Samples that are missing are told with their place and are no coarse sampling") {
  const TemporaryFolder folder;
  std::string rows;
  for (const int i : {0, 1, 2, 3, 4, 5, 55, 56, 57, 58, 59, 60})
    rows += fmt::format("{},{}\n", 0.1 * i, i % 2 == 0 ? 1 : -1);
  folder.write("gap.csv", rows);
  const std::string text = told(folder, "file = \"gap.csv\"\n", 2.0);
  CHECK_THAT(text, Contains("warning: acceleration of \"base\" by gap.csv: no sample from 0.5 to 5.5 s, 50 "
                            "times its usual interval of 0.1 s; a straight line replaces them\n"));
  CHECK_THAT(text, !Contains("samples per period"));
  folder.write("uneven.csv", "0,0\n0.1,1\n0.2,-1\n1,1\n1.1,0\n");
  CHECK_THAT(told(folder, "file = \"uneven.csv\"\n", 20.0), !Contains("no sample"));
}

TEST_CASE("A displacement by straight lines has its corners on purpose: its samples are not called too few") {
  const TemporaryFolder folder;
  folder.write("pull.csv", "0,0\n1,0\n1.1,1\n10,1\n");
  const auto text = [&](const std::string& interpolation) {
    const Study study = parse_study(
        "[study]\nschema = 1\nkind = \"transient\"\n[[mass]]\nname = \"roof\"\nmass = 2\n"
        "[[element]]\nname = \"columns\"\ntype = \"spring\"\nbetween = [\"base\", \"roof\"]\nstiffness = "
        "800\n[excitation]\n[[excitation.record]]\ndisplacement_of = \"base\"\nunit = \"m\"\nfile = "
        "\"pull.csv\"\n" +
            interpolation + "[transient]\n",
        folder / "study.toml");
    std::ostringstream out;
    print_records(study, {.frequency = {1.0}, .damping = {0.0}, .shape = {{1.0}}}, out);
    return out.str();
  };
  const std::string lines = text("interpolation = \"linear\"\n");
  CHECK_THAT(lines, Contains("displacement of \"base\" by pull.csv: 4 samples") &&
                        Contains("straight lines between them"));
  CHECK_THAT(lines, !Contains("warning") && !Contains("note"));
  folder.write("pull.csv", "0,0\n1,0.1\n2,1\n3,0.5\n");
  CHECK_THAT(text(""), Contains("samples per period; the cubic spline"));
}

TEST_CASE("Records of an axis have a line each, the first twelve") {
  const TemporaryFolder folder;
  const std::string text = told(
      folder, "", 20.0,
      "[[axis]]\nrecords = { generate = \"kanai_tajimi\", count = 14, duration = 10, rate = 100, intensity = "
      "0.01, ground_frequency = 15, ground_damping = 0.6 }\n");
  CHECK_THAT(text, Contains("acceleration of \"base\" by 14 records of an axis"));
  CHECK_THAT(text, Contains("kanai_tajimi 11 ") && !Contains("kanai_tajimi 12 "));
  CHECK_THAT(text, Contains("and 2 more\n"));
  CHECK_THAT(text, !Contains("warning"));
}

}  // namespace
}  // namespace record_table_test
