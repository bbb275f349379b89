#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "solvers/laws/damper_bend.hpp"
#include "solvers/laws/elastic_stop.hpp"
#include "solvers/laws/spring_bend.hpp"
#include "tests/known_answers/event_integrator.hpp"
#include "tests/known_answers/random_network.hpp"
#include "tests/known_answers/responses.hpp"
#include "tests/known_answers/single_mass.hpp"

// Stops, tables and static friction: laws that are linear piece by piece. One mass of x'' + 2 zeta x' + x
// plus such an element under cos(r tau), by figures of two independent methods (project's contract, section
// 13); random networks against an independent event-driven integration.
namespace frahm::periodic::piecewise_linear_test {
namespace {

using Catch::Matchers::WithinAbs, Catch::Matchers::WithinRel;
using namespace mechanics;
constexpr double kPrinted = 1e-8;   // the reference figures have that many digits
constexpr double kExact = 1e-10;    // of closed forms
constexpr double kClosure = 1e-8;   // of a motion after its period, relative
constexpr double kBalance = 1e-10;  // of the energy

const Node ground{}, mass{NodeKind::mass, 0};

// zeta = 0.05, stops of stiffness 4 at a clearance of 1.
NetworkValues between_stops(double r, double c = 0.0, double clearance = 1.0, double k = 4.0) {
  return {.omega = r,
          .mass = {1.0},
          .element = {1.0, 0.1, k},
          .excitation = {{1.0, 0.0}},
          .second = {0.0, 0.0, c},
          .bends = {{}, {}, {{clearance, k, c}, {clearance, k, c}}}};
}

Network mass_with_static_friction() {
  return driven_mass({static_friction("guide")});
}

NetworkValues with_static_friction(double r, double zeta, double F, double F_s) {
  return {.omega = r,
          .mass = {1.0},
          .element = {1.0, 2.0 * zeta, F},
          .excitation = {{1.0, 0.0}},
          .second = {0.0, 0.0, F_s}};
}

TEST_CASE("A mass between elastic stops has the peaks of two independent methods") {
  Responses responses(mass_between_stops());
  responses.solve(between_stops(1.4));
  CHECK(responses["status"] == static_cast<double>(Status::ok));
  CHECK_THAT(responses["x_peak"], WithinAbs(1.9642744, 1e-7));  // printed so
  CHECK(responses["stops_energy"] == 0.0);                      // they do not damp
  for (const auto& [r, small, large] : {std::tuple{1.5, 0.7943015, 2.1765907}, {1.6, 0.6376804, 2.4531427}}) {
    INFO("r " << r);
    responses.solve(between_stops(r));
    CHECK(responses["status"] == static_cast<double>(Status::several));
    CHECK(responses["coexisting"] == 2.0);
    CHECK_THAT(responses["x_peak"], WithinAbs(large, 1e-7));
    CHECK(responses["energy_balance"] < kBalance);
    CHECK(responses["floquet_radius"] < 1.0);
    // The small one does not touch: it is the linear response.
    CHECK_THAT(1.0 / std::hypot(1.0 - r * r, 0.1 * r), WithinAbs(small, 1e-7));
  }
}

TEST_CASE(
    "Just above the lower fold the small orbit between the stops is found, though few starts lead to it") {
  Responses responses(mass_between_stops());
  for (const double r : {1.4142, 1.43, 1.45}) {
    INFO("r " << r);
    responses.solve(between_stops(r));
    CHECK(responses["coexisting"] == 2.0);
  }
}

TEST_CASE("Stops far away leave the linear response, stops without clearance stiffen the spring") {
  Responses responses(mass_between_stops());
  for (const double r : {0.7, 1.3, 2.6}) {
    INFO("r " << r);
    responses.solve(between_stops(r, 0.1, 1e3));
    CHECK(responses["status"] == static_cast<double>(Status::ok));
    CHECK_THAT(responses["x_peak"], WithinRel(1.0 / std::hypot(1.0 - r * r, 0.1 * r), kExact));
    responses.solve(between_stops(r, 0.0, 0.0));
    CHECK(responses["status"] == static_cast<double>(Status::ok));
    CHECK_THAT(responses["x_peak"], WithinRel(1.0 / std::hypot(5.0 - r * r, 0.1 * r), kExact));
  }
}

TEST_CASE("A clearance of 1e-10 is none to 1e-9, and a stop just out of reach is not there") {
  constexpr double kLimit = 1e-9;
  Responses responses(mass_between_stops());
  for (const double r : {0.7, 1.3, 2.6}) {
    INFO("r " << r);
    const double stiff = 1.0 / std::hypot(5.0 - r * r, 0.1 * r),
                 soft = 1.0 / std::hypot(1.0 - r * r, 0.1 * r);
    for (const double clearance : {1e-6, 1e-8, 1e-10}) {  // the distance falls in proportion
      responses.solve(between_stops(r, 0.0, clearance));
      CHECK(std::abs(responses["x_peak"] / stiff - 1.0) < 10.0 * clearance);
    }
    CHECK_THAT(responses["x_peak"], WithinRel(stiff, kLimit));
    NetworkValues values = between_stops(r, 0.0, soft * (1.0 + 1e-6));
    responses.solve(values);
    CHECK(responses["x_peak"] >= soft * (1.0 - kLimit));  // a larger one may coexist
    if (responses["coexisting"] == 1.0) CHECK_THAT(responses["x_peak"], WithinRel(soft, kLimit));
  }
}

TEST_CASE("Static over kinetic friction has the peaks of two independent methods, two stops a period") {
  struct Figure {
    double zeta, F, F_s, r, peak;
  };
  Responses responses(mass_with_static_friction());
  for (const auto& [zeta, F, F_s, r, peak] :
       {Figure{0.05, 0.3, 0.6, 0.5, 1.34683173}, Figure{0.05, 0.3, 0.5, 0.5, 1.31220886},
        Figure{0.1, 0.4, 0.6, 0.4, 1.02126874}}) {
    INFO("zeta " << zeta << " F " << F << " F_s " << F_s << " r " << r);
    responses.solve(with_static_friction(r, zeta, F, F_s));
    CHECK(responses["status"] == static_cast<double>(Status::ok));
    CHECK_THAT(responses["x_peak"], WithinAbs(peak, kPrinted));
    CHECK(responses["guide_stops"] == 2.0);
    CHECK(responses["energy_balance"] < kBalance);
  }
}

TEST_CASE("Sliding without a stop coexists with rest up to the border of the static force") {
  Responses responses(mass_with_static_friction());
  constexpr double kBorder = 1.5914263943;  // X - cos(lag of the peak)
  for (const double F_s : {1.05, 1.3, kBorder - 1e-9}) {
    INFO("F_s " << F_s);
    responses.solve(with_static_friction(0.8, 0.05, 0.2, F_s));
    CHECK(responses["coexisting"] == 2.0);
    CHECK(responses["guide_stops"] == 0.0);
    CHECK_THAT(responses["x_peak"], WithinRel(2.5001367841, kExact));
  }
  responses.solve(with_static_friction(0.8, 0.05, 0.2, kBorder + 1e-4));
  CHECK(responses["coexisting"] == 1.0);
  CHECK_THAT(responses["x_peak"], WithinAbs(0.0, kExact));
  responses.solve(with_static_friction(0.8, 0.05, 0.2, 0.95));  // the force breaks it loose
  CHECK(responses["coexisting"] == 1.0);
}

TEST_CASE("A static force equal to the sliding force is Coulomb's law") {
  Network plain = mass_with_static_friction();
  plain.elements[2].has_static_force = false;
  Responses coulomb(plain), both(mass_with_static_friction());
  for (const double r : {0.4, 0.8, 1.3}) {
    coulomb.solve(with_static_friction(r, 0.05, 0.4, 0.0));
    both.solve(with_static_friction(r, 0.05, 0.4, 0.4));
    INFO("r " << r);
    CHECK_THAT(both["x_peak"], WithinRel(coulomb["x_peak"], kExact));
    CHECK(both["error_bound"] < 1e-9);  // monotone: the bound holds
  }
}

// Contacts of one direction are one: it breaks loose where both are at their own limits.
TEST_CASE("Of two guides side by side each carries no more than its own law allows") {
  Network network = mass_with_static_friction();
  network.elements.push_back({"plain", ElementType::coulomb, ground, mass});
  NetworkValues values = with_static_friction(0.3, 0.05, 0.3, 0.6);
  values.element.push_back(0.25);
  values.second.push_back(0.0);
  Responses both(network), one(mass_with_static_friction());
  both.solve(values);
  one.solve(with_static_friction(0.3, 0.05, 0.55, 0.85));
  CHECK(both["guide_stops"] == 2.0);
  CHECK_THAT(both["guide_force_peak"], WithinRel(0.6, kExact));
  CHECK_THAT(both["plain_force_peak"], WithinRel(0.25, kExact));
  CHECK_THAT(both["x_peak"], WithinRel(one["x_peak"], kExact));
  CHECK_THAT(both["guide_energy"] + both["plain_energy"], WithinRel(one["guide_energy"], kExact));
  CHECK_THAT(both["guide_energy"] / both["plain_energy"], WithinRel(0.3 / 0.25, kExact));
  const History history = both.response().history(phases_of_a_period(1001));
  const auto column = [&](const char* name) {
    const auto found = std::ranges::find(history.names, name);
    REQUIRE(found != history.names.end());
    return history.columns[static_cast<std::size_t>(found - history.names.begin())];
  };
  for (const double force : column("plain_force")) CHECK(std::abs(force) <= 0.25 * (1.0 + kExact));
}

// A shock absorber that damps more in bump than in rebound, beyond the velocity v in either direction.
TEST_CASE("A damper's table of one slope is a damper, and a rising one keeps the error bound") {
  Element absorber{"absorber", ElementType::damper, ground, mass};
  absorber.bends = {{1.0, &laws::damper_bend}, {-1.0, &laws::damper_bend}};
  Responses responses(driven_mass({absorber}));
  const auto values = [](double r, double bump, double rebound) {
    return NetworkValues{.omega = r,
                         .mass = {1.0},
                         .element = {1.0, 0.05, 0.2},
                         .excitation = {{1.0, 0.0}},
                         .bends = {{}, {}, {{0.1, 0.0, bump}, {0.05, 0.0, rebound}}}};
  };
  for (const double r : {0.5, 1.0, 1.7}) {
    INFO("r " << r);
    responses.solve(values(r, 0.0, 0.0));
    CHECK_THAT(responses["x_peak"], WithinRel(1.0 / std::hypot(1.0 - r * r, 0.25 * r), kExact));
    responses.solve(values(r, 0.5, -0.15));
    CHECK(responses["status"] == static_cast<double>(Status::ok));
    CHECK(responses["energy_balance"] < kBalance);
    CHECK(responses["error_bound"] < 1e-10);
    CHECK(responses["x_mean"] != 0.0);  // bump and rebound differ
  }
}

// Whether the response found returns to its start after its periods, as the independent integration says.
void check_random(const RandomNetwork& drawn, int& checked) {
  Responses responses(drawn.network);
  const ResponseSummary summary = responses.solve(drawn.values);
  const double status = responses["status"];
  if (status == static_cast<double>(Status::not_periodic)) return;
  REQUIRE((status == static_cast<double>(Status::ok) || status == static_cast<double>(Status::several) ||
           status == static_cast<double>(Status::grazing)));
  const Assembly assembly(drawn.network);
  LinearSystem system;
  assembly.set_values(drawn.values, system);
  assembly.set_forcing(drawn.values, system);
  const History history = responses.response().history(phases_of_a_period(2));
  const Eigen::Index n = system.masses();
  Eigen::VectorXd q(n), v(n), s(system.internal_forces());
  double largest = 0.0, fastest = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto column = static_cast<std::size_t>(2 * i);
    q[i] = history.columns[column][0];
    v[i] = history.columns[column + 1][0];
    const std::string& name = drawn.network.masses[static_cast<std::size_t>(i)];
    largest = std::max(largest, responses[name + "_amplitude"]);
    fastest = std::max(fastest, responses[name + "_velocity_peak"]);
  }
  for (std::size_t e = 0; e < drawn.network.elements.size(); ++e) {
    const Eigen::Index internal = system.coefficients[e].internal;
    if (internal >= 0) s[internal] = history.columns[2 * static_cast<std::size_t>(n) + e][0];
  }
  EventIntegrator reference(system);
  reference.start(0.0, q, v, s);
  reference.advance_to(summary.multiple * 2.0 * M_PI / drawn.values.omega);
  CHECK((reference.displacements() - q).cwiseAbs().maxCoeff() < kClosure * largest);
  CHECK((reference.velocities() - v).cwiseAbs().maxCoeff() < kClosure * fastest);
  CHECK(responses["energy_balance"] < kBalance);
  ++checked;
}

TEST_CASE("Random networks of monotone laws move as the independent integration says") {
  int checked = 0;
  for (unsigned trial = 0; trial < 36; ++trial) {
    INFO("trial " << trial);
    std::mt19937 random(trial);
    check_random(random_network({.masses = 1 + static_cast<int>(trial % 3),
                                 .contacts = static_cast<int>(trial / 3 % 3),
                                 .jenkins_elements = static_cast<int>(trial / 9 % 2),
                                 .rising_dampers = 1,
                                 .orders = trial % 2 == 0 ? std::vector<int>{0, 1, 2} : std::vector<int>{1},
                                 .largest_friction = 0.6},
                                random),
                 checked);
  }
  CHECK(checked == 36);
}

TEST_CASE("Random networks with stops and static friction move as the independent integration says") {
  int checked = 0;
  for (unsigned trial = 0; trial < 36; ++trial) {
    INFO("trial " << trial);
    std::mt19937 random(1000 + trial);
    check_random(random_network({.masses = 1 + static_cast<int>(trial % 3),
                                 .contacts = static_cast<int>(trial / 3 % 2),
                                 .stops = 1 + static_cast<int>(trial / 6 % 2),
                                 .static_friction = trial / 12 % 2 == 1,
                                 .orders = {1},
                                 .largest_friction = 0.6},
                                random),
                 checked);
  }
  CHECK(checked >= 33);  // the others have no stable orbit of up to four periods
}

// The stop and the contact hold the same motion: a shift of the rest position alone would be no orbit.
TEST_CASE("A contact that sticks throughout beside a stop that is touched leaves an orbit that balances") {
  int checked = 0;
  std::mt19937 random(257);
  check_random(random_network({.masses = 3,
                               .contacts = 1,
                               .stops = 1,
                               .static_friction = true,
                               .orders = {1},
                               .shaken = false,
                               .largest_friction = 0.5},
                              random),
               checked);
  CHECK(checked == 1);
}

TEST_CASE("So does a chain of nine masses with damped stops, tables and static friction", "[slow]") {
  int checked = 0;
  for (unsigned trial = 0; trial < 6; ++trial) {
    INFO("trial " << trial);
    std::mt19937 random(2000 + trial);
    check_random(random_network({.masses = 9,
                                 .contacts = 2,
                                 .rising_dampers = 1,
                                 .stops = 2,
                                 .static_friction = trial % 2 == 1,
                                 .orders = {1},
                                 .largest_friction = 0.6},
                                random),
                 checked);
  }
  CHECK(checked >= 5);
}

}  // namespace
}  // namespace frahm::periodic::piecewise_linear_test
