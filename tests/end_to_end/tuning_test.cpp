// Whole runs of tunings: the classical absorber against its closed form, and what becomes of a run.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <sstream>

#include "tests/end_to_end/runs.hpp"
#include "tests/known_answers/nishihara_asami.hpp"
#include "tests/studies/small_tunings.hpp"

namespace tuning_test {
namespace {

using runs::Folder, runs::frahm, runs::Outcome;
using namespace small_tunings;

constexpr double mu = 0.05;  // mass ratio of small_tunings
// A maximum is flat, so a design is found to about the root of the precision of its peak.
constexpr double of_design = 1e-5;
constexpr double of_peak = 1e-6;

using Columns = std::map<std::string, std::vector<double>>;
Columns columns_of(const std::string& path, const std::string& group = "optimum") {
  Columns columns;
  const frahm::results::MapReader reader(path);
  for (const auto& column : reader.columns(group)) columns[column.variable.name] = column.values;
  return columns;
}

Outcome tune(const std::string& study, const std::string& output, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{"run", study, "-o", output, "--progress", "none", "--threads", "1"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return frahm(arguments);
}

std::string read_text(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string with_starts(const std::string& starts) {
  return heading + absorber + minimax + "start = " + starts + "\n" + of_f + of_zeta;
}

// A schedule of the absorber's tuning, with a gear beside it.
const std::string scheduled = heading + absorber + minimax + of_f +
                              "schedule = { knots = 4, max_slope = 3 }\nrule = \"r\"\n" + of_zeta +
                              "[[column]]\nname = \"gear\"\nvalue = \"f/r\"\nlower = 0.9\nupper = 1.2\n";

TEST_CASE("the classical absorber is tuned to its closed form and told") {
  const Folder folder;
  const std::string file = folder / "tmd.h5";
  const Outcome outcome = tune(folder.write("tmd.toml", classical), file);
  INFO(outcome.err);
  REQUIRE(outcome.code == 0);
  CHECK_THAT(outcome.out,
             Catch::Contains("tuned for             least worst main_peak over r = 0.7 .. 1.3") &&
                 Catch::Contains("active peaks") && Catch::Contains("converged"));
  CHECK(folder.names() == std::vector<std::string>{"tmd.h5", "tmd.toml"});
  Columns optimum = columns_of(file);
  const AbsorberOptimum exact = nishihara_asami(mu);
  CHECK_THAT(optimum["f"][0], Catch::WithinRel(exact.f, of_design));
  CHECK_THAT(optimum["zeta"][0], Catch::WithinRel(exact.zeta, of_design));
  CHECK_THAT(optimum["objective"][0], Catch::WithinRel(exact.peak, of_peak));
  CHECK(optimum["certificate_gap"][0] < 1e-6);
  CHECK(optimum["outcome"][0] == 1);
  CHECK(optimum["f_before"][0] == 0.9);
  const auto& after = optimum["response_after"];
  CHECK_THAT(*std::max_element(after.begin(), after.end()), Catch::WithinRel(exact.peak, of_peak));
  CHECK(optimum["worst_before"][0] > optimum["objective"][0]);
  REQUIRE(optimum["peak_value"].size() >= 2);
  CHECK(optimum["change"].size() == optimum["f_detuning"].size());
}

TEST_CASE("a tuning that is finished is told again, not computed again, and refuses another study's file") {
  const Folder folder;
  const std::string study = folder.write("tmd.toml", classical), file = folder / "tmd.h5";
  REQUIRE(tune(study, file).code == 0);
  const std::string bytes = read_text(file);
  const Outcome again = tune(study, file);
  CHECK(again.code == 0);
  CHECK_THAT(again.out, Catch::Contains("everything is computed already") && Catch::Contains("objective"));
  CHECK(read_text(file) == bytes);
  CHECK(tune(study, file, {"--set", "mu=0.1"}).code == 5);
  CHECK(read_text(file) == bytes);
  CHECK(tune(study, file, {"--set", "r=0.9"}).code == 2);
}

TEST_CASE("shards of a tuning are merged to the optimum of one run") {
  const Folder folder;
  const std::string study = folder.write("tmd.toml", with_starts("4"));
  const std::string whole = folder / "whole.h5", parts = folder / "parts.h5";
  REQUIRE(tune(study, whole).code == 0);
  CHECK(tune(study, parts, {"--shard", "1/2"}).code == 0);
  CHECK(frahm({"merge", parts}).code == 6);
  CHECK(tune(study, parts, {"--shard", "0/2"}).code == 0);
  const Outcome merged = frahm({"merge", parts});
  INFO(merged.err);
  REQUIRE(merged.code == 0);
  CHECK_THAT(merged.out, Catch::Contains("4: 4 converged"));
  const Columns expected = columns_of(whole), found = columns_of(parts);
  REQUIRE(found.size() == expected.size());
  for (const auto& [name, values] : expected) {
    INFO(name);
    const auto& other = found.at(name);
    REQUIRE(other.size() == values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
      CHECK((other[i] == values[i] || (std::isnan(other[i]) && std::isnan(values[i]))));
  }
  CHECK(folder.names() == std::vector<std::string>{"parts.h5", "tmd.toml", "whole.h5"});
}

TEST_CASE("a part of a result is no end: the run goes on from its logs") {
  const Folder folder;
  const std::string study = folder.write("tmd.toml", with_starts("4")), file = folder / "tmd.h5";
  REQUIRE(tune(study, file, {"--shard", "1/2"}).code == 0);
  REQUIRE(frahm({"merge", file, "--partial"}).code == 0);
  CHECK_THAT(frahm({"status", file}).out, Catch::Contains("a part of the result"));
  const Outcome whole = tune(study, file);
  CHECK(whole.code == 0);
  CHECK_THAT(whole.out, Catch::Contains("4: 4 converged"));
  CHECK_THAT(frahm({"status", file}).out, Catch::Contains("finished"));
  CHECK(folder.names() == std::vector<std::string>{"tmd.h5", "tmd.toml"});
}

TEST_CASE("an optimum out of reach ends with code 7, and the best design so far is in the file") {
  const Folder folder;
  const std::string file = folder / "tmd.h5";
  const std::string limit = "[[constraint]]\nquantity = \"main_peak\"\nupper = 3\n";
  const Outcome outcome = tune(folder.write("tmd.toml", classical + limit), file);
  CHECK(outcome.code == 7);
  CHECK_THAT(outcome.err, Catch::Contains("infeasible") && Catch::Contains("is in the file"));
  Columns optimum = columns_of(file);
  CHECK(optimum["outcome"][0] == 3);
  CHECK(optimum["violation"][0] > 0.1);
  CHECK(optimum["main_peak_upper_limit"][0] == 3);
  CHECK(std::isfinite(optimum["f"][0]));
  CHECK(tune(folder / "tmd.toml", file).code == 7);
}

TEST_CASE("a response without a bound in the band ends with code 7") {
  const Folder folder;
  // Without a damper and with the absorber's mass fixed to the main one's motion nothing bounds the peak.
  std::string text = runs::replaced(classical, of_zeta, "");
  text = runs::replaced(text, "zeta = 0.2", "zeta = 0");
  const Outcome outcome = tune(folder.write("tmd.toml", text), folder / "tmd.h5");
  INFO(outcome.out << outcome.err);
  CHECK(outcome.code == 7);
  CHECK_THAT(outcome.err, Catch::Contains("unbounded"));
}

TEST_CASE("a tuning whose given start has no response ends at the optimum that other starts find") {
  // An absorber with friction alone, so light at the start that a resonance grows without end.
  const std::string rubbing = R"(
[study]
schema = 1
kind = "tune"
title = "friction"
units = "dimensionless"
[parameters]
omega = 1.0
f = 0.7477282750839013
d = 0.21127459299780388
[[mass]]
name = "main"
mass = 1.0
[[mass]]
name = "tmd"
mass = 0.05
[[element]]
name = "main_spring"
type = "spring"
between = ["ground", "main"]
stiffness = 1.0
[[element]]
name = "k"
type = "spring"
between = ["main", "tmd"]
stiffness = "0.05*f^2"
[[element]]
name = "guide"
type = "coulomb"
between = ["main", "tmd"]
force = "d"
[excitation]
frequency = "omega"
[[excitation.force]]
on = "main"
amplitude = 1.0
[tune]
objective = "minimax"
quantity = "main_peak"
band = { parameter = "omega", from = 0.2, to = 3.0 }
start = "given"
[[design]]
parameter = "f"
lower = 0.3
upper = 2.0
[[design]]
parameter = "d"
lower = 0.002
upper = 10.0
)";
  // Found by version 8ae4d614 from starts of its own, without this one.
  constexpr double from_other_starts = 6.540168286;
  const Folder folder;
  const std::string file = folder / "rubbing.h5";
  const Outcome outcome = tune(folder.write("rubbing.toml", rubbing), file);
  INFO(outcome.out << outcome.err);
  REQUIRE(outcome.code == 0);
  Columns optimum = columns_of(file);
  CHECK(optimum["outcome"][0] == 1);
  CHECK(std::isinf(optimum["worst_before"][0]));
  CHECK_THAT(optimum["objective"][0], Catch::WithinRel(from_other_starts, of_peak));
}

TEST_CASE("a tuning stopped by its time budget keeps its finished starts and goes on") {
  const Folder folder;
  const std::string study = folder.write("tmd.toml", with_starts("200"));
  const std::string file = folder / "tmd.h5";
  // The first budget in which this machine finishes a start.
  Outcome stopped;
  for (const char* budget : {"1s", "4s", "16s", "64s"}) {
    stopped = tune(study, file, {"--time-budget", budget});
    INFO(budget << ": " << stopped.out << stopped.err);
    REQUIRE(stopped.code == 4);
    if (stopped.err.find("starts again") == std::string::npos) break;
  }
  CHECK_THAT(stopped.err, Catch::Contains("resumes from there"));
  CHECK_THAT(frahm({"status", file}).out, Catch::Contains("of 200"));
  REQUIRE(tune(study, file).code == 0);
  CHECK(columns_of(file)["start_objective"].size() == 200);
}

TEST_CASE("check tells a tuning's variables, and point its response anywhere") {
  const Folder folder;
  const std::string study = folder.write("tmd.toml", scheduled);
  const Outcome check = frahm({"check", study});
  CHECK(check.code == 0);
  CHECK_THAT(check.out, Catch::Contains("scheduled at 4 knots, next to a rule") &&
                            Catch::Contains("variables             5") && Catch::Contains("Undamped modes"));
  const Outcome point = frahm({"point", study, "--at", "r=0.95,f=0.9"});
  CHECK(point.code == 0);
  CHECK_THAT(point.out, Catch::Contains("main_peak"));
}

TEST_CASE("the exported sweep of a schedule runs as it is and gives the recorded response") {
  const Folder folder;
  const std::string file = folder / "tmd.h5", sweep = folder / "optimum.toml";
  const Outcome outcome = tune(folder.write("tmd.toml", scheduled), file);
  INFO(outcome.err);
  REQUIRE((outcome.code == 0 || outcome.code == 7));
  REQUIRE(frahm({"export", file, "--sweep", sweep}).code == 0);
  CHECK(std::ifstream(folder / "optimum_f.csv").good());
  const Outcome swept = frahm({"run", sweep, "-o", folder / "swept.h5", "--progress", "none"});
  INFO(swept.err);
  REQUIRE(swept.code == 0);
  Columns optimum = columns_of(file);
  const runs::Map map = runs::read_map(folder / "swept.h5");
  const auto& peaks = map["main_peak"];
  REQUIRE(peaks.size() == optimum["response_after"].size());
  CHECK(map.coordinate("r") == optimum["r"]);
  for (std::size_t i = 0; i < peaks.size(); ++i) {
    INFO("r = " << optimum["r"][i]);
    CHECK_THAT(peaks[i], Catch::WithinRel(optimum["response_after"][i], 1e-9));
  }
  // Over the same, but over no study of another's, and over none that was changed since, nor its table.
  const std::vector<std::string> export_again{"export", file, "--sweep", sweep};
  CHECK(frahm(export_again).code == 0);
  CHECK(frahm({"export", file, "--sweep", folder / "tmd.toml"}).code == 6);
  for (const std::string& changed : {sweep, folder / "optimum_f.csv"}) {
    const std::string before = runs::text_of(changed);
    folder.write(std::filesystem::path(changed).filename().string(), before + "# by hand\n");
    const Outcome refused = frahm(export_again);
    CHECK(refused.code == 6);
    CHECK_THAT(refused.err, Catch::Contains(changed + ": exists already and differs"));
    CHECK(runs::text_of(changed) == before + "# by hand\n");
    folder.write(std::filesystem::path(changed).filename().string(), before);
  }
  CHECK(frahm({"export", file, "--sweep", folder / "nowhere/optimum.toml"}).code == 6);
}

TEST_CASE("a tuning's table, schedule and what is asked wrongly of an export") {
  const Folder folder;
  const std::string file = folder / "tmd.h5";
  const int code = tune(folder.write("tmd.toml", scheduled), file).code;
  REQUIRE((code == 0 || code == 7));
  const Outcome schedule = frahm({"export", file, "--schedule", "-o", "-", "--step", "0.05"});
  REQUIRE(schedule.code == 0);
  CHECK_THAT(schedule.out, Catch::StartsWith("r,f,gear,gear_range\n0.7,"));
  CHECK(std::count(schedule.out.begin(), schedule.out.end(), '\n') == 1 + 13);
  CHECK_THAT(frahm({"export", file, "-o", "-"}).out, Catch::Contains("objective"));
  CHECK_THAT(frahm({"status", file}).out, Catch::Contains("reason") && Catch::Contains("outcome"));
  CHECK(frahm({"export", file, "--schedule", "--group", "optimum"}).code == 2);
  CHECK(frahm({"export", file, "--step", "1"}).code == 2);
  const std::string map = folder / "map.h5";
  REQUIRE(frahm({"export", file, "--sweep", folder / "sweep.toml"}).code == 0);
  REQUIRE(frahm({"run", folder / "sweep.toml", "-o", map, "--progress", "none"}).code == 0);
  CHECK(frahm({"export", map, "--schedule"}).code == 2);
  CHECK(frahm({"export", map, "--sweep", folder / "again.toml"}).code == 2);
}

}  // namespace
}  // namespace tuning_test
