#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "solvers/tuning/optimum.hpp"
#include "studies/map/map_plan.hpp"
#include "studies/map/output_quantities.hpp"
#include "studies/motion/one_motion.hpp"
#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/tuning/sweep_study.hpp"
#include "studies/tuning/tuning_plan.hpp"
#include "studies/tuning/tuning_task.hpp"
#include "tests/studies/small_studies.hpp"
#include "tests/studies/small_tunings.hpp"

namespace signal_study_test {
// [[output.signal]] in every kind of study.
namespace {

using namespace frahm;
using namespace frahm::studies;
using namespace mechanics;

std::string signal(const std::string& name, const std::string& along) {
  return "[[output.signal]]\nname = \"" + name + "\"\nalong = { " + along + " }\n";
}

Node mass(std::size_t index) {
  return {NodeKind::mass, index};
}

const std::string sweep = small_studies::oscillator() + small_studies::axis("r", 0.1, 2, 11);

// The same system without an excitation, displaced.
std::string motion(const std::string& kind) {
  std::string text = small_studies::oscillator();
  text.replace(text.find("\"sweep\""), 7, "\"" + kind + "\"");
  if (kind == "decay") text.erase(text.find("[excitation]"));
  return text + (kind == "decay" ? "[decay]\nsamples = 11\n" : "[transient]\nduration = 20\nsamples = 11\n") +
         "[[initial]]\nnode = \"main\"\ndisplacement = 2\n";
}

const results::Column& column(const std::vector<results::Column>& columns, const std::string& name) {
  const auto found =
      std::ranges::find(columns, name, [](const results::Column& each) { return each.variable.name; });
  REQUIRE(found != columns.end());
  return *found;
}

TEST_CASE("a signal is read with its factors, which may be expressions of what stays") {
  const Study study = parse_study(
      sweep + signal("twice", "main = \"2*k\", ground = -1") + signal("half", "main = 0.5"), "study.toml");
  REQUIRE(study.network.signals.size() == 2);
  CHECK(study.network.signals[0].name == "twice");
  CHECK(study.network.signals[0].along == Direction{{mass(0), 2.0}, {Node{}, -1.0}});
  CHECK(study.network.signals[1].along == Direction{{mass(0), 0.5}});
  const Assignment changed{*study.parameters.find("k"), 3.0};
  CHECK(with_parameters(study, {&changed, 1}).network.signals[0].along.front().factor == 6.0);
}

TEST_CASE("signals repeat with their storeys") {
  const Study study = parse_study(small_studies::building(4, 2, 3) +
                                      "[[output.signal]]\nrepeat = { i = [2, 4] }\nname = \"drift{i}\"\n"
                                      "along = { \"floor{i}\" = 1, \"floor{i-1}\" = -1 }\n",
                                  "study.toml");
  REQUIRE(study.network.signals.size() == 3);
  CHECK(study.network.signals[2].name == "drift4");
  CHECK(study.network.signals[2].along == Direction{{mass(3), 1.0}, {mass(2), -1.0}});
}

TEST_CASE("the standard record has peak, amplitude, mean, rms and phase of each signal, as of each mass") {
  const Study study = parse_study(sweep + signal("half", "main = 0.5"), "study.toml");
  std::vector<std::string> names;
  for (const auto& variable : output_variables(study, output_quantities(study)))
    names.push_back(variable.name);
  const std::vector<std::string> of_signal{"half_peak", "half_amplitude", "half_mean", "half_rms",
                                           "half_phase"};
  CHECK(std::search(names.begin(), names.end(), of_signal.begin(), of_signal.end()) != names.end());
  CHECK(names.size() == 16 + of_signal.size());
  CHECK_FALSE(periodic::find_quantity("half_energy", study.network));
  CHECK_FALSE(periodic::find_quantity("half_stroke", study.network));
}

TEST_CASE("a signal of rotations is an angle, and over a radius a length") {
  const std::string wheel =
      "[study]\nschema = 1\nkind = \"sweep\"\n[parameters]\nomega = 1\n"
      "[[mass]]\nname = \"wheel\"\ninertia = 2\n"
      "[[element]]\nname = \"bar\"\ntype = \"spring\"\nbetween = [\"ground\", \"wheel\"]\nstiffness = 8\n"
      "[excitation]\nfrequency = \"omega\"\n[[excitation.force]]\non = \"wheel\"\namplitude = 1\n" +
      small_studies::axis("omega", 0.1, 2, 11);
  const Study study = parse_study(
      wheel + signal("turn", "wheel = 1") + signal("rim", "wheel = { value = 100, unit = \"mm\" }"),
      "wheel.toml");
  const auto unit = [&](const std::string& name) {
    return periodic::describe(*periodic::find_quantity(name, study.network), study.network, false).unit;
  };
  CHECK(unit("turn_peak") == "rad");
  CHECK(unit("rim_peak") == "m");
  CHECK(unit("rim_acceleration_peak") == "m s-2");
  CHECK(study.network.signals[1].along.front().factor == 0.1);
}

TEST_CASE("a signal and its factors are part of the physics, and a study without one is what it was") {
  const auto of = [](const std::string& text) {
    return plan_map(parse_study(text, "small.toml"), {}).fingerprint;
  };
  const auto half = of(sweep + signal("half", "main = 0.5"));
  CHECK(half.physics != of(sweep).physics);
  CHECK(half.physics != of(sweep + signal("half", "main = 0.25")).physics);
  CHECK(half == of(sweep + signal("half", "main = 5e-1")));
  CHECK(of(sweep) == of(sweep + "[output]\n"));
}

TEST_CASE("the records of a decay and of a transient have a signal's motion beside the masses'") {
  for (const std::string kind : {"decay", "transient"}) {
    INFO(kind);
    const Study study = parse_study(motion(kind) + signal("half", "main = 0.5"), "study.toml");
    const auto columns = kind == "decay" ? decay_columns(study, solve_decay(study))
                                         : transient_columns(study, solve_transient(study));
    for (const std::string what : {"displacement", "velocity"}) {
      const auto &own = column(columns, "main_" + what).values,
                 &half = column(columns, "half_" + what).values;
      REQUIRE(own.size() == half.size());
      for (std::size_t i = 0; i < own.size(); ++i) CHECK(half[i] == 0.5 * own[i]);
    }
    CHECK(column(columns, "half_acceleration").variable.long_name == "acceleration of half");
    const std::string largest = kind == "decay" ? "extremum" : "peak";
    CHECK(column(columns, "half_" + largest).values[0] == 0.5 * column(columns, "main_" + largest).values[0]);
  }
}

// The classical absorber of a unit mass, tuned for the mass and for a signal that is the mass.
TEST_CASE("a tuning whose objective is a signal of one mass finds the design that the mass has") {
  using namespace small_tunings;
  std::string of_signal = classical;
  of_signal.replace(of_signal.find("main_peak"), 9, "same_peak");
  const Study own = parse_study(classical, "tuning.toml");
  const Study same = parse_study(of_signal + signal("same", "main = 1"), "tuning.toml");
  const tuning::Task own_task = tuning_task(own), same_task = tuning_task(same);
  const tuning::Optimum a = tuning::tune(own_task, 0, [] { return false; }).front();
  const tuning::Optimum b = tuning::tune(same_task, 0, [] { return false; }).front();
  CHECK(a.outcome == tuning::Outcome::converged);
  CHECK(b.outcome == a.outcome);
  CHECK(b.objective == a.objective);
  REQUIRE(a.parameters.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) CHECK(b.parameters[i].value == a.parameters[i].value);
}

TEST_CASE("a signal is a limit of a tuning, and stays in the sweep at its optimum") {
  using namespace small_tunings;
  StoredTuning stored;
  stored.study = parse_study(classical +
                                 "[[constraint]]\nquantity = \"drift_peak\"\nupper = 20\n"
                                 "[[constraint]]\nquantity = \"drift_acceleration_peak\"\nupper = 40\n" +
                                 signal("drift", "tmd = 1, main = -1"),
                             "tuning.toml");
  stored.design = {{{0.95}, {}}, {{0.13}, {}}};
  stored.band = {0.7, 0.9, 1.3};
  const Study study = parse_study(sweep_study(stored, "optimum").text, "optimum.toml");
  REQUIRE(study.network.signals.size() == 1);
  CHECK(study.network.signals[0].along == Direction{{mass(1), 1.0}, {mass(0), -1.0}});
  CHECK(output_quantities(study).size() == 4);
}

}  // namespace
}  // namespace signal_study_test
