#include <catch2/catch.hpp>
#include <filesystem>
#include <sstream>

#include "studies/map/map_plan.hpp"
#include "studies/provenance/study_plan.hpp"
#include "studies/reading/parse_study.hpp"
#include "studies/reading/text/toml_writing.hpp"
#include "studies/tuning/schedule_table.hpp"
#include "studies/tuning/sweep_study.hpp"
#include "studies/tuning/tuning_plan.hpp"
#include "tests/studies/small_tunings.hpp"

namespace tuning_export_test {
namespace {

using namespace frahm::studies;
using namespace small_tunings;

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// The classical tuning, of another quantity.
std::string with_quantity(const std::string& quantity) {
  std::string text = classical;
  return text.replace(text.find("main_peak"), 9, quantity);
}

// A schedule over rpm, and beside it a gear.
StoredTuning scheduled(const std::string& band, const std::string& knots) {
  StoredTuning stored;
  stored.study = parse_study(
      "[study]\nschema = 1\nkind = \"tune\"\n[parameters]\nomega = 25\nI = 6\n"
      "[[mass]]\nname = \"main\"\nmass = 100\n"
      "[[element]]\nname = \"s\"\ntype = \"spring\"\nbetween = [\"ground\", \"main\"]\nstiffness = 57e3\n"
      "[[element]]\nname = \"b\"\ntype = \"inerter\"\nbetween = [\"ground\", \"main\"]\ninertance = \"I\"\n"
      "[excitation]\nfrequency = \"omega\"\n[[excitation.force]]\non = \"main\"\namplitude = 240\n"
      "[tune]\nobjective = \"minimax\"\nquantity = \"main_peak\"\nband = { parameter = \"omega\", " +
          band + " }\n[[design]]\nparameter = \"I\"\nlower = 4\nupper = 13\nschedule = { knots = " + knots +
          " }\n[[column]]\nname = \"gear\"\nvalue = \"I/10\"\nupper = 0.8\n",
      "tuning.toml");
  stored.design = {{{5, 9}, stored.study.tune()->designs[0].knots}};
  return stored;
}

TEST_CASE("a controller's table has a row at each whole rpm and at the ends of the band") {
  const auto rows =
      lines_of(schedule_table(scheduled("from = 150.5, to = 160.5, unit = \"rpm\"", "2"), std::nullopt));
  REQUIRE(rows.size() == 1 + 12);
  CHECK(rows[0] == "omega [rpm],I [kg],gear,gear_range");
  CHECK(rows[1] == "150.5,5,0.5,within");
  CHECK(rows[2].starts_with("151,5.2,"));
  CHECK(rows[11].starts_with("160,8.8,"));
  CHECK(rows[12] == "160.5,9,0.9,above");
}

TEST_CASE("a band in rad/s is stepped by whole rpm too, which stand beside it") {
  const auto rows = lines_of(schedule_table(scheduled("from = 15.0, to = 16.0", "2"), std::nullopt));
  REQUIRE(rows.size() == 1 + 2 + 9);  // 143.24 rpm, 144 ... 152 rpm, 152.79 rpm
  CHECK(rows[0] == "omega [rad s-1],excitation [rpm],I [kg],gear,gear_range");
  CHECK(rows[2].find(",144,") != std::string::npos);
  CHECK(rows[10].find(",152,") != std::string::npos);
}

TEST_CASE("another step is in the unit of the band; ends that are whole steps stand once") {
  const StoredTuning stored = scheduled("from = 150, to = 160, unit = \"rpm\"", "2");
  CHECK(lines_of(schedule_table(stored, 2.5)).size() == 1 + 5);
  CHECK(lines_of(schedule_table(stored, 0.1)).size() == 1 + 101);
  CHECK(lines_of(schedule_table(stored, std::nullopt)).size() == 1 + 11);
  for (const double step : {0.0, -1.0, 1e-9}) {
    CHECK_THROWS_WITH(schedule_table(stored, step), Catch::Contains("--step"));
  }
}

TEST_CASE("a tuning without a schedule has no table of one") {
  StoredTuning stored;
  stored.study = parse_study(classical, "tuning.toml");
  stored.design = {{{0.95}, {}}, {{0.13}, {}}};
  CHECK_THROWS_WITH(schedule_table(stored, std::nullopt), Catch::Contains("nothing is scheduled"));
}

TEST_CASE("every study written out is the study that was read", "[slow]") {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(FRAHM_SOURCE_DIR "/studies")) {
    if (entry.path().extension() != ".toml") continue;
    INFO(entry.path().string());
    Study study;
    try {
      study = read_study(entry.path());
    } catch (const StudyError&) {  // it needs the result of another study
      continue;
    }
    const Study again = parse_study(toml_text(read_toml(study.source)), entry.path());
    if (study.kind() == StudyKind::sweep) {
      CHECK(plan_map(again, {}).fingerprint == plan_map(study, {}).fingerprint);
    } else if (study.kind() == StudyKind::tune) {
      CHECK(plan_tuning(again, {}).fingerprint == plan_tuning(study, {}).fingerprint);
    } else {
      CHECK(plan_without_map(again, {}).fingerprint == plan_without_map(study, {}).fingerprint);
    }
  }
}

TEST_CASE("texts and keys that need quotes are written with them") {
  const StudySource source{
      "quotes.toml", "a = \"say \\\"no\\\" \\\\ \\n\"\n\"b c\" = [1, 2.5, true]\n[t]\nd = { e = 1e300 }\n"};
  const std::string text = toml_text(read_toml(source));
  CHECK(text == "a = \"say \\\"no\\\" \\\\ \\n\"\n\"b c\" = [1, 2.5, true]\n\n[t]\nd = { e = 1e+300 }\n");
}

TEST_CASE("the sweep at an optimum has its design, its overrides, its scenarios and its band") {
  StoredTuning stored;
  stored.study = parse_study(classical +
                                 "[[scenario]]\nname = \"one\"\nset = { P = 1 }\n"
                                 "[[scenario]]\nname = \"two\"\nset = { P = 2, mu = 0.06 }\n",
                             "tuning.toml");
  stored.overrides = {{*stored.study.parameters.find("r"), 1.25}};
  stored.design = {{{0.95}, {}}, {{0.13}, {}}};
  stored.band = {0.7, 0.9, 1.3};
  const SweepStudy sweep = sweep_study(stored, "optimum");
  CHECK(sweep.tables.empty());
  CHECK(sweep.text.starts_with(sweep_mark));
  const Study study = parse_study(sweep.text, "optimum.toml");
  CHECK(study.kind() == StudyKind::sweep);
  const auto nominal = study.parameters.nominal();
  CHECK(nominal[*study.parameters.find("f")] == 0.95);
  CHECK(nominal[*study.parameters.find("zeta")] == 0.13);
  CHECK(nominal[*study.parameters.find("r")] == 1.25);
  REQUIRE(study.map()->dimensions.size() == 2);
  CHECK(study.map()->dimensions[0].name == "scenario");
  REQUIRE(study.map()->axes.size() == 3);
  CHECK(study.map()->axes[0].values == std::vector<double>{0.05, 0.06});
  CHECK(study.map()->axes[1].values == std::vector<double>{1.0, 2.0});
  CHECK(study.map()->axes[2].values == stored.band);
  CHECK(study.map()->output.names.size() == 2);
}

TEST_CASE("a schedule is a table beside its sweep") {
  StoredTuning stored = scheduled("from = 150, to = 160, unit = \"rpm\"", "2");
  stored.band = {150, 155, 160};
  const SweepStudy sweep = sweep_study(stored, "optimum");
  REQUIRE(sweep.tables.size() == 1);
  CHECK(sweep.tables[0].first == "optimum_I.csv");
  CHECK(lines_of(sweep.tables[0].second).size() == 1 + 2 + 2);
  CHECK_THAT(sweep.text, Catch::Contains("I = { table = \"optimum_I.csv\", of = \"omega\" }"));
  CHECK_THAT(sweep.text, Catch::Contains("unit = \"rpm\""));
}

TEST_CASE("a run-up speaks of the frequency in the unit of the band") {
  StoredTuning stored = scheduled("from = 150, to = 160, unit = \"rpm\"", "2");
  stored.band = {150, 155, 160};
  const SweepStudy run_up = run_up_study(stored, "up");
  CHECK_THAT(run_up.text, Catch::Contains("sweep_to = { value = 160, unit = \"rpm\" }") &&
                              Catch::Contains("sweep_rate = { value = 0.05, unit = \"rpm/s\" }"));
}

TEST_CASE("what is written of a tuning of a signal has the signal, and opens with it") {
  const std::string signal = "[[output.signal]]\nname = \"gap\"\nalong = { main = 1, tmd = -1 }\n";
  StoredTuning stored;
  stored.study = parse_study(with_quantity("gap_peak") + signal, "tuning.toml");
  stored.design = {{{0.95}, {}}, {{0.13}, {}}};
  stored.band = {0.7, 0.9, 1.3};
  const Study run_up = parse_study(run_up_study(stored, "up").text, "up.toml");
  REQUIRE(run_up.network.signals.size() == 1);
  CHECK(run_up.network.signals.front().name == "gap");
  const Study sweep = parse_study(sweep_study(stored, "optimum").text, "optimum.toml");
  REQUIRE(sweep.map()->headline);
  CHECK(sweep.map()->headline->text == "gap_peak");
  stored.study = parse_study(with_quantity("tmd_peak"), "tuning.toml");
  CHECK(parse_study(sweep_study(stored, "optimum").text, "optimum.toml").map()->headline->text == "tmd_peak");
}

}  // namespace
}  // namespace tuning_export_test
