// An inerter of rack, pinion and flywheel beside the ideal one.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "tests/end_to_end/runs.hpp"

namespace rack_and_pinion_test {
namespace {

using Complex = std::complex<double>;

constexpr double M = 200.0, K = 5e5, k = 42.5e3, c = 350.0, m_rack = 2.0, P = 100.0;
constexpr double r = 0.02, ratio = 3.0, J = 8e-4, b = J * (ratio / r) * (ratio / r);

// Amplitude of the machine whose link is held by a rack of this dynamic stiffness.
double machine(Complex s, Complex rack) {
  const Complex link = k + c * s;
  return std::abs(P / (M * s * s + K + link * rack / (link + rack)));
}

// Of a report's line on one quantity.
std::string line_of(const std::string& report, const std::string& name) {
  const std::size_t at = report.find("\n" + name + " ");
  REQUIRE(at != std::string::npos);
  return report.substr(at + 1, report.find('\n', at + 1) - at - 1);
}

TEST_CASE("rack_and_pinion.toml: without friction the machines move as complex numbers say") {
  const runs::Map map = runs::run_study(runs::reduced("rack_and_pinion", {}));
  const auto& hertz = map.coordinate("f");
  constexpr double tolerance = 1e-9;  // relative: teeth 4000 times as stiff as the link cost digits
  for (std::size_t i = 0; i < hertz.size(); ++i) {
    const Complex s(0.0, 2.0 * std::numbers::pi * hertz[i]);
    // Teeth and the flywheel, as b at the rack, in series.
    const Complex teeth = 2e8 + 2e3 * s, flywheel = b * s * s;
    INFO("f = " << hertz[i] << " Hz");
    CHECK_THAT(
        map["machine_amplitude"][i],
        Catch::WithinRel(machine(s, m_rack * s * s + teeth * flywheel / (teeth + flywheel)), tolerance));
    CHECK_THAT(map["ideal_machine_amplitude"][i],
               Catch::WithinRel(machine(s, (m_rack + b) * s * s), tolerance));
  }
}

TEST_CASE(
    "rack_and_pinion.toml: the flywheel does as the ideal inerter but for the teeth, with friction too") {
  const runs::Map map = runs::run_study(runs::reduced("rack_and_pinion", {{"f", 41}}));
  constexpr double of_teeth = 2e-3;  // b omega^2 over their stiffness is 6e-4 at 13 Hz
  // Where friction all but holds the flywheel, the teeth yield as much as it turns.
  constexpr double least_angle = 2e-5, least_energy = 1e-6;  // [rad], [J]; of 0.3 rad and 0.1 J
  const double bearing = ratio / r;  // turns of the flywheel by the rack's way [rad/m]
  for (std::size_t i = 0; i < map["machine_amplitude"].size(); ++i) {
    INFO("point " << i);
    CHECK(map["status"][i] == 1.0);
    CHECK_THAT(map["machine_amplitude"][i], Catch::WithinRel(map["ideal_machine_amplitude"][i], of_teeth));
    CHECK_THAT(map["flywheel_amplitude"][i],
               Catch::WithinRel(bearing * map["ideal_rack_amplitude"][i], of_teeth) ||
                   Catch::WithinAbs(bearing * map["ideal_rack_amplitude"][i], least_angle));
    CHECK_THAT(map["bearing_energy"][i], Catch::WithinRel(map["ideal_friction_energy"][i], 2.0 * of_teeth) ||
                                             Catch::WithinAbs(map["ideal_friction_energy"][i], least_energy));
  }
}

TEST_CASE("rack_and_pinion.toml: the flywheel's figures are in rad and N m, the rack's in m and N") {
  const runs::Folder folder;
  const runs::Outcome outcome = runs::frahm(
      {"point", folder.write("study.toml", runs::reduced("rack_and_pinion", {})), "--at", "T=0.05,f=8 Hz"});
  CHECK(outcome.code == 0);
  const auto line = [&](const std::string& name) { return line_of(outcome.out, name); };
  CHECK_THAT(line("flywheel_peak"), Catch::Contains("rad"));
  CHECK_THAT(line("bearing_force_peak"), Catch::Contains("N m"));
  CHECK_THAT(line("rack_peak"), !Catch::Contains("rad"));
  CHECK_THAT(line("teeth_force_peak"), !Catch::Contains("N m"));
}

TEST_CASE("rack_and_pinion.toml: another radius is another study, which --set makes and --at does not") {
  const runs::Folder folder;
  const std::string study = folder.write("study.toml", runs::reduced("rack_and_pinion", {}));
  // A pinion of half the radius and a flywheel of a quarter of the inertia are the same inerter.
  const auto peak = [&](const std::string& set) {
    const runs::Outcome outcome = runs::frahm({"point", study, "--at", "T=0,f=8 Hz", "--set", set});
    CHECK(outcome.code == 0);
    return line_of(outcome.out, "machine_peak");
  };
  CHECK(peak("r=10 mm,J=2 kg cm2") == peak("r=20 mm,J=8 kg cm2"));
  CHECK(peak("r=10 mm,J=8 kg cm2") != peak("r=20 mm,J=8 kg cm2"));
  const runs::Outcome refused = runs::frahm({"point", study, "--at", "r=10 mm,f=8 Hz"});
  CHECK(refused.code != 0);
  CHECK_THAT(refused.err, Catch::Contains("element \"teeth\": along: flywheel") && Catch::Contains("--set"));
}

}  // namespace
}  // namespace rack_and_pinion_test
