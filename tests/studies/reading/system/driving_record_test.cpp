#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "results/map_writer.hpp"
#include "studies/motion/one_motion.hpp"
#include "studies/provenance/fingerprint.hpp"
#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/study.hpp"
#include "tests/studies/temporary_folder.hpp"

namespace driving_record_test {
namespace {

using namespace frahm::studies;
using frahm::transient::Record, frahm::transient::RecordOf;

constexpr double rounding = 1e-14;   // a few roundings of double arithmetic
constexpr double gravity = 9.80665;  // [m/s2], the standard one
const std::string quake =
    "t [ms],ns [g],ew [m/s2],push [kN]\n1000,0,0,1\n1100,0.1,-1,2\n1200,-0.2,3,3\n1400,0,1,4\n";
const std::string frame =
    "[parameters]\ns = 2\n[[mass]]\nname = \"roof\"\nmass = 2\n[[mass]]\nname = \"wheel\"\ninertia = 1\n"
    "[[element]]\nname = \"columns\"\ntype = \"spring\"\nbetween = [\"base\", \"roof\"]\nstiffness = 800\n"
    "[[element]]\nname = \"shaft\"\ntype = \"spring\"\nbetween = [\"ground\", \"wheel\"]\nstiffness = 5\n";

struct Read {
  TemporaryFolder folder;
  Read() { folder.write("quake.csv", quake); }
  Study study(const std::string& excitation, const std::string& more = "[transient]\n",
              DataFiles data = DataFiles::read) const {
    return parse_study(
        "[study]\nschema = 1\nkind = \"transient\"\n" + frame + "[excitation]\n" + excitation + more,
        folder / "study.toml", data);
  }
};

std::string record(const std::string& keys) {
  return "[[excitation.record]]\n" + keys;
}

TEST_CASE("A record in g drives a support from its first sample on, for as long as it lasts") {
  const Read read;
  const Study study =
      read.study(record("acceleration_of = \"base\"\nfile = \"quake.csv\"\nscale = \"s/4\"\n"));
  REQUIRE(study.transient()->records.size() == 1);
  const DrivingRecord& driving = study.transient()->records[0];
  CHECK(study.network.excitations[driving.excitation].kind ==
        frahm::mechanics::ExcitationKind::recorded_motion);
  CHECK(study.network.prescribed == std::vector<std::string>{"base"});
  CHECK(stated(study, study.values.amplitude[driving.excitation]) == 0.5);
  const Record& quake_record = driving.records.at(0);
  CHECK(quake_record.of == RecordOf::acceleration);
  CHECK(quake_record.name == "quake.csv");
  const std::vector<double> time{0.0, 0.1, 0.2, 0.4}, values{0.0, 0.1, -0.2, 0.0};
  for (std::size_t i = 0; i < time.size(); ++i) {
    CHECK_THAT(quake_record.time.at(i), Catch::WithinAbs(time[i], rounding));
    CHECK_THAT(quake_record.values.at(i), Catch::WithinAbs(gravity * values[i], rounding));
  }
  CHECK_THAT(forced_options(study).duration, Catch::WithinRel(0.4, rounding));
  CHECK(forced_options(study).from == 1.0);  // nothing asks for a frequency
}

TEST_CASE("A window cuts between samples on the straight line, and its start is the study's zero") {
  const Read read;
  const Study study =
      read.study(record("acceleration_of = \"base\"\nfile = \"quake.csv\"\ncolumn = \"ew\"\nfrom = 1.05\n"
                        "to = { value = 1300, unit = \"ms\" }\n"));
  const Record& cut = study.transient()->records.at(0).records.at(0);
  const std::vector<double> time{0.0, 0.05, 0.15, 0.25}, values{-0.5, -1.0, 3.0, 2.0};
  REQUIRE(cut.time.size() == time.size());
  for (std::size_t i = 0; i < time.size(); ++i) {
    CHECK_THAT(cut.time[i], Catch::WithinAbs(time[i], 1e-13));
    CHECK_THAT(cut.values[i], Catch::WithinAbs(values[i], 1e-12));
  }
}

TEST_CASE(
    "Several records drive at once: two columns of one file, a force, a torque, a displacement by its "
    "samples") {
  const Read read;
  read.folder.write("lift.csv", "0,0\n1,2\n2,5\n3,3\n");
  const Study study =
      read.study(record("acceleration_of = \"base\"\nfile = \"quake.csv\"\n") +
                 record("velocity_of = \"base\"\nfile = \"lift.csv\"\nunit = \"mm/s\"\n") +
                 record("force_on = \"roof\"\nfile = \"quake.csv\"\ncolumn = 4\n") +
                 record("force_on = \"wheel\"\nfile = \"lift.csv\"\nunit = \"N mm\"\n") +
                 record("displacement_of = \"base\"\nfile = \"lift.csv\"\nunit = \"cm\"\nfrom = 1\n"));
  const auto& records = study.transient()->records;
  REQUIRE(records.size() == 5);
  CHECK(study.network.prescribed.size() == 1);
  CHECK_THAT(records[1].records[0].values[1], Catch::WithinRel(0.002, rounding));
  CHECK_THAT(records[2].records[0].values[3], Catch::WithinRel(4000.0, rounding));
  CHECK_THAT(records[3].records[0].values[1], Catch::WithinRel(0.002, rounding));
  CHECK(study.network.excitations[records[3].excitation].node == 1);
  REQUIRE(records[4].records[0].time.size() == 3);
  CHECK_THAT(records[4].records[0].values[0], Catch::WithinRel(0.02, rounding));
  CHECK(records[4].records[0].time[2] == 2.0);
  CHECK(forced_options(study).duration == 3.0);  // the longest
}

TEST_CASE("A record in an HDF5 file is read by the paths of its datasets") {
  const Read read;
  {
    frahm::results::MapWriter writer(read.folder / "quake.h5", {.title = "t", .source = "s", .history = "h"});
    const auto along = [](const char* name, const char* unit, std::vector<double> values) {
      return frahm::results::Column{
          {.name = name, .unit = unit, .long_name = name}, "sample", std::move(values)};
    };
    writer.write_columns("shake",
                         {along("time", "s", {0.0, 0.5, 1.0}), along("ns", "m s-2", {1.0, 2.0, 4.0})});
    writer.finish();
  }
  const Study study = read.study(record(
      "acceleration_of = \"base\"\nfile = \"quake.h5\"\ntime = \"shake/time\"\ncolumn = \"shake/ns\"\n"));
  CHECK(study.transient()->records.at(0).records.at(0).values == std::vector<double>{1.0, 2.0, 4.0});
  CHECK_THROWS_WITH(read.study(record("acceleration_of = \"base\"\nfile = \"quake.h5\"\n")),
                    Catch::Contains("record of \"base\": time: expected the path of a dataset"));
}

TEST_CASE("The fingerprint of a study is that of its records' samples, not of their paths") {
  const Read read;
  const std::string base = "acceleration_of = \"base\"\ncolumn = \"ew\"\nfile = ";
  const auto physics = [&](const std::string& file) {
    return fingerprint(read.study(record(base + "\"" + file + "\"\n"))).physics;
  };
  read.folder.write("copy.csv", quake);
  std::string changed = quake;
  changed.replace(changed.find("-1,2"), 4, "-1.000000000000001,2");
  read.folder.write("changed.csv", changed);
  CHECK(physics("copy.csv") == physics("quake.csv"));
  CHECK(physics("changed.csv") != physics("quake.csv"));
}

const std::string pull = "time [s],d [m]\n0,0\n1,0\n1.1,1\n10,1\n";

TEST_CASE("A displacement from corner to corner is no spline: it is refused, and read as straight lines") {
  const Read read;
  read.folder.write("pull.csv", pull);
  const std::string base = "displacement_of = \"base\"\nfile = \"pull.csv\"\n";
  CHECK_THROWS_WITH(read.study(record(base)),
                    Catch::Contains("study.toml:25:8: ") && Catch::Contains("pull.csv: the cubic spline") &&
                        Catch::Contains("between sample 3 (1 at 1.1 s) and sample 4 (1 at 10 s)") &&
                        Catch::Contains("a quarter of the record's range") &&
                        Catch::Contains("interpolation = \"linear\""));
  const std::string lines = base + "interpolation = \"linear\"\n";
  const Study study = read.study(record(lines));
  CHECK(study.transient()->records.at(0).records.at(0).jumps());
  // A straight line has an end anywhere.
  const Study cut = read.study(record(lines + "from = 1.05\n"));
  CHECK_THAT(cut.transient()->records.at(0).records.at(0).values.front(), Catch::WithinAbs(0.5, rounding));
}

TEST_CASE("What stands between the samples of a displacement is part of the study's identity") {
  const Read read;
  const std::string base = "displacement_of = \"base\"\nfile = \"quake.csv\"\nunit = \"mm\"\ncolumn = 4\n";
  read.folder.write("quake.csv", "0,0,0,1\n1,0.1,-1,2\n2,-0.2,3,3\n4,0,1,4\n");
  const auto physics = [&](const std::string& keys) {
    return fingerprint(read.study(record(base + keys))).physics;
  };
  CHECK(physics("") == physics("interpolation = \"spline\"\n"));
  CHECK(physics("") != physics("interpolation = \"linear\"\n"));
}

TEST_CASE("Only displacements have a choice between samples, and no straight lines where an inerter hangs") {
  const Read read;
  CHECK_THROWS_WITH(
      read.study(record("acceleration_of = \"base\"\nfile = \"quake.csv\"\ninterpolation = \"linear\"\n")),
      Catch::Contains("interpolation: belongs to displacement_of"));
  read.folder.write("pull.csv", pull);
  const std::string inerter =
      "[transient]\n[[element]]\nname = \"b\"\ntype = \"inerter\"\nbetween = [\"base\", \"roof\"]\n"
      "inertance = 1\n";
  CHECK_THROWS_WITH(
      read.study(record("displacement_of = \"base\"\nfile = \"pull.csv\"\ninterpolation = \"linear\"\n"),
                 inerter),
      Catch::Contains("interpolation: straight lines make the velocity of \"base\" jump") &&
          Catch::Contains("the inerter \"b\""));
}

TEST_CASE("An axis gives its records to every excitation without a file, by that one's column") {
  const Read read;
  read.folder.write("other.csv", "t [s],ew [m/s2],ns [m/s2]\n0,1,2\n3,4,5\n");
  const std::string axis = "[transient]\n[[axis]]\nrecords = [\"quake.csv\", \"other.csv\"]\n";
  const Study study = read.study(
      record("acceleration_of = \"base\"\ncolumn = \"ns\"\n") +
          record("acceleration_of = \"side\"\ncolumn = \"ew\"\n") +
          record("force_on = \"roof\"\nfile = \"quake.csv\"\ncolumn = \"push\"\n") + "",
      "[[element]]\nname = \"rope\"\ntype = \"damper\"\nbetween = [\"side\", \"roof\"]\ndamping = 1\n" +
          axis);
  const auto& records = study.transient()->records;
  REQUIRE(records.size() == 3);
  CHECK(records[0].records[1].values == std::vector<double>{2.0, 5.0});
  CHECK(records[1].records[1].values == std::vector<double>{1.0, 4.0});
  CHECK(records[1].on_axis);
  CHECK_FALSE(records[2].on_axis);
  REQUIRE(study.map());
  CHECK(study.map()->dimensions.at(0).name == "record");
  CHECK(study.map()->dimensions.at(0).size == 2);
  CHECK(study.map()->records.value().names == std::vector<std::string>{"quake.csv", "other.csv"});
  CHECK(forced_options(study).duration == 3.0);
}

TEST_CASE(
    "An axis of generated records has the same ones for a seed, and independent ones for two excitations") {
  const Read read;
  const auto with = [&](const std::string& seed) {
    return read.study(record("acceleration_of = \"base\"\n") + record("force_on = \"roof\"\n"),
                      "[transient]\n[[axis]]\nrecords = { generate = \"white\", count = 3, seed = " + seed +
                          ", duration = 2, rate = 50, intensity = 0.1 }\n");
  };
  const Study first = with("1"), again = with("1"), other = with("2");
  const auto values = [](const Study& study, std::size_t component, std::size_t i) {
    return study.transient()->records.at(component).records.at(i).values;
  };
  CHECK(first.map()->dimensions.at(0).size == 3);
  CHECK(first.map()->records.value().names.at(2) == "white 2");
  CHECK(values(first, 0, 2).size() == 101);
  for (std::size_t i = 0; i < 3; ++i) CHECK(values(first, 0, i) == values(again, 0, i));
  CHECK(values(first, 0, 0) != values(other, 0, 0));
  CHECK(values(first, 0, 0) != values(first, 0, 1));
  for (std::size_t i = 0; i < 3; ++i) CHECK(values(first, 0, i) != values(first, 1, 0));
}

TEST_CASE("A study is read without its records where their files are gone") {
  const Read read;
  const Study study = read.study(record("acceleration_of = \"base\"\nfile = \"gone.csv\"\n"), "[transient]\n",
                                 DataFiles::leave);
  REQUIRE(study.transient()->records.size() == 1);
  CHECK(study.transient()->records[0].records.empty());
}

}  // namespace
}  // namespace driving_record_test
