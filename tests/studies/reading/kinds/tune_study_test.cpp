#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/tuning/optimum_columns.hpp"
#include "studies/tuning/tuned_design.hpp"
#include "studies/tuning/tuning_task.hpp"
#include "tests/studies/small_tunings.hpp"

namespace tune_study_test {
namespace {

using namespace frahm::studies;
using namespace small_tunings;
using frahm::tuning::Objective;
using frahm::tuning::Start;
constexpr double rounding = 1e-14;  // a few roundings of double arithmetic

Study parse(const std::string& text) {
  return parse_study(text, "tuning.toml");
}

// The rig with its exciter in rpm, reduced to what a schedule needs.
const std::string rig =
    "[study]\nschema = 1\nkind = \"tune\"\n"
    "[parameters]\nomega = { value = 250, unit = \"rpm\" }\nI = 6\nk = { value = 11, unit = \"kN/m\" }\n"
    "A = { value = 30, unit = \"mm\" }\nL = 0.12\n"
    "[[mass]]\nname = \"main\"\nmass = 102.66\n[[mass]]\nname = \"tmd\"\nmass = 12.82\n"
    "[[element]]\nname = \"drive\"\ntype = \"spring\"\nbetween = [\"exciter\", \"main\"]\nstiffness = 57e3\n"
    "[[element]]\nname = \"tmd_spring\"\ntype = \"spring\"\nbetween = [\"main\", \"tmd\"]\nstiffness = "
    "\"k\"\n"
    "[[element]]\nname = \"damper\"\ntype = \"damper\"\nbetween = [\"main\", \"tmd\"]\n"
    "damping = \"26.5 + 0.5*I\"\n"
    "[[element]]\nname = \"inerter\"\ntype = \"inerter\"\nbetween = [\"main\", \"tmd\"]\ninertance = \"I\"\n"
    "[excitation]\nfrequency = \"omega\"\n[[excitation.motion]]\nnode = \"exciter\"\nprofile = \"crank\"\n"
    "crank = \"A\"\nrod = \"L\"\n"
    "[tune]\nobjective = \"minimax\"\nquantity = \"main_peak\"\n"
    "band = { parameter = \"omega\", from = 150, to = 350, unit = \"rpm\" }\n";
const std::string scheduled =
    "[[design]]\nparameter = \"I\"\nlower = 4.72\nupper = 12.9\n"
    "schedule = { knots = 5, max_slope = 0.2 }\nrule = \"k/omega^2 - 12.82\"\n"
    "[[design]]\nparameter = \"k\"\nlower = 5\nupper = 20\n";

TEST_CASE("a tuning has its defaults, and its choices where they are made") {
  const Study plain = parse(classical);
  REQUIRE(plain.tune());
  CHECK(plain.kind() == StudyKind::tune);
  CHECK(plain.tune()->objective == Objective::minimax);
  CHECK(plain.tune()->solver == frahm::tuning::SolverKind::slsqp);
  CHECK_FALSE(plain.tune()->start_is_given);
  CHECK(plain.tune()->starts == 1);
  CHECK(plain.tune()->tolerance == 1e-6);
  CHECK_FALSE(plain.tune()->dominate_constant);
  const Study chosen =
      parse(heading + absorber + minimax + "solver = \"mma\"\nstart = 32\ntolerance = 1e-8\n" + of_f);
  CHECK(chosen.tune()->solver == frahm::tuning::SolverKind::mma);
  CHECK(chosen.tune()->start == Start::many);
  CHECK(chosen.tune()->starts == 32);
  CHECK(chosen.tune()->start_is_given);
  CHECK(parse(heading + absorber + minimax + "start = \"map\"\n" + of_f).tune()->start == Start::map);
  CHECK(parse(rig + scheduled).tune()->solver == frahm::tuning::SolverKind::slsqp);
  CHECK(chosen.tune()->tolerance == 1e-8);
  const Study global = parse(heading + absorber + minimax + "start = \"nlopt\"\nglobal = \"isres\"\n" + of_f);
  CHECK(global.tune()->start == Start::global);
  CHECK(global.tune()->global_solver == frahm::tuning::SolverKind::isres);
}

TEST_CASE(
    "a least worst peak takes elements with several responses, and [orbits] says how they are searched") {
  const std::string stops =
      "[[element]]\nname = \"stops\"\ntype = \"gap\"\nbetween = [\"main\", \"tmd\"]\nclearance = 3\n"
      "stiffness = 0.1\n";
  const std::string searched = "[orbits]\nstarts = 5\nmost_multiple = 2\n";
  const Study study = parse(heading + absorber + stops + searched + minimax + of_f);
  CHECK(study.tune()->orbits.starts == 5);
  CHECK(study.tune()->orbits.most_multiple == 2);
  const frahm::tuning::Task task = frahm::studies::tuning_task(study);
  CHECK(task.orbits.starts == 5);
  CHECK(frahm::tuning::may_take_several_orbits(task.network));
  CHECK_FALSE(frahm::studies::not_proved(study).empty());
  CHECK(frahm::studies::not_proved(parse(classical)).empty());
}

TEST_CASE("a band whose ends are one number to rounding is one frequency: its scan did not end") {
  std::string text = small_tunings::classical;
  const std::string ends = "from = 0.7, to = 1.3";
  text.replace(text.find(ends), ends.size(), "from = 0.9, to = 0.9000000000000001");
  const Study study = parse_study(text, "study.toml");
  CHECK(study.tune()->band->range.from == study.tune()->band->range.to);
}

TEST_CASE("bands, bounds, knots and slopes are in the units the study gives, SI within") {
  const Study study = parse(rig + scheduled);
  const double rpm = std::numbers::pi / 30.0;
  const TuneChoice& tune = *study.tune();
  CHECK_THAT(tune.band->range.from, Catch::WithinRel(150.0 * rpm, rounding));
  CHECK_THAT(tune.band->range.to, Catch::WithinRel(350.0 * rpm, rounding));
  CHECK(tune.designs[0].lower == 4.72);
  REQUIRE(tune.designs[0].knots.size() == 5);
  CHECK_THAT(tune.designs[0].knots[1], Catch::WithinRel(200.0 * rpm, rounding));
  CHECK(tune.designs[0].knots[4] == tune.band->range.to);
  CHECK_THAT(tune.designs[0].max_slope, Catch::WithinRel(0.2 / rpm, rounding));
  CHECK_THAT(tune.designs[1].upper, Catch::WithinRel(2e4, rounding));
  CHECK_FALSE(tune.designs[1].is_scheduled());
  const UsualUnit unit = usual_unit(study, *study.parameters.find("omega"));
  CHECK(unit.text == "rpm");
}

TEST_CASE("limits, a trade-off, scenarios and columns are read in their units") {
  const Study study = parse(
      rig + "trade_off = { quantity = \"main_acceleration_peak\", values = [3, 2] }\n" + scheduled +
      "[[constraint]]\nquantity = \"tmd_spring_stroke\"\nupper = 80\nunit = \"mm\"\n"
      "band = { from = 200, to = 300 }\n"
      "[[constraint]]\nquantity = \"main_peak\"\nupper = 0.1\n"
      "band = { from = 4, to = 5, unit = \"Hz\" }\n"
      "[[scenario]]\nname = \"small\"\nset = { A = 20 }\n"
      "[[scenario]]\nname = \"large\"\nset = { A = { value = 4, unit = \"cm\" } }\n"
      "[[column]]\nname = \"ratio\"\nvalue = \"sqrt((I*0.0009 - 0.0036)/0.0027)\"\nlower = 0.58\nupper = "
      "1.76\n");
  const TuneChoice& tune = *study.tune();
  REQUIRE(tune.limits.size() == 2);
  CHECK_THAT(tune.limits[0].upper, Catch::WithinRel(0.08, rounding));
  CHECK_THAT(tune.limits[0].band->from, Catch::WithinRel(200.0 * std::numbers::pi / 30.0, rounding));
  CHECK_THAT(tune.limits[1].band->to, Catch::WithinRel(10.0 * std::numbers::pi, rounding));
  CHECK(tune.trade_off->limits == std::vector<double>{3.0, 2.0});
  REQUIRE(tune.scenarios.size() == 2);
  CHECK_THAT(tune.scenarios[0].set[0].value, Catch::WithinRel(0.02, rounding));
  CHECK_THAT(tune.scenarios[1].set[0].value, Catch::WithinRel(0.04, rounding));
  CHECK(tune.columns[0].upper == 1.76);
  CHECK(scenario_names(study) == std::vector<std::string>{"small", "large"});
}

TEST_CASE("a crank has the orders that the largest one of the bounds and scenarios needs") {
  const Study small = parse(rig + scheduled);
  const Study designed = parse(rig + scheduled + "[[design]]\nparameter = \"A\"\nlower = 10\nupper = 100\n");
  const Study in_scenario = parse(rig + scheduled + "[[scenario]]\nname = \"large\"\nset = { A = 100 }\n");
  CHECK(designed.network.excitations[0].even_orders > small.network.excitations[0].even_orders);
  CHECK(designed.network.excitations[0].even_orders == in_scenario.network.excitations[0].even_orders);
}

TEST_CASE("the task's network and its derivatives are those of the expressions, in every scenario") {
  const Study study = parse(rig + scheduled +
                            "[[scenario]]\nname = \"small\"\nset = { A = 20 }\n"
                            "[[scenario]]\nname = \"large\"\nset = { A = 40 }\n");
  const frahm::tuning::Task task = tuning_task(study);
  CHECK(task.parameters[0].name == "I");
  CHECK(task.parameters[0].nominal == 6.0);
  REQUIRE(task.parameters[0].schedule);
  CHECK_THAT(task.parameters[1].nominal, Catch::WithinRel(11e3, rounding));
  const std::vector<double> at{7.0, 12e3, 25.0};
  frahm::mechanics::NetworkValues values;
  std::vector<frahm::mechanics::NetworkValues> slopes;
  task.network_at(1, at, values, &slopes);
  CHECK(values.omega == 25.0);
  CHECK(values.element == std::vector<double>{57e3, 12e3, 30.0, 7.0});
  CHECK_THAT(values.excitation[0].amplitude, Catch::WithinRel(0.04, rounding));
  REQUIRE(slopes.size() == 3);
  CHECK(slopes[0].element == std::vector<double>{0.0, 0.0, 0.5, 1.0});
  CHECK(slopes[1].element == std::vector<double>{0.0, 1.0, 0.0, 0.0});
  CHECK(slopes[2].omega == 1.0);
  task.network_at(0, at, values, nullptr);
  CHECK_THAT(values.excitation[0].amplitude, Catch::WithinRel(0.02, rounding));
}

TEST_CASE("a weight has its slope over the band") {
  const Study study = parse(heading + absorber + minimax + "weight = \"P/r^2\"\n" + of_f);
  const auto weight = tuning_task(study).weight(0.8);
  CHECK_THAT(weight.value, Catch::WithinRel(1.0 / 0.64, rounding));
  CHECK_THAT(weight.slope, Catch::WithinRel(-2.0 / 0.512, rounding));
}

TEST_CASE("a variance without limits needs no band, and its task no frequency") {
  const Study study = parse(
      heading + absorber +
      "[tune]\nobjective = \"variance\"\nquantity = \"main_rms\"\nnoise = { force_on = \"main\" }\n" + of_f);
  CHECK_FALSE(study.tune()->band);
  const auto task = tuning_task(study);
  std::vector<frahm::mechanics::NetworkValues> slopes;
  frahm::mechanics::NetworkValues values;
  task.network_at(0, std::vector<double>{1.1, 1.0}, values, &slopes);
  REQUIRE(slopes.size() == 2);
  CHECK_THAT(slopes[0].element[1], Catch::WithinRel(0.05 * 2.2, rounding));
  CHECK(slopes[1].omega == 0.0);
  CHECK(slopes[1].element == std::vector<double>(3, 0.0));
}

TEST_CASE("a rule follows the study as it stands and keeps within the bounds") {
  const Study study = parse(rig + scheduled);
  const auto rules = rules_of(study);
  REQUIRE(rules[0]);
  CHECK_FALSE(rules[1]);
  CHECK_THAT(rules[0](23.0), Catch::WithinRel(11e3 / 529.0 - 12.82, 10.0 * rounding));
  CHECK(rules[0](16.0) == 12.9);
  CHECK(rules[0](36.0) == 4.72);
}

TEST_CASE("a schedule is linear between its knots and ends with them") {
  const Study study = parse(rig + scheduled);
  const DesignChoice& design = study.tune()->designs[0];
  const DesignCourse course{{5, 6, 8, 8, 9}, design.knots};
  CHECK(value_at(course, design.knots[0]) == 5.0);
  CHECK(value_at(course, design.knots[4]) == 9.0);
  CHECK_THAT(value_at(course, 0.5 * (design.knots[1] + design.knots[2])), Catch::WithinRel(7.0, rounding));
  CHECK(value_at(course, 1.0) == 5.0);
  const auto parameters = parameters_of(study, {course, {{15e3}, {}}}, 0, design.knots[1]);
  CHECK_THAT(parameters[*study.parameters.find("I")], Catch::WithinRel(6.0, rounding));
  CHECK(parameters[*study.parameters.find("k")] == 15e3);
}

TEST_CASE("a tuning over records has what drives each of its motions, and the peak it presses down") {
  const Study study = parse(
      "[study]\nschema = 1\nkind = \"tune\"\n[parameters]\nk = 4.0\nF = 0.1\n"
      "[[mass]]\nname = \"m\"\nmass = 1.0\n"
      "[[element]]\nname = \"spring\"\ntype = \"spring\"\nbetween = [\"base\", \"m\"]\nstiffness = \"k\"\n"
      "[[element]]\nname = \"friction\"\ntype = \"coulomb\"\nbetween = [\"base\", \"m\"]\nforce = \"F\"\n"
      "[[excitation.record]]\nacceleration_of = \"base\"\nscale = 2\n"
      "[tune]\nobjective = \"mean_peak\"\nquantity = \"drift_peak\"\nstart = 3\n"
      "records = { generate = \"white\", count = 2, duration = 5, rate = 20, intensity = 0.1 }\n"
      "[[design]]\nparameter = \"F\"\nlower = 0\nupper = 1\n"
      "[[scenario]]\nname = \"soft\"\nset = { k = 3.0 }\n"
      "[[output.signal]]\nname = \"drift\"\nalong = { m = 1, base = -1 }\n");
  const auto task = record_task(study);
  CHECK(task.goal.objective == frahm::tuning::RecordObjective::mean_peak);
  CHECK(task.coordinate == 1);
  CHECK(task.duration == 5.0);  // the longest record's
  CHECK(study.tune()->starts == 3);
  CHECK(study.tune()->peaks->records == std::vector<std::string>{"white 0", "white 1"});
  REQUIRE(task.records.size() == 2);
  CHECK(task.records[0][0].record->values != task.records[1][0].record->values);
  frahm::mechanics::NetworkValues values;
  std::vector<frahm::mechanics::NetworkValues> by;
  task.network_at(0, std::vector<double>{0.7}, values, &by);
  CHECK(values.element == std::vector<double>{3.0, 0.7});
  CHECK(values.excitation[0].amplitude == 2.0);
  CHECK(by[0].element == std::vector<double>{0.0, 1.0});
}

// A mass whose ground shakes; samples of the factor e on its friction.
const std::string over_samples =
    "[study]\nschema = 1\nkind = \"tune\"\n[parameters]\nF = 0.1\ne = 1\n"
    "[[mass]]\nname = \"m\"\nmass = 1\n"
    "[[element]]\nname = \"spring\"\ntype = \"spring\"\nbetween = [\"base\", \"m\"]\nstiffness = 4\n"
    "[[element]]\nname = \"friction\"\ntype = \"coulomb\"\nbetween = [\"base\", \"m\"]\nforce = \"e*F\"\n"
    "[[excitation.record]]\nacceleration_of = \"base\"\n"
    "[tune]\nobjective = \"worst_peak\"\nquantity = \"spring_stroke\"\nquantile = 0.75\n"
    "records = { generate = \"white\", count = 2, duration = 5, rate = 20, intensity = 0.1 }\n"
    "[[design]]\nparameter = \"F\"\nlower = 0\nupper = 1\n"
    "[[axis]]\nsamples = 8\n"
    "[[axis.of]]\nparameter = \"e\"\ndistribution = \"uniform\"\nlower = 0.5\nupper = 1.5\n";

TEST_CASE("samples are scenarios of a tuning, and a stroke is tuned as a signal's peak") {
  const Study study = parse(over_samples);
  CHECK(study.tune()->scenarios.size() == 8);
  CHECK(study.tune()->drawn == "8 points of sobol, seed 1");
  const frahm::tuning::RecordTask task = record_task(study);
  CHECK(task.goal.share == 0.75);
  CHECK(task.scenarios.size() == 8);
  CHECK(task.records.size() == 2);
  REQUIRE(task.network.signals.size() == 1);
  CHECK(task.coordinate == 1);
  // Each within an eighth of the distribution, however they are shifted.
  std::vector<int> seen(8, 0);
  const double design[] = {2.0};
  for (std::size_t s = 0; s < 8; ++s) {
    frahm::mechanics::NetworkValues values;
    task.network_at(s, design, values, nullptr);
    ++seen.at(static_cast<std::size_t>((values.element[1] / 2.0 - 0.5) * 8.0));
  }
  CHECK(seen == std::vector<int>(8, 1));
}

}  // namespace
}  // namespace tune_study_test
