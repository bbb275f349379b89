// Reading studies of measurements: what a record is taken for, in which units, at which values.
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <numbers>

#include "results/map_writer.hpp"
#include "studies/provenance/study_plan.hpp"
#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/study.hpp"
#include "tests/studies/temporary_folder.hpp"

namespace identify_study_test {
namespace {

using namespace frahm::studies;
using frahm::identification::MotionKind;
constexpr double rounding = 1e-14;  // a few roundings of double arithmetic

const std::string heading = "[study]\nschema = 1\nkind = \"identify\"\n";
const std::string parameters =
    "[parameters]\nk = { value = 3.022, unit = \"kN/m\" }\nc = 4.65\nF = 1.06\nI = 0\nR = 0.03\n"
    "x0 = { value = 20, unit = \"mm\" }\n";
const std::string one_mass =
    "[[mass]]\nname = \"main\"\nmass = 1.0\n"
    "[[element]]\nname = \"spring\"\ntype = \"spring\"\nbetween = [\"ground\", \"main\"]\nstiffness = \"k\"\n"
    "[[element]]\nname = \"damper\"\ntype = \"damper\"\nbetween = [\"ground\", \"main\"]\ndamping = \"c\"\n"
    "[[element]]\nname = \"guide\"\ntype = \"coulomb\"\nbetween = [\"ground\", \"main\"]\nforce = \"F\"\n"
    "[[element]]\nname = \"inerter\"\ntype = \"inerter\"\nbetween = [\"ground\", \"main\"]\n"
    "inertance = \"I\"\n";
const std::string initial = "[[initial]]\nnode = \"main\"\ndisplacement = \"x0\"\n";
const std::string support =
    "[[element]]\nname = \"drive\"\ntype = \"spring\"\nbetween = [\"base\", \"main\"]\nstiffness = 100\n"
    "[excitation]\nfrequency = 26\n[[excitation.motion]]\nnode = \"base\"\nprofile = \"crank\"\n"
    "crank = \"R\"\nrod = 0.12\n";

std::string identify(const std::string& method, const std::string& more = "") {
  return "[identify]\nmethod = \"" + method + "\"\n" + more;
}
std::string record(const std::string& file, const std::string& more = "") {
  return "[[identify.record]]\nfile = \"" + file + "\"\n" + more;
}
std::string fitted(const std::string& parameter, const std::string& more = "") {
  return "[[identify.parameter]]\nparameter = \"" + parameter + "\"\n" + more;
}

const std::string free_trace = "time [ms],main_displacement [mm]\n0,20\n10,19\n20,17\n";

Study read(const TemporaryFolder& folder, const std::string& text) {
  return parse_study(text, folder / "study.toml");
}

std::string complaint_about(const TemporaryFolder& folder, const std::string& text) {
  try {
    read(folder, text);
  } catch (const StudyError& error) {
    return error.what();
  }
  return "none";
}

const std::vector<double>& column(const RecordChoice& record, const std::string& role) {
  const DataColumn* found = record.find(role);
  if (!found) throw std::runtime_error("no column " + role);
  return found->values;
}

void check_all(const std::vector<double>& values, const std::vector<double>& expected) {
  REQUIRE(values.size() == expected.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    CHECK_THAT(values[i], Catch::WithinRel(expected[i], rounding));
}

TEST_CASE("a record is read by its header, in the units that stand there") {
  const TemporaryFolder folder;
  folder.write("free decay-1.csv",
               "\xEF\xBB\xBF# a test\r\nnote;displacement [mm];time [ms]\r\n1;20;0\r\n2;19.5;10\r\n");
  const Study study = read(folder, heading + identify("free_decay") + record("free decay-1.csv"));
  CHECK(study.kind() == StudyKind::identify);
  REQUIRE(study.identify());
  CHECK(study.network.masses.empty());
  const RecordChoice& only = study.identify()->records.at(0);
  CHECK(only.name == "free_decay_1");
  CHECK(only.columns.size() == 2);
  check_all(column(only, "time"), {0.0, 0.01});
  check_all(column(only, "displacement"), {0.02, 0.0195});
}

TEST_CASE("columns are named by number or by header, and units by the study or by the header") {
  const TemporaryFolder folder;
  folder.write("plain.csv", "0,20\n10,19.5\n");
  folder.write("named.csv", "t [ms],x_main\n0,20\n10,19.5\n");
  for (const std::string& each :
       {record("plain.csv",
               "columns = { time = 1, displacement = 2 }\nunits = { time = \"ms\", displacement = "
               "\"mm\" }\n"),
        record("named.csv",
               "columns = { time = \"t\", displacement = \"x_main\" }\nunits = { time = \"ms\", "
               "displacement = \"mm\" }\n"),
        record("named.csv",
               "columns = { displacement = 2, time = \"t [ms]\" }\nunits = { displacement = "
               "\"mm\" }\n")}) {
    INFO(each);
    const Study study = read(folder, heading + identify("log_decrement", "cycles = 3\n") + each);
    CHECK(study.identify()->cycles == 3);
    check_all(column(study.identify()->records[0], "time"), {0.0, 0.01});
    check_all(column(study.identify()->records[0], "displacement"), {0.02, 0.0195});
  }
}

TEST_CASE("doubtful rows are left out unread, and counted; labels stay") {
  const TemporaryFolder folder;
  folder.write("widths.csv",
               "label,natural_frequency [Hz],lower_frequency [Hz],upper_frequency [Hz],doubtful\n"
               "\"S, alone\",8.75,8.314,9.243,0\nS+C,8.75,8.2?,,1\nS+V,9.0,8.508,10.687,0\n");
  const Study study =
      read(folder, heading + identify("half_power", "curve = \"support\"\n") + record("widths.csv"));
  CHECK(study.identify()->curve == CurveOf::support);
  const RecordChoice& rows = study.identify()->records[0];
  CHECK(rows.doubtful == 1);
  CHECK(rows.labels == std::vector<std::string>{"S, alone", "S+V"});
  const double cycle = 2.0 * std::numbers::pi;  // Hz count cycles
  check_all(column(rows, "lower_frequency"), {8.314 * cycle, 8.508 * cycle});
}

TEST_CASE("each method has the forms of its data") {
  const TemporaryFolder folder;
  folder.write("extremes.csv", "extremum\n0.02\n-0.018\n");
  folder.write("lines.csv", "slope,intercept [mm]\n0.08585,0.3517\n");
  folder.write("pairs.csv", "support [mm],response [mm]\n0.701,4.05\n0.74,4.34\n");
  folder.write("energies.csv", "amplitude,energy [mJ],frequency\n0.01,5,50\n0.02,9,50\n");
  folder.write("loop.csv", "time,displacement,force\n0,0,0\n1,1,1\n");
  folder.write("masses.csv", "added_mass,frequency [Hz]\n0,8.75\n1,6.2\n");
  folder.write("trace.csv", "time,displacement\n0,0.02\n0.01,0.018\n");
  folder.write("curve.csv", "frequency [Hz],amplitude [mm]\n8,1\n9,4\n");
  const auto columns_of = [&](const std::string& text) {
    return read(folder, heading + text).identify()->records[0].columns.size();
  };
  CHECK(columns_of(identify("log_decrement") + record("extremes.csv")) == 1);
  CHECK(columns_of(identify("forced_resonance", "stiffness = 3022\n") + record("lines.csv")) == 2);
  CHECK(columns_of(identify("forced_resonance", "curve = \"support\"\nmass = 1\nstiffness = 3022\n") +
                   record("pairs.csv")) == 2);
  CHECK(columns_of(identify("energy_balance") + record("energies.csv")) == 3);
  CHECK(columns_of(identify("hysteresis_loop") + record("loop.csv")) == 3);
  CHECK(columns_of(identify("added_mass") + record("masses.csv")) == 2);
  CHECK(columns_of(identify("added_mass") +
                   record("trace.csv", "added_mass = { value = 20, unit = \"g\" }\n")) == 2);
  CHECK(columns_of(identify("resonance_magnification") +
                   record("curve.csv", "static_displacement = { value = 1, unit = \"mm\" }\n")) == 2);
}

TEST_CASE("what is known beside the data may be an expression, whose parameters then have a meaning") {
  const TemporaryFolder folder;
  folder.write("decay.csv", "time,displacement\n0,0.02\n0.01,0.018\n");
  const Study study = read(folder, heading + "[parameters]\nm = { value = 1500, unit = \"g\" }\n" +
                                       identify("free_decay", "mass = \"2*m\"\nsensor_offset = true\n") +
                                       record("decay.csv"));
  const std::vector<double> values = study.parameters.nominal();
  REQUIRE(study.identify()->mass);
  CHECK(study.identify()->sensor_offset);
  CHECK_THAT(study.identify()->mass->expression.evaluate(std::span<const double>(values)),
             Catch::WithinRel(3.0, rounding));
}

TEST_CASE("a grey box reads sensors and excitation by the names of its nodes") {
  const TemporaryFolder folder;
  folder.write("free.csv", free_trace);
  folder.write("driven.csv",
               "time,main_acceleration [mm/s2],main_velocity,base_displacement [cm]\n0,5,0,1\n1,6,0,2\n");
  const std::string text =
      heading + parameters + one_mass + support + initial + identify("grey_box") +
      record("free.csv", "motion = \"free\"\nset = { I = 0.5 }\n") + record("driven.csv") +
      record("free.csv",
             "name = \"steady\"\nmotion = \"periodic\"\nset = { R = { value = 50, unit = \"mm\" } }\n") +
      fitted("k", "lower = 1\nupper = 5\neach_record = true\n") + fitted("x0");
  const Study study = read(folder, text);
  const IdentifyChoice& choice = *study.identify();
  REQUIRE(choice.records.size() == 3);
  CHECK(choice.records[0].motion == MotionKind::free);
  CHECK(choice.records[0].set.at(0).value == 0.5);
  CHECK(choice.records[1].motion == MotionKind::forced);
  check_all(column(choice.records[1], "main_acceleration"), {0.005, 0.006});
  check_all(column(choice.records[1], "base_displacement"), {0.01, 0.02});
  CHECK(choice.records[2].motion == MotionKind::periodic);
  CHECK_THAT(choice.records[2].set.at(0).value, Catch::WithinRel(0.05, rounding));
  CHECK(choice.parameters[0].each_record);
  CHECK_THAT(choice.parameters[0].lower, Catch::WithinRel(1000.0, rounding));
  CHECK_THAT(choice.parameters[0].upper, Catch::WithinRel(5000.0, rounding));
  CHECK(usual_unit(study, *study.parameters.find("k")).text == "kN/m");
  CHECK(std::isinf(choice.parameters[1].upper));
}

TEST_CASE("a record without excitation moves freely unless the study or the data have one") {
  const TemporaryFolder folder;
  folder.write("free.csv", free_trace);
  folder.write("pushed.csv", "time,main_displacement,main_force\n0,0,0\n1,1,1\n");
  const Study study = read(folder, heading + parameters + one_mass + initial + identify("grey_box") +
                                       record("free.csv") + record("pushed.csv") + fitted("c"));
  CHECK(study.identify()->records[0].motion == MotionKind::free);
  CHECK(study.identify()->records[1].motion == MotionKind::forced);
  const Study driven = read(folder, heading + parameters + one_mass + support + identify("grey_box") +
                                        record("free.csv") + fitted("c"));
  CHECK(driven.identify()->records[0].motion == MotionKind::forced);
}

TEST_CASE("a crank has the orders that the records and the bounds need") {
  const TemporaryFolder folder;
  folder.write("free.csv", free_trace);
  const auto orders = [&](const std::string& of_record, const std::string& more) {
    return read(folder, heading + parameters + one_mass + support + identify("grey_box") +
                            record("free.csv", of_record) + fitted("c") + more)
        .network.excitations[0]
        .even_orders;
  };
  const int stated = orders("", "");
  CHECK(orders("set = { R = 0.09 }\n", "") > stated);
  CHECK(orders("", fitted("R", "upper = 0.09\n")) > stated);
}

TEST_CASE("an estimate takes the place of a parameter of the system") {
  const TemporaryFolder folder;
  folder.write("decay.csv", "time,displacement\n0,0.02\n0.01,0.018\n");
  const Study study = read(folder, heading + parameters + one_mass + identify("free_decay", "mass = 1\n") +
                                       record("decay.csv") + fitted("F", "estimate = \"friction_force\"\n"));
  CHECK(study.identify()->parameters[0].estimate == "friction_force");
  CHECK(study.identify()->parameters[0].parameter == study.parameters.find("F"));
}

TEST_CASE("no value of the command line replaces what the measurements determine") {
  const TemporaryFolder folder;
  folder.write("free.csv", free_trace);
  const Study study = read(folder, heading + parameters + one_mass + initial + identify("grey_box") +
                                       record("free.csv", "set = { I = 0.5 }\n") + fitted("c"));
  CHECK_THROWS_WITH(refuse_overruled(study, {"c=3"}), Catch::Contains("\"c\" is identified"));
  CHECK_THROWS_WITH(refuse_overruled(study, {"I=3"}), Catch::Contains("\"I\" is set by the record \"free\""));
  CHECK_NOTHROW(refuse_overruled(study, {"F=3"}));
}

TEST_CASE("columns of an HDF5 file are its datasets, whose padding and doubtful values are left out") {
  const TemporaryFolder folder;
  frahm::results::MapWriter writer(folder / "earlier.h5", {.title = "t", .source = "s", .history = "h"});
  const double none = std::nan("");
  const auto along = [](const char* name, const char* unit, std::vector<double> values) {
    return frahm::results::Column{
        {.name = name, .unit = unit, .long_name = name}, "extremum", std::move(values)};
  };
  writer.write_columns("decay",
                       {along("main_extremum", "mm", {20, -18, 16, none, none}),
                        along("main_extremum_time", "s", {0, 0.1, 0.2, none, none}),
                        along("x", "mm", {20, 18, 16, none, none}), along("e", "J", {3, 2, 1, none, none}),
                        along("w", "rad s-1", {9, 9, 9, none, none}), along("mark", "1", {0, 0, 1, 0, 0}),
                        along("gap", "m", {1, none, 3, 4, 5})});
  writer.finish();
  const auto text = [&](const std::string& columns) {
    return heading + identify("log_decrement") + record("earlier.h5", "columns = { " + columns + " }\n");
  };
  const std::string times = ", extremum_time = \"decay/main_extremum_time\"";
  const RecordChoice whole =
      read(folder, text("extremum = \"decay/main_extremum\"" + times)).identify()->records[0];
  check_all(column(whole, "extremum"), {0.02, -0.018, 0.016});
  CHECK(column(whole, "extremum_time").size() == 3);
  const std::string energies = "amplitude = \"decay/x\", energy = \"decay/e\", frequency = \"decay/w\"";
  const RecordChoice part =
      read(folder, heading + identify("energy_balance") +
                       record("earlier.h5", "columns = { " + energies + ", doubtful = \"decay/mark\" }\n"))
          .identify()
          ->records[0];
  check_all(column(part, "amplitude"), {0.02, 0.018});
  CHECK(part.doubtful == 1);
  CHECK_THAT(complaint_about(folder, text("extremum = \"decay/main_extremum\", doubtful = \"decay/mark\"")),
             Catch::Contains("turning points follow each other"));
  CHECK_THAT(complaint_about(folder, text("extremum = \"decay/gap\"")),
             Catch::Contains("earlier.h5: \"decay/gap\": value 2: nan is not a finite number"));
  CHECK_THAT(complaint_about(folder, text("extremum = \"decay/mian\"")), Catch::Contains("has no \"mian\""));
}

// What an identification leaves: estimates and the rows of their covariance.
void write_estimates(const std::filesystem::path& path, const std::vector<std::string>& names,
                     const std::vector<std::string>& units, const std::vector<double>& values,
                     const std::vector<std::vector<double>>& covariance) {
  using frahm::results::Column;
  std::vector<Column> columns;
  for (std::size_t i = 0; i < names.size(); ++i) {
    columns.push_back({{.name = names[i], .unit = units[i], .long_name = names[i]}, "", {values[i]}});
    columns.push_back({{.name = names[i] + "_covariance", .unit = "1", .long_name = "row of the covariance"},
                       "estimate",
                       covariance[i]});
  }
  frahm::results::MapWriter writer(path, {.title = "t", .source = "s", .history = "h"});
  writer.write_columns("identification", columns);
  writer.finish();
}

TEST_CASE("earlier estimates take the place of parameters, with what is known of their errors") {
  const TemporaryFolder folder;
  folder.write("free.csv", free_trace);
  write_estimates(folder / "first.h5", {"F", "zeta", "k"}, {"N", "1", "N m-1"}, {1.25, 0.04, 3100.0},
                  {{4.0, 0.1, 0.2}, {0.1, 9.0, 0.3}, {0.2, 0.3, 16.0}});
  write_estimates(folder / "second.h5", {"I"}, {"kg"}, {0.5}, {{25.0}});
  const std::string rest = record("free.csv") + fitted("c");
  const Study study =
      read(folder, heading + parameters + one_mass + initial +
                       identify("grey_box", "fixed_from = [\"first.h5\", \"second.h5\"]\n") + rest);
  const IdentifyChoice& choice = *study.identify();
  REQUIRE(choice.fixed.size() == 3);
  CHECK(study.parameters.list[choice.fixed[0].parameter].name == "F");
  CHECK(study.parameters.list[choice.fixed[1].parameter].name == "k");
  CHECK(study.parameters.list[choice.fixed[2].parameter].name == "I");
  CHECK(choice.fixed[1].value == 3100.0);
  CHECK(study.parameters.nominal()[*study.parameters.find("k")] == 3100.0);
  const std::vector<std::vector<double>> expected{{4.0, 0.2, 0.0}, {0.2, 16.0, 0.0}, {0.0, 0.0, 25.0}};
  CHECK(choice.fixed_covariance == expected);
  CHECK_THROWS_WITH(refuse_overruled(study, {"F=3"}), Catch::Contains("\"F\" has its value from fixed_from"));
  const Study refitted =
      read(folder, heading + parameters + one_mass + initial +
                       identify("grey_box", "fixed_from = \"first.h5\"\n") + rest + fitted("k"));
  CHECK(refitted.identify()->fixed.size() == 1);  // what is fitted again is not fixed
}

TEST_CASE("earlier estimates that fix nothing, or contradict the study, are refused") {
  const TemporaryFolder folder;
  folder.write("free.csv", free_trace);
  write_estimates(folder / "other.h5", {"zeta"}, {"1"}, {0.04}, {{1.0}});
  write_estimates(folder / "metres.h5", {"F"}, {"m"}, {0.04}, {{1.0}});
  write_estimates(folder / "open.h5", {"F"}, {"N"}, {std::nan("")}, {{INFINITY}});
  write_estimates(folder / "good.h5", {"F"}, {"N"}, {1.0}, {{1.0}});
  write_estimates(folder / "below.h5", {"F"}, {"N"}, {-1.0}, {{1.0}});
  frahm::results::MapWriter(folder / "map.h5", {.title = "t", .source = "s", .history = "h"}).finish();
  const auto complaint = [&](const std::string& files, const std::string& of_record = "") {
    return complaint_about(folder, heading + parameters + one_mass + initial +
                                       identify("grey_box", "fixed_from = " + files + "\n") +
                                       record("free.csv", of_record) + fitted("c"));
  };
  CHECK_THAT(complaint("\"other.h5\""),
             Catch::Contains("other.h5: none of its estimates is a parameter of this study that is a number "
                             "and not fitted; it has zeta, the study has k, F, I, R and x0"));
  CHECK_THAT(complaint("\"metres.h5\""),
             Catch::Contains("the estimate \"F\": the unit \"m\" is that of a length"));
  CHECK_THAT(complaint("\"open.h5\""), Catch::Contains("\"F\" was not determined by its data"));
  CHECK_THAT(complaint("[\"good.h5\", \"good.h5\"]"), Catch::Contains("is also in an earlier file"));
  CHECK_THAT(complaint("\"good.h5\"", "set = { F = 2 }\n"), Catch::Contains("that the record \"free\" sets"));
  CHECK_THAT(complaint("\"below.h5\""), Catch::Contains("force: is -1 N at F = -1 N; must be >= 0"));
  CHECK_THAT(complaint("\"map.h5\""), Catch::Contains("map.h5: is not the result of an identification"));
  CHECK_THAT(complaint("\"free.csv\""), Catch::Contains("[identify]: fixed_from: "));
}

TEST_CASE("hysteretic elements need a frequency where no excitation tells one") {
  const TemporaryFolder folder;
  folder.write("free.csv", free_trace);
  const std::string rubber =
      "[[element]]\nname = \"rubber\"\ntype = \"hysteretic\"\nbetween = [\"ground\", \"main\"]\n"
      "stiffness = 100\nloss_factor = 0.1\n";
  const auto complaint = [&](const std::string& more, const std::string& of_identify) {
    return complaint_about(folder, heading + parameters + one_mass + rubber + more + initial +
                                       identify("grey_box", of_identify) + record("free.csv") + fitted("c"));
  };
  CHECK_THAT(complaint("", ""), Catch::Contains("the key \"reference_frequency\" is missing"));
  CHECK(complaint("", "reference_frequency = { value = 8.7, unit = \"Hz\" }\n") == "none");
  CHECK(complaint("[excitation]\nfrequency = 26\n[[excitation.force]]\non = \"main\"\namplitude = 1\n", "") ==
        "none");
}

TEST_CASE("a dimensionless study has data without units, or with the unit 1") {
  const TemporaryFolder folder;
  folder.write("decay.csv", "time [1],displacement\n0,20\n1,19\n");
  const Study study =
      read(folder, heading + "units = \"dimensionless\"\n" + identify("free_decay") + record("decay.csv"));
  check_all(column(study.identify()->records[0], "displacement"), {20.0, 19.0});
}

TEST_CASE("a record of 20,000 rows is read in a fraction of a second") {
  const TemporaryFolder folder;
  std::string text = "time,main_displacement [mm],main_velocity\n";
  for (int i = 0; i < 20'000; ++i)
    text += std::to_string(i * 1e-3) + "," + std::to_string(20.0 * std::cos(i * 0.05)) + ",0.123456789\n";
  folder.write("long.csv", text);
  const auto start = std::chrono::steady_clock::now();
  const Study study = read(folder, heading + parameters + one_mass + initial + identify("grey_box") +
                                       record("long.csv") + fitted("c"));
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
  CHECK(column(study.identify()->records[0], "main_velocity").size() == 20'000);
  CHECK(passed.count() < 1.0);  // loose: other programs run beside the tests; alone it is some 0.02 s
}

}  // namespace
}  // namespace identify_study_test
