#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "solvers/orbits/closed_forms.hpp"
#include "solvers/orbits/shooting.hpp"
#include "tests/known_answers/responses.hpp"
#include "tests/known_answers/single_mass.hpp"

// The seven points at which switching between sticking and sliding can go wrong.
namespace frahm::periodic::switching_test {
namespace {

using Catch::Matchers::WithinAbs;
using namespace mechanics;
constexpr double kAgreement = 1e-9;

const Node kGround{}, kFirst{NodeKind::mass, 0}, kSecond{NodeKind::mass, 1},
    kSupport{NodeKind::prescribed, 0};

LinearSystem system_of(const Network& network, const NetworkValues& values) {
  const Assembly assembly(network);
  LinearSystem system;
  assembly.set_values(values, system);
  assembly.set_forcing(values, system);
  return system;
}

bool is_solved(const Responses& responses) {
  return responses["status"] == 1.0 || responses["status"] == 2.0;
}

// Two masses of 1 kg with friction to ground and between them, both at rest, and a steady pull on the second.
// Accelerations [m/s^2] in the first instants.
Eigen::Vector2d accelerations_from_rest(double pull, double to_ground, double between) {
  const Network network{.masses = {"a", "b"},
                        .elements = {{"k", ElementType::spring, kGround, kFirst},
                                     {"k2", ElementType::spring, kFirst, kSecond},
                                     {"ground", ElementType::coulomb, kGround, kFirst},
                                     {"between", ElementType::coulomb, kFirst, kSecond}},
                        .excitations = {{ExcitationKind::force, 1, 0}}};
  constexpr double kSoft = 1e-9;  // springs that hold nothing in the time looked at [N/m]
  const LinearSystem system =
      system_of(network, {1.0, {1.0, 1.0}, {kSoft, kSoft, to_ground, between}, {{pull, 0.0}}});
  Flow<2, 1> flow;
  flow.set_system(system);
  flow.set_forcing(system);
  Passage<2, 1> passage;
  constexpr double kTime = 1e-3;  // [s]
  Walk(flow).pass(Eigen::Vector4d::Zero(), 0.0, kTime / flow.equations().step, passage);
  REQUIRE(passage.failure == nullptr);
  return passage.end.head<2>() * 2.0 / (kTime * kTime);
}

TEST_CASE("1. The modes of all contacts at rest are chosen together") {
  constexpr double kAcceleration = 1e-6;
  const auto check = [&](double pull, double to_ground, double between, double first, double second) {
    const Eigen::Vector2d a = accelerations_from_rest(pull, to_ground, between);
    INFO("pull " << pull << " ground " << to_ground << " between " << between);
    CHECK_THAT(a[0], WithinAbs(first, kAcceleration));
    CHECK_THAT(a[1], WithinAbs(second, kAcceleration));
  };
  check(0.9, 1.0, 1.2, 0.0, 0.0);    // both stick
  check(1.5, 1.0, 1.3, 0.25, 0.25);  // they slide together: the contact between carries 1.25
  check(1.5, 1.0, 1.2, 0.2, 0.3);    // both slide: 1.2 pulls the first, 1.5 - 1.2 the second
  check(1.5, 1.0, 0.8, 0.0, 0.7);    // only the second slides
  check(-1.5, 1.0, 1.2, -0.2, -0.3);
  check(1.0, 1.0, 5.0, 0.0, 0.0);  // a tie sticks
}

TEST_CASE("1. A mass cannot stick to ground and to a moving support at once: the stronger contact holds it") {
  const Network network{.masses = {"x"},
                        .prescribed = {"support"},
                        .elements = {{"k", ElementType::spring, kGround, kFirst},
                                     {"c", ElementType::damper, kGround, kFirst},
                                     {"ground", ElementType::coulomb, kGround, kFirst},
                                     {"belt", ElementType::coulomb, kSupport, kFirst}},
                        .excitations = {{ExcitationKind::motion, 0, 1}}};
  Responses responses(network);
  for (const double omega : {0.3, 1.0, 2.0}) {
    responses.solve({omega, {1.0}, {1.0, 0.1, 1.0, 0.2}, {{0.25, 1.0}}});
    INFO("omega " << omega);
    CHECK(is_solved(responses));
    CHECK_THAT(responses["x_amplitude"], WithinAbs(0.0, kAgreement));
    CHECK(responses["ground_regime"] == static_cast<double>(Regime::stuck));
    CHECK(responses["belt_regime"] == static_cast<double>(Regime::non_stop));
    CHECK_THAT(responses["belt_energy"], WithinAbs(0.2 * 4.0 * 0.25, kAgreement));

    responses.solve({omega, {1.0}, {1.0, 0.1, 0.2, 3.0}, {{0.25, 1.0}}});
    CHECK(is_solved(responses));
    CHECK_THAT(responses["x_amplitude"], WithinAbs(0.25, kAgreement));
    CHECK(responses["belt_regime"] == static_cast<double>(Regime::stuck));
    CHECK(responses["ground_regime"] == static_cast<double>(Regime::non_stop));
    CHECK(responses["ground_reversals"] == 2.0);
  }
}

TEST_CASE("2. A velocity that touches zero twice within a step is not missed") {
  // Inside r < 0.4 the supremum S lies within the half cycle: just beyond f_crit the velocity has two close
  // roots.
  Responses responses(single_mass());
  for (const double r : {0.12, 0.2, 0.27, 0.35}) {
    const double f = critical_friction(r, 0.02);
    for (const double beyond : {1e-7, 1e-6, 1e-4}) {
      responses.solve(single_mass_values(r, 0.02, f * (1.0 - beyond)));
      CHECK(responses["friction_stops"] == 0.0);
      CHECK(responses["friction_reversals"] == 2.0);
      responses.solve(single_mass_values(r, 0.02, f * (1.0 + beyond)));
      INFO("r " << r << " beyond " << beyond);
      CHECK(is_solved(responses));
      CHECK((responses["friction_stops"] >= 2.0 || responses["friction_reversals"] > 2.0));
    }
  }
}

TEST_CASE("3. Stops and slips of any length exist near the regime borders") {
  Responses responses(single_mass());
  // Stops: at f_crit the stop begins with zero length.
  for (const double r : {0.6, 1.0, 1.7}) {
    const double f = critical_friction(r, 0.1);
    for (const double beyond : {1e-6, 1e-4, 1e-2}) {
      responses.solve(single_mass_values(r, 0.1, f * (1.0 + beyond)));
      INFO("r " << r << " beyond " << beyond << " stuck " << responses["friction_stuck_fraction"]);
      CHECK(responses["friction_stops"] == 2.0);
      CHECK_THAT(responses["x_amplitude"],
                 WithinAbs(one_stop_response(r, 0.1, f * (1.0 + beyond)).amplitude, kAgreement));
    }
  }
  // Slips: at f = 1 the slip ends with zero length.
  for (const double short_of : {1e-2, 1e-4, 1e-6}) {
    responses.solve(single_mass_values(0.9, 0.1, 1.0 - short_of));
    INFO("1 - f = " << short_of);
    CHECK(responses["friction_stops"] == 2.0);
    CHECK_THAT(responses["x_amplitude"],
               WithinAbs(one_stop_response(0.9, 0.1, 1.0 - short_of).amplitude, kAgreement));
  }
}

TEST_CASE("4. An event at the section, or exactly half a period later, counts once") {
  for (const double f : {0.3, 0.9}) {
    const double r = 0.9, zeta = 0.1;
    const bool stops = f > critical_friction(r, zeta);
    const double X = classical_amplitude(r, zeta, f);
    // omega t = 0 at the maximum, or at the release.
    const double lag = stops ? -std::acos(X - f) : non_stop_response(r, zeta, f).peak_lag;
    NetworkValues values = single_mass_values(r, zeta, f);
    for (const double shift : {0.0, 1e-15, -1e-15, 1e-11, std::numbers::pi}) {
      values.excitation[0].phase = lag + shift;
      Responses responses(single_mass());
      responses.solve(values);
      INFO("f " << f << " shift " << shift);
      CHECK(is_solved(responses));
      CHECK_THAT(responses["x_amplitude"], WithinAbs(X, kAgreement));
      CHECK(responses["friction_stops"] == (stops ? 2.0 : 0.0));
      CHECK(responses["friction_reversals"] == 2.0);
      CHECK(responses["events"] == (stops ? 4.0 : 2.0));
      // The derivative of the map must not lose the event at its ends.
      const auto multipliers = stops ? one_stop_multipliers(r, zeta, f) : non_stop_multipliers(r, zeta, f);
      const double radius = std::max(std::abs(multipliers[0]), std::abs(multipliers[1]));
      CHECK_THAT(responses["floquet_radius"], WithinAbs(radius, kAgreement));
    }
  }
}

TEST_CASE("5. A stop leaves a multiplier of exactly zero, a reversal none") {
  for (const double f : {0.3, 0.9}) {
    const LinearSystem system = system_of(single_mass(), single_mass_values(0.9, 0.1, f));
    Flow<1, 1> flow;
    flow.set_system(system);
    flow.set_forcing(system);
    Passage<1, 1> passage;
    Walk(flow).pass(Eigen::Vector2d(0.3, 0.2), 0.0, 3.0 * flow.equations().period, passage);
    bool stuck = false;
    for (const auto& segment : passage.segments) stuck |= flow.mode(segment.mode).stuck != 0;
    const double determinant = passage.tangent.determinant() / passage.tangent.squaredNorm();
    INFO("f " << f);
    if (stuck)
      CHECK_THAT(determinant, WithinAbs(0.0, 1e-14));
    else
      CHECK(std::abs(determinant) > 1e-6);
    CHECK(stuck == (f == 0.9));
  }
}

TEST_CASE("6. A point where the velocity only touches zero is flagged as grazing") {
  Responses responses(single_mass());
  for (const double r : {0.15, 0.22, 0.35}) {
    const double f = critical_friction(r, 0.05);
    constexpr double kJustBelow = 1.0 - 1e-11;
    responses.solve(single_mass_values(r, 0.05, kJustBelow * f));
    INFO("r " << r << " f_crit " << f);
    CHECK(responses["status"] == static_cast<double>(Status::grazing));
    for (const double aside : {0.99, 1.01}) {
      responses.solve(single_mass_values(r, 0.05, aside * f));
      CHECK(responses["status"] == static_cast<double>(Status::ok));
    }
  }
}

TEST_CASE("7. Where a quantity jumps, the limits on both sides count") {
  Responses responses(single_mass());
  const double r = 1.4, zeta = 0.05, f = 0.3;
  responses.solve(single_mass_values(r, zeta, f));
  const ClosedForm exact = non_stop_response(r, zeta, f);
  REQUIRE(exact.valid());
  // x'' = cos - x -+ f on the two sides of the maximum: the larger is X - cos(phase) + f.
  const double before_turning = exact.amplitude - std::cos(exact.peak_lag) + f;
  CHECK_THAT(responses["x_acceleration_peak"], WithinAbs(before_turning, kAgreement));
  // Ground carries x + 2 zeta x' + f: X + f just before the maximum, or more where the damper's share still
  // grows.
  CHECK(responses["transmitted_force"] >= exact.amplitude + f - kAgreement);
  const History history = responses.response().history(frahm::periodic::phases_of_a_period(20001));
  double sampled = 0.0;
  for (std::size_t i = 0; i < history.time.size(); ++i) {
    sampled =
        std::max(sampled, std::abs(history.columns[2][i] + history.columns[3][i] + history.columns[4][i]));
  }
  CHECK(sampled <= responses["transmitted_force"] + kAgreement);
  CHECK_THAT(sampled, WithinAbs(responses["transmitted_force"], 1e-3));
}

TEST_CASE("Elements between the same two nodes share their contact's force in proportion to their own") {
  Network network = single_mass();
  network.elements.push_back({"second", ElementType::coulomb, kFirst, kGround});
  Responses responses(network), one(single_mass());
  for (const double f : {0.3, 0.9, 1.5}) {
    NetworkValues values = single_mass_values(0.9, 0.1, 0.75 * f);
    values.element.push_back(0.25 * f);
    responses.solve(values);
    one.solve(single_mass_values(0.9, 0.1, f));
    INFO("f " << f);
    CHECK_THAT(responses["x_amplitude"], WithinAbs(one["x_amplitude"], kAgreement));
    CHECK_THAT(responses["friction_force_peak"], WithinAbs(0.75 * one["friction_force_peak"], kAgreement));
    CHECK_THAT(responses["second_force_peak"], WithinAbs(0.25 * one["friction_force_peak"], kAgreement));
    CHECK_THAT(responses["second_energy"], WithinAbs(0.25 * one["friction_energy"], kAgreement));
  }
}

}  // namespace
}  // namespace frahm::periodic::switching_test
