#include <catch2/catch.hpp>
#include <cmath>

#include "tests/known_answers/responses.hpp"
#include "tests/known_answers/rig.hpp"
#include "tests/known_answers/single_mass.hpp"

// Contacts that never slide: their rest position is that of least (1/2) q^T K q with |lambda_j(t)| <= F_j.
namespace frahm::periodic::rest_position_test {
namespace {

using Catch::Matchers::WithinAbs;
using namespace mechanics;
constexpr double kAgreement = 1e-9;
constexpr double kBalance = 1e-10;

void check_stuck_at(Responses& responses, const NetworkValues& values, double position, bool warm = false) {
  responses.solve(values, warm);
  CHECK((responses["status"] == 1.0 || responses["status"] == 2.0));
  CHECK(responses["friction_regime"] == static_cast<double>(Regime::stuck));
  CHECK(responses["friction_stuck_fraction"] == 1.0);
  CHECK(responses["friction_stops"] == 0.0);
  CHECK_THAT(responses["x_mean"], WithinAbs(position, kAgreement));
  CHECK_THAT(responses["x_amplitude"], WithinAbs(0.0, kAgreement));
  CHECK_THAT(responses["floquet_radius"], WithinAbs(0.0, kAgreement));
  CHECK(responses["energy_balance"] < kBalance);
}

TEST_CASE("Under a symmetric force a mass held by friction rests at zero") {
  Responses responses(single_mass());
  for (const double f : {1.0, 1.0 + 1e-9, 1.05, 1.1, 2.0}) {
    for (const double zeta : {0.0, 1e-4, 0.05}) {
      for (double r = 0.05; r < 3.0; r *= 1.13) {
        INFO("r " << r << " zeta " << zeta << " f " << f);
        check_stuck_at(responses, single_mass_values(r, zeta, f), 0.0);
      }
    }
  }
}

TEST_CASE("Under a force of even order a mass held by friction rests at zero too") {
  Network network = single_mass();
  network.excitations[0].order = network.reference_order = 2;
  Responses responses(network);
  for (const double f : {1.1, 1.5, 3.0}) {
    for (const double r : {0.1, 0.4, 1.0, 3.0}) {
      INFO("r " << r << " f " << f);
      check_stuck_at(responses, single_mass_values(r, 0.05, f), 0.0);
    }
  }
}

TEST_CASE("Under a constant load a held mass rests where the spring is strained least") {
  Network network = single_mass();
  network.excitations.push_back({ExcitationKind::force, 0, 0});
  Responses responses(network);
  // |cos(r tau) + load - x| <= f: x in [load + 1 - f, load - 1 + f]
  for (const double f : {1.1, 1.5, 3.0}) {
    for (const double load : {0.05, 0.3, 2.0, -2.0}) {
      for (const double r : {0.4, 1.0, 3.0}) {
        NetworkValues values = single_mass_values(r, 0.05, f);
        values.excitation.push_back({std::abs(load), load < 0.0 ? M_PI : 0.0});
        const double room = f - 1.0;
        const double position = std::abs(load) <= room ? 0.0 : load - std::copysign(room, load);
        INFO("r " << r << " f " << f << " load " << load);
        check_stuck_at(responses, values, position);
        CHECK(responses["status"] == (std::abs(load) < room ? 1.0 : 2.0));
      }
    }
  }
}

TEST_CASE("A sliding mass under a constant load swings about the load's own position") {
  Network network = single_mass();
  network.excitations.push_back({ExcitationKind::force, 0, 0});
  Responses loaded(network), free(single_mass());
  for (const double r : {0.4, 1.0, 2.0}) {
    NetworkValues values = single_mass_values(r, 0.05, 0.6);
    free.solve(values);
    values.excitation.push_back({0.7, 0.0});
    loaded.solve(values);
    INFO("r " << r);
    CHECK_THAT(loaded["x_mean"], WithinAbs(0.7, kAgreement));
    CHECK_THAT(loaded["x_amplitude"], WithinAbs(free["x_amplitude"], kAgreement));
  }
}

// Newton's method slides ever less here and does not arrive within its passages.
TEST_CASE(
    "An absorber held by friction moves with its mass beside the resonances of an undamped system too") {
  const Node ground{}, main{NodeKind::mass, 0}, absorber{NodeKind::mass, 1};
  Responses responses({.masses = {"main", "absorber"},
                       .elements = {{"main_spring", ElementType::spring, ground, main},
                                    {"absorber_spring", ElementType::spring, main, absorber},
                                    {"friction", ElementType::coulomb, main, absorber}},
                       .excitations = {{ExcitationKind::force, 0, 1}}});
  constexpr double mu = 0.05, f = 0.8, force = 0.09;
  // (1 - r^2) (f^2 - r^2) = mu f^2 r^2, the lower root
  const double b = 1.0 + f * f * (1.0 + mu);
  const double resonance = std::sqrt(0.5 * (b - std::sqrt(b * b - 4.0 * f * f)));
  for (const double away : {-1e-4, -1e-5, -1e-6, 0.0, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4}) {
    const double r = resonance * (1.0 + away);
    INFO("r = " << r << ", away by " << away);
    responses.solve(
        {.omega = r, .mass = {1.0, mu}, .element = {1.0, mu * f * f, force}, .excitation = {{1.0, 0.0}}});
    CHECK(responses["status"] == 1.0);
    CHECK(responses["friction_regime"] == static_cast<double>(Regime::stuck));
    CHECK_THAT(responses["main_amplitude"], WithinAbs(1.0 / (1.0 - (1.0 + mu) * r * r), kAgreement));
  }
}

TEST_CASE("The rig with a clamped absorber moves as one mass, followed in frequency and from nothing") {
  Responses cold(rig()), warm(rig()), joined(rig(false));
  for (const double share : {0.0, 0.1}) {
    warm.response().forget();
    for (double omega = 16.0; omega < 36.0; omega += 0.5) {
      const double clamp = 2000.0;  // [N], far above what the absorber's inertia asks for
      const NetworkValues values = rig_values(omega, 6.36, share, clamp);
      NetworkValues one = bare_rig_values(omega, share);
      one.mass[0] += 12.82;
      joined.solve(one);
      cold.solve(values);
      warm.solve(values, true);
      INFO("omega " << omega << " F/P " << share);
      for (const Responses* responses : {&cold, &warm}) {
        CHECK(((*responses)["status"] == 1.0 || (*responses)["status"] == 2.0));
        CHECK_THAT((*responses)["main_amplitude"], WithinAbs(joined["main_amplitude"], kAgreement));
        CHECK_THAT((*responses)["tmd_spring_stroke"], WithinAbs(0.0, kAgreement));
        CHECK((*responses)["tmd_friction_regime"] == static_cast<double>(Regime::stuck));
      }
    }
  }
}

}  // namespace
}  // namespace frahm::periodic::rest_position_test
