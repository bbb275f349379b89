// rig_forced_250rpm_*.toml and run_up.toml: whole runs against the periodic response and the steady state.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <iterator>

#include "solvers/response/periodic_response.hpp"
#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/study.hpp"
#include "tests/end_to_end/motion_file.hpp"
#include "tests/end_to_end/runs.hpp"
#include "tests/study_path.hpp"

namespace transient_test {
namespace {

// Peak of the periodic response of a transient study's system.
double periodic_peak(const frahm::studies::Study& study, const std::string& quantity) {
  namespace periodic = frahm::periodic;
  auto parameters = study.parameters.nominal();
  frahm::mechanics::NetworkValues values;
  evaluate(study.values, study.parameters, parameters, values);
  periodic::PeriodicResponse response(study.network, {*periodic::find_quantity(quantity, study.network)});
  response.set_values(values);
  response.solve();
  double peak = 0.0;
  response.quantities({&peak, 1});
  return peak;
}

TEST_CASE("rig_forced_250rpm_*.toml: after 250 periods from rest the motion is the periodic one") {
  for (const char* name : {"rig_forced_250rpm_I6", "rig_forced_250rpm_I13", "rig_forced_250rpm_I6_crank",
                           "rig_forced_250rpm_I13_crank"}) {
    const std::string path = study_path(name);
    const runs::MotionFile file(path, "transient");
    const auto study = frahm::studies::read_study(path);
    INFO(name);
    for (const std::string mass : {"main", "tmd"}) {
      const auto& x = file[mass + "_displacement"];
      double largest = 0.0;
      for (std::size_t i = x.size() - 1200; i < x.size(); ++i) largest = std::max(largest, std::abs(x[i]));
      const double peak = periodic_peak(study, mass + "_peak");
      // Ten periods of 120 samples: the largest sample is below the peak by at most (pi/120)^2/2 of it.
      CHECK(largest <= peak * (1.0 + 1e-9));
      CHECK(largest > peak * (1.0 - 5e-4));
      CHECK(file[mass + "_peak"][0] >= largest);
    }
    // Both guides stick at first, but the crank starts with its slider 3.7 mm off, which drags the main mass
    // on at once.
    const bool crank = path.ends_with("_crank.toml");
    const std::string sticking = crank ? "tmd_friction" : "guide";
    CHECK(file[sticking + "_stop_onset"][0] == 0.0);
    CHECK(file[sticking + "_release"][0] > 0.0);
    CHECK(std::isnan(file["guide_stop_onset"][0]) == crank);
  }
}

TEST_CASE("rig_forced_250rpm_periodic.toml: both runs in the steady state, crank and harmonic") {
  const runs::Map map = runs::run_study(runs::reduced("rig_forced_250rpm_periodic", {}));
  const std::string names[] = {"rig_forced_250rpm_I6", "rig_forced_250rpm_I13"};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto harmonic = frahm::studies::read_study(study_path(names[i]));
    const auto crank = frahm::studies::read_study(study_path(names[i] + std::string("_crank")));
    for (const std::string peak : {"main_peak", "tmd_peak"}) {
      INFO(names[i] << " " << peak);
      CHECK_THAT(map[peak][i], Catch::WithinRel(periodic_peak(crank, peak), 1e-9));
      CHECK_THAT(map[peak + "_compared"][i], Catch::WithinRel(periodic_peak(harmonic, peak), 1e-9));
    }
    CHECK_THAT(map["main_peak_difference"][i], Catch::WithinAbs(0.015, 0.001));
  }
}

TEST_CASE("run_up.toml: the resonance passed in a run-up stays below that of the steady state") {
  const runs::MotionFile file(study_path("run_up"), "transient");
  const double peak = file["machine_peak"][0], steady = 0.16 / (2.0 * 0.05 * 200.0);
  CHECK(peak < steady);
  CHECK(peak > 0.5 * steady);
  CHECK(file["discretisation_error"][0] <= 1e-6 * peak);
  // The peak comes after the resonance at 50 rad/s has been passed.
  const double alpha = 100.0 * std::acos(-1.0) / 30.0, resonance = (50.0 - alpha) / alpha;
  CHECK(file["machine_peak_time"][0] > resonance);
  CHECK_THAT(file["frequency"].back(), Catch::WithinRel(1000.0, 1e-12));  // rpm, as the study speaks of it
  CHECK_THAT(file["time"].back(), Catch::WithinRel(9.0, 1e-12));
}

TEST_CASE("A transient of a wrong sweep, or of a network that cannot move, is refused with its reason") {
  const runs::Outcome same = runs::frahm({"run", study_path("run_up"), "-o", "-", "--set", "omega=1000 rpm"});
  CHECK(same.code == 2);
  CHECK_THAT(same.err, Catch::Contains("sweep_to: is also the frequency at which the motion begins"));
  const runs::Outcome still = runs::frahm({"check", study_path("run_up"), "--set", "M=0 kg"});
  CHECK(still.code == 2);
  CHECK_THAT(still.err, Catch::Contains("mass matrix"));
}

}  // namespace
}  // namespace transient_test
