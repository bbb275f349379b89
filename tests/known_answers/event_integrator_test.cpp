#include "tests/known_answers/event_integrator.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "solvers/orbits/closed_forms.hpp"
#include "tests/known_answers/responses.hpp"
#include "tests/known_answers/rig.hpp"
#include "tests/known_answers/single_mass.hpp"

// The orbits found, against an independent integration with set-valued friction.
namespace frahm::periodic::event_integrator_test {
namespace {

using Catch::Matchers::WithinAbs;
constexpr double kAmplitude = 1e-8;  // relative to the largest amplitude
constexpr double kClosure =
    1e-8;  // of the state after a period, relative to displacement and velocity amplitudes

// One period of the independent flow from the state that the orbit has at omega t = 0.
void check_orbit(Responses& responses, const mechanics::NetworkValues& values) {
  responses.solve(values);
  REQUIRE((responses["status"] == 1.0 || responses["status"] == 2.0));
  const mechanics::Assembly assembly(responses.network());
  mechanics::LinearSystem system;
  assembly.set_values(values, system);
  assembly.set_forcing(values, system);
  const History history = responses.response().history(frahm::periodic::phases_of_a_period(2));
  const Eigen::Index n = system.masses();
  Eigen::VectorXd q(n), v(n);
  double largest = 0.0, fastest = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto column = static_cast<std::size_t>(2 * i);
    q[i] = history.columns[column][0];
    v[i] = history.columns[column + 1][0];
    const std::string& name = responses.network().masses[static_cast<std::size_t>(i)];
    largest = std::max(largest, responses[name + "_amplitude"]);
    fastest = std::max(fastest, responses[name + "_velocity_peak"]);
  }
  EventIntegrator reference(system);
  reference.start(0.0, q, v);
  reference.advance_to(2.0 * std::numbers::pi / values.omega);
  const double q_error = (reference.displacements() - q).cwiseAbs().maxCoeff() / largest;
  const double v_error = (reference.velocities() - v).cwiseAbs().maxCoeff() / fastest;
  INFO("events " << reference.events());
  CHECK(q_error < kClosure);
  CHECK(v_error < kClosure);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::string& name = responses.network().masses[static_cast<std::size_t>(i)];
    CHECK_THAT(reference.amplitude(i), WithinAbs(responses[name + "_amplitude"], kAmplitude * largest));
  }
}

TEST_CASE("The independent integration itself settles on Den Hartog's and the one-stop amplitude") {
  for (const auto& [r, f] : {std::pair{0.8, 0.3}, {1.3, 0.8}}) {
    const mechanics::Network network = single_mass();
    const mechanics::Assembly assembly(network);
    mechanics::LinearSystem system;
    const mechanics::NetworkValues values = single_mass_values(r, 0.3, f);
    assembly.set_values(values, system);
    assembly.set_forcing(values, system);
    EventIntegrator reference(system);
    reference.start(0.0, Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(1));
    const double period = 2.0 * std::numbers::pi / r;
    reference.advance_to(15.0 * period);
    reference.start(15.0 * period, reference.displacements(), reference.velocities());
    reference.advance_to(16.0 * period);
    INFO("r " << r << " f " << f);
    CHECK_THAT(reference.amplitude(0), WithinAbs(classical_amplitude(r, 0.3, f), 1e-9));
  }
}

TEST_CASE("One mass at random points moves as the independent integration says") {
  std::mt19937 random(20240501);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Responses responses(single_mass());
  for (int point = 0; point < 20; ++point) {
    const double r = 0.05 * std::pow(60.0, uniform(random));
    const double zeta = 0.1 * uniform(random), f = 0.95 * uniform(random);
    INFO("r " << r << " zeta " << zeta << " f " << f);
    check_orbit(responses, single_mass_values(r, zeta, f));
  }
}

TEST_CASE("The rig at random points moves as the independent integration says") {
  std::mt19937 random(20240502);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Responses responses(rig());
  for (int point = 0; point < 20; ++point) {
    const double omega = 15.0 + 22.0 * uniform(random), I = 4.72 + 8.18 * uniform(random);
    const double share = 0.9 * uniform(random), d = 60.0 * uniform(random);
    INFO("omega " << omega << " I " << I << " F/P " << share << " d " << d);
    check_orbit(responses, rig_values(omega, I, share, d));
  }
}

}  // namespace
}  // namespace frahm::periodic::event_integrator_test
