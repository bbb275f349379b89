#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "solvers/events/walk.hpp"
#include "tests/known_answers/responses.hpp"
#include "tests/known_answers/single_mass.hpp"

// Low frequencies: with low damping, where one half cycle holds many stops, against a long forward march from
// rest; and where friction holds for ever, against the closed form.
namespace frahm::periodic::low_frequency_test {
namespace {

constexpr double kBalance = 1e-10;
constexpr double kAgreement = 1e-9;  // of the displacement at omega t = 0 after the march [P/k]

// The state at omega t = 0 after `periods` of the flow from rest.
Eigen::Vector2d march(const mechanics::NetworkValues& values, int periods) {
  const mechanics::Assembly assembly(single_mass());
  mechanics::LinearSystem system;
  assembly.set_values(values, system);
  assembly.set_forcing(values, system);
  Flow<1, 1> flow;
  flow.set_system(system);
  flow.set_forcing(system);
  Passage<1, 1> passage;
  Eigen::Vector2d z = Eigen::Vector2d::Zero();
  for (int period = 0; period < periods; ++period) {
    Walk(flow).pass(z, 0.0, flow.equations().period, passage);
    REQUIRE(passage.failure == nullptr);
    z = passage.end;
  }
  z[1] /= flow.equations().step;
  return z;
}

TEST_CASE("At low frequency the orbit with many stops is the one that a long march from rest settles on") {
  Responses responses(single_mass());
  double most_stops = 0.0;
  for (const double r : {0.05, 0.09, 0.13, 0.2, 0.3}) {
    for (const double zeta : {0.0, 0.01, 0.1}) {
      for (const double f : {0.01, 0.05, 0.2, 0.5, 0.9}) {
        const mechanics::NetworkValues values = single_mass_values(r, zeta, f);
        responses.solve(values);
        INFO("r " << r << " zeta " << zeta << " f " << f << " stops " << responses["friction_stops"]);
        CHECK((responses["status"] == 1.0 || responses["status"] == 2.0));
        CHECK(responses["energy_balance"] < kBalance);
        CHECK(responses["floquet_radius"] <= 1.0 + 1e-9);
        most_stops = std::max(most_stops, responses["friction_stops"]);
        // The slowest multiplier says how long the march takes.
        const double radius = responses["floquet_radius"];
        const int periods = 3 + static_cast<int>(std::log(1e-15) / std::log(std::max(radius, 1e-6)));
        if (periods > 5000) continue;
        const Eigen::Vector2d z = march(values, periods);
        const History history = responses.response().history(frahm::periodic::phases_of_a_period(2));
        CHECK(std::abs(z[0] - history.columns[0][0]) < kAgreement);
        CHECK(std::abs(z[1] - history.columns[1][0]) < kAgreement);
      }
    }
  }
  CHECK(most_stops >= 8.0);
}

// Two masses that friction ties for ever, on springs and a damper to ground: one mass of 3 kg in all.
TEST_CASE("Masses that friction ties stay together through a long period, within the error bound") {
  using namespace mechanics;
  const Node ground{}, a{NodeKind::mass, 0}, b{NodeKind::mass, 1};
  Responses responses({.masses = {"a", "b"},
                       .elements = {{"ka", ElementType::spring, ground, a},
                                    {"kb", ElementType::spring, ground, b},
                                    {"c", ElementType::damper, ground, a},
                                    {"tie", ElementType::coulomb, a, b}},
                       .excitations = {{ExcitationKind::force, 0, 0}, {ExcitationKind::force, 1, 1}}});
  const double mass = 3.0, stiffness = 1.7, damping = 5.3, constant = 0.52, amplitude = 0.351;
  for (const double omega : {0.001, 0.003, 0.01, 0.1}) {
    INFO("omega " << omega);
    responses.solve({.omega = omega,
                     .mass = {1.7, 1.3},
                     .element = {1.0, 0.7, damping, 10.0},
                     .excitation = {{constant, 0.0}, {amplitude, 0.0}}});
    // X = P / |k - m omega^2 + i omega c|, about the static displacement under the constant force.
    const double exact = amplitude / std::hypot(stiffness - mass * omega * omega, damping * omega);
    const double bound = responses["error_bound"];
    CHECK(bound < 1e-10);
    for (const char* name : {"a", "b"}) {
      CHECK(std::abs(responses[std::string(name) + "_amplitude"] - exact) <= bound);
      CHECK(std::abs(responses[std::string(name) + "_mean"] - constant / stiffness) <= bound);
    }
    CHECK(responses["tie_stroke"] <= 2.0 * bound);
    CHECK(responses["energy_balance"] < kBalance);
  }
}

}  // namespace
}  // namespace frahm::periodic::low_frequency_test
