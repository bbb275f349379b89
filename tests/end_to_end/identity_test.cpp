#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tests/end_to_end/small_runs.hpp"

// A study that was changed, run onto the result of what it was: the result is refused, or says the new words
// and not one number was computed.
namespace identity_test {
namespace {

using frahm::results::Column;
using frahm::results::MapReader;
using runs::Folder, runs::Outcome, runs::replaced, runs::run, runs::text_of;

constexpr double kOtherUnit = 1e-14;  // relative: a number in one unit, and converted to it from another

// A folder with the studies and data of the fingerprint's test.
void copy_mutants(const Folder& folder) {
  const std::filesystem::path from = FRAHM_SOURCE_DIR "/tests/studies/provenance/mutants";
  for (const auto& entry : std::filesystem::directory_iterator(from))
    std::filesystem::copy_file(entry.path(), folder / entry.path().filename().string());
}

std::string study_of_schema(const std::string& name) {
  const std::string data = "../../../studies/reading/wrong/data/";
  std::string text = text_of(FRAHM_SOURCE_DIR "/tests/end_to_end/schema/studies/" + name);
  for (auto at = text.find(data); at != std::string::npos; at = text.find(data))
    text.replace(at, data.size(), FRAHM_SOURCE_DIR "/tests/studies/reading/wrong/data/");
  return text;
}

using Passages = std::vector<std::pair<std::string, std::string>>;

std::string changed(std::string text, const Passages& passages) {
  for (const auto& [passage, by] : passages) text = replaced(std::move(text), passage, by);
  return text;
}

void check_numbers(const std::vector<double>& found, const std::vector<double>& expected) {
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    INFO("[" << i << "]: " << found[i] << ", not " << expected[i]);
    CHECK((std::isnan(found[i]) ? std::isnan(expected[i])
                                : std::abs(found[i] - expected[i]) <= kOtherUnit * std::abs(expected[i])));
  }
}

void check_columns(const MapReader& found, const MapReader& expected, const std::string& group) {
  const auto columns = found.columns(group), wanted = expected.columns(group);
  REQUIRE(columns.size() == wanted.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    INFO(group << "/" << columns[i].variable.name);
    CHECK(columns[i].variable.name == wanted[i].variable.name);
    CHECK(columns[i].variable.unit == wanted[i].variable.unit);
    CHECK(columns[i].variable.long_name == wanted[i].variable.long_name);
    check_numbers(columns[i].values, wanted[i].values);
  }
}

void check_map(const std::string& found, const std::string& expected) {
  const runs::Map map = runs::read_map(found), wanted = runs::read_map(expected);
  REQUIRE(map.layout.axes.size() == wanted.layout.axes.size());
  for (std::size_t a = 0; a < map.layout.axes.size(); ++a) {
    const auto &axis = map.layout.axes[a], &wanted_axis = wanted.layout.axes[a];
    CHECK(axis.name == wanted_axis.name);
    REQUIRE(axis.coordinates.size() == wanted_axis.coordinates.size());
    for (std::size_t c = 0; c < axis.coordinates.size(); ++c) {
      INFO(axis.coordinates[c].name);
      CHECK(axis.coordinates[c].unit == wanted_axis.coordinates[c].unit);
      CHECK(axis.coordinates[c].long_name == wanted_axis.coordinates[c].long_name);
      check_numbers(axis.coordinates[c].values, wanted_axis.coordinates[c].values);
    }
  }
  for (const auto& [name, values] : wanted.values) check_numbers(map.values.at(name), values);
}

// All that one file says, and another that a fresh run has made, but who made it and when.
void check_same(const std::string& found, const std::string& expected) {
  check_map(found, expected);
  const MapReader file(found), wanted(expected);
  CHECK(file.layout().title == wanted.layout().title);
  REQUIRE(file.groups() == wanted.groups());
  for (const std::string& group : file.groups()) {
    if (group == "provenance") continue;
    CHECK(file.texts(group) == wanted.texts(group));
    check_columns(file, wanted, group);
  }
  for (const char* text : {"study", "overrides", "fingerprint_physics", "fingerprint_grid", "failed_points"})
    CHECK(runs::provenance(found, text) == runs::provenance(expected, text));
}

// A study, changed, is refused at the result of the study.
void check_refused(const Folder& folder, const std::string& text, const Passages& passages,
                   const std::string& told) {
  INFO(told);
  const std::string study = folder.write("study.toml", text), output = folder / "result.h5";
  std::filesystem::remove(output);
  const Outcome first = run(study, output);
  INFO(first.err);
  REQUIRE((first.code == 0 || first.code == 7));  // some fits have no more data than unknowns
  const std::string before = text_of(output);
  folder.write("study.toml", changed(text, passages));
  const Outcome refused = run(study, output);
  INFO(refused.out << refused.err);
  CHECK(refused.code == 5);
  CHECK_THAT(refused.err, Catch::Contains("what changed:") && Catch::Contains(told));
  CHECK(text_of(output) == before);
}

// A study, changed in words, has them written into the result of the study, as if it had been computed anew.
void check_words(const Folder& folder, const std::string& text, const Passages& passages,
                 const std::string& told, int code = 0) {
  INFO(told);
  const std::string study = folder.write("study.toml", text), output = folder / "result.h5",
                    fresh = folder / "fresh.h5";
  for (const std::string& file : {output, fresh}) std::filesystem::remove(file);
  REQUIRE(run(study, output).code == code);
  folder.write("study.toml", changed(text, passages));
  const Outcome words = run(study, output);
  INFO(words.out << words.err);
  CHECK(words.code == code);
  CHECK_THAT(words.out,
             Catch::Contains("everything is computed already") &&
                 Catch::Contains("nothing is computed; these changes are written into " + output + ":") &&
                 Catch::Contains(told));
  const Outcome again = run(study, output);
  CHECK_THAT(again.out, Catch::Contains("everything is computed already") && !Catch::Contains("written"));
  REQUIRE(run(study, fresh).code == code);
  check_same(output, fresh);
}

const std::string map =
    "study = { schema = 1, kind = \"sweep\", title = \"a map\" }\n"
    "parameters = { omega = 5, k = { value = 1, unit = \"kN/m\" }, F = 1 }\n"
    "mass = [{ name = \"m\", mass = 40 }]\n"
    "element = [\n"
    "  { name = \"spring\", type = \"spring\", between = [\"ground\", \"m\"], stiffness = \"k\" },\n"
    "  { name = \"oil\", type = \"damper\", between = [\"ground\", \"m\"], damping = 20 },\n"
    "  { name = \"joint\", type = \"coulomb\", between = [\"ground\", \"m\"], force = \"F\" },\n"
    "]\n"
    "excitation = { frequency = \"omega\", force = [{ on = \"m\", amplitude = 50 }] }\n"
    "axis = [{ parameter = \"k\", values = [1, 2], unit = \"kN/m\" },\n"
    "  { parameter = \"omega\", values = [4, 5, 6, 8], unit = \"rad/s\" }]\n"
    "coordinate = [{ name = \"turns\", value = \"omega\", unit = \"Hz\" }]\n"
    "output = { quantities = [\"m_peak\", \"joint_regime\", \"status\"], borders = true, "
    "resonances = [\"m\"], orbits = [{ k = { value = 1, unit = \"kN/m\" }, omega = { value = 5, unit = "
    "\"rad/s\" } }], "
    "branches = { along = \"omega\", at = [{ k = { value = 1, unit = \"kN/m\" } }] } }\n";

TEST_CASE("another sweep is refused at a result, and names what differs") {
  const Folder folder;
  check_refused(folder, map, {{"mass = 40", "mass = 41"}}, "mass \"m\": mass: 40, now 41");
  check_refused(folder, map, {{"values = [1, 2]", "values = [1, 3]"}},
                "axis \"k\": values: [1 kN/m, 2 kN/m]");
  check_refused(folder, map, {{"borders = true", "borders = false"}}, "borders: true, now false");
  copy_mutants(folder);
  const std::string zip = text_of(folder / "sweep_zip.toml");
  check_refused(folder, zip,
                {{"zip = \"line\" }, {", "zip = \"way\" }, {"}, {"zip = \"line\"", "zip = \"way\""}},
                "zip: \"line\", now \"way\"");
}

TEST_CASE("other words of a sweep, and other units of its axes, are written into its result") {
  const Folder folder;
  check_words(folder, map, {{"a map", "another"}}, "title: \"a map\", now \"another\"");
  check_words(folder, map, {{"unit = \"Hz\"", "unit = \"rpm\", long_name = \"speed\""}},
              "coordinate \"turns\": unit: \"Hz\", now \"rpm\"");
  check_words(folder, map, {{"value = \"omega\"", "value = \"(omega)\""}},
              "value: \"omega\", now \"(omega)\"");
  check_words(folder, map, {{"values = [1, 2], unit = \"kN/m\"", "values = [1000, 2000], unit = \"N/m\""}},
              "axis \"k\": values: [1 kN/m, 2 kN/m], now [1000 N/m, 2000 N/m]");
  check_words(folder, map,
              {{"values = [4, 5, 6, 8], unit = \"rad/s\"",
                "values = [0.004, 0.005, 0.006, 0.008], unit = \"rad/ms\""}},
              "axis \"omega\": unit: \"rad/s\", now \"rad/ms\"");
  check_words(folder, map, {{"output =", "report = { headline = \"m\" }\noutput ="}}, "[report]: new");
  const std::string building = small_studies::building(2, 1, 3),
                    report = "[report]\nquantities = [\"status\"]\nprofile = \"all\"\nheight = 3\n";
  check_words(folder, building, {{"[[axis]]", report + "[[axis]]"}}, "[report]: new");
  check_words(folder, report + building, {{report, ""}}, "[report]: gone");
}

TEST_CASE("points that failed are told in the units of the study, also where these are others") {
  const Folder folder;
  constexpr int some_failed = 3;
  const std::string text =
      changed(map, {{"values = [1, 2]", "values = [-1, 1]"},
                    {", borders = true, resonances = [\"m\"], orbits = [{ k = { value = 1, unit = \"kN/m\" "
                     "}, omega = { value = 5, unit = \"rad/s\" } }], "
                     "branches = { along = \"omega\", at = [{ k = { value = 1, unit = \"kN/m\" } }] }",
                     ""}});
  check_words(folder, text, {{"[-1, 1], unit = \"kN/m\"", "[-1000, 1000], unit = \"N/m\""}},
              "axis \"k\": values", some_failed);
  CHECK_THAT(runs::provenance(folder / "result.h5", "failed_points"),
             Catch::StartsWith("k=-1000 N/m,omega=4 rad/s: "));
}

TEST_CASE("the coordinate in another unit of the attack: its numbers are those of the study") {
  const Folder folder;
  check_words(folder, map, {{"value = \"omega\"", "value = \"(omega)\""}}, "coordinate \"turns\"");
  CHECK(runs::read_map(folder / "result.h5").coordinate("turns").front() == 4.0);
}

TEST_CASE("another tuning is refused at a result, and names what differs") {
  const Folder folder;
  copy_mutants(folder);
  const std::string schedule = text_of(folder / "tune_schedule.toml");
  check_refused(folder, schedule, {{"jumps = 0", "jumps = 1"}}, "schedule: jumps: 0, now 1");
  check_refused(folder, schedule, {{"rule = \"omega^2\"", "rule = \"1.1*omega^2\""}}, "rule");
  const std::string noise = study_of_schema("tune_noise.toml");
  check_refused(folder, noise, {{"intensity = 0.5", "intensity = 0.6"}}, "intensity: 0.5, now 0.6");
  check_refused(folder, noise, {{"upper = 1 }", "upper = 2 }"}}, "design \"c\": upper: 1, now 2");
  check_refused(folder, noise, {{"quantity = \"m_rms\"", "quantity = \"k_stroke\""}}, "quantity");
}

TEST_CASE("other words of a tuning, and other units of its numbers, are written into its result") {
  const Folder folder;
  copy_mutants(folder);
  const std::string schedule = text_of(folder / "tune_schedule.toml");
  check_words(folder, schedule, {{"value = \"k\", unit = \"kN/m\"", "value = \"k\", unit = \"N/m\""}},
              "column \"stiffness\": unit: \"kN/m\", now \"N/m\"");
  check_words(folder, schedule, {{"value = \"k\", unit", "value = \"(k)\", unit"}},
              "value: \"k\", now \"(k)\"");
  check_words(folder, schedule,
              {{"unit = \"N/m\", lower = 20, upper = 100", "unit = \"kN/m\", lower = 0.02, upper = 0.1"},
               {"max_slope = 50", "max_slope = 0.05"},
               {"upper = 500, unit = \"mm\"", "upper = 0.5, unit = \"m\""}},
              "design \"k\": unit: \"N/m\", now \"kN/m\"");
  check_words(folder, text_of(folder / "tune_trade_off.toml"),
              {{"kind = \"tune\"", "kind = \"tune\", title = \"a front\""},
               {"values = [40, 30], unit = \"mm\"", "values = [0.04, 0.03], unit = \"m\""}},
              "trade_off");
}

TEST_CASE("another motion or identification is refused at a result, and other data are too") {
  const Folder folder;
  copy_mutants(folder);
  const std::string decay = study_of_schema("decay.toml");
  check_refused(folder, decay, {{"reference_frequency = 1 ", "reference_frequency = 2 "}},
                "reference_frequency: 1, now 2");
  check_refused(folder, decay, {{"samples = 11", "samples = 12"}}, "samples: 11, now 12");
  check_refused(folder, decay, {{"displacement = 1", "velocity = 1"}}, "initial \"m\": velocity: new, 1");
  check_refused(folder, text_of(folder / "run_up.toml"), {{"sweep_rate = 1", "sweep_rate = 2"}},
                "sweep_rate: 1, now 2");
  std::string trace = "time [s],displacement [m]\n";  // that turns 12 times
  for (int i = 0; i <= 400; ++i)
    trace += std::to_string(0.1 * i) + "," +
             std::to_string(0.001 + 0.02 * std::exp(-0.005 * i) * std::cos(0.1 * i)) + "\n";
  folder.write("turns.csv", trace);
  const std::string fit =
      "study = { schema = 1, kind = \"identify\" }\nidentify = { method = \"free_decay\", sensor_offset = "
      "true, "
      "record = [{ name = \"d\", file = \"turns.csv\" }] }\n";
  check_refused(folder, fit, {{"sensor_offset = true", "sensor_offset = false"}},
                "sensor_offset: true, now false");
  check_refused(
      folder,
      "study = { schema = 1, kind = \"identify\" }\nidentify = { method = \"log_decrement\", cycles = 1, "
      "record = [{ name = \"d\", file = \"turns.csv\" }] }\n",
      {{"cycles = 1", "cycles = 2"}}, "cycles: 1, now 2");
  check_refused(
      folder,
      "study = { schema = 1, kind = \"identify\" }\nidentify = { method = \"free_decay\", mass = 2, "
      "record = [{ name = \"d\", file = \"turns.csv\" }] }\n",
      {{"mass = 2", "mass = 3"}}, "mass: 2, now 3");
}

TEST_CASE("the title of a motion is written into its file") {
  const Folder folder;
  const std::string text = study_of_schema("decay.toml"), output = folder / "result.h5";
  REQUIRE(run(folder.write("study.toml", text), output).code == 0);
  const auto before = MapReader(output).columns("decay");
  folder.write("study.toml", replaced(text, "kind = \"decay\"", "kind = \"decay\", title = \"swinging\""));
  CHECK(run(folder / "study.toml", output).code == 0);
  const MapReader after(output);
  CHECK(after.layout().title == "swinging");
  const auto columns = after.columns("decay");
  REQUIRE(columns.size() == before.size());
  for (std::size_t i = 0; i < columns.size(); ++i) check_numbers(columns[i].values, before[i].values);
}

// A result is read with the files that its study read; other numbers in them are another system.
TEST_CASE("a table or matrix whose numbers changed after a run is refused where its result is read again") {
  const Folder folder;
  const std::string matrix = "%%MatrixMarket matrix coordinate real symmetric\n1 1 1\n1 1 ";
  folder.write("c.csv", "t,c\n0,1\n10,3\n");
  folder.write("m.mtx", matrix + "2\n");
  folder.write("k.mtx", matrix + "50\n");
  const std::string study =
      folder.write("decay.toml",
                   "[study]\nschema = 1\nkind = \"decay\"\nunits = \"dimensionless\"\n"
                   "[parameters]\nt = 5\nc = { table = \"c.csv\", of = \"t\" }\n"
                   "[[matrices]]\nname = \"part\"\nnames = [\"main\"]\n"
                   "mass = \"m.mtx\"\nstiffness = \"k.mtx\"\n"
                   "[[element]]\nname = \"damper\"\ntype = \"damper\"\n"
                   "between = [\"ground\", \"main\"]\ndamping = \"c\"\n"
                   "[decay]\nduration = 3\n[[initial]]\nnode = \"main\"\ndisplacement = 1\n");
  const std::string file = folder / "decay.h5";
  REQUIRE(run(study, file).code == 0);
  const auto read_again = [&] {
    return runs::frahm({"export", file, "--data", folder / "data.csv", "--rate", "10"});
  };
  CHECK(read_again().code == 0);
  const auto check_refused = [&](const std::string& what) {
    const Outcome read = read_again(), again = run(study, file);
    CHECK(read.code == 2);
    CHECK_THAT(read.err, Catch::Contains(what + " has other numbers than when this result was made"));
    CHECK(again.code == 5);
    CHECK_THAT(again.err, Catch::Contains(what));
  };
  folder.write("c.csv", "t,c\n0,1\n10,3.5\n");
  check_refused("parameter \"c\": the table c.csv");
  folder.write("c.csv", "# the same numbers\nt,c\n0.0,1.0\n10.0,3.0\n");
  CHECK(read_again().code == 0);
  folder.write("k.mtx", matrix + "51\n");
  check_refused("matrices \"part\": a file");
}

}  // namespace
}  // namespace identity_test
