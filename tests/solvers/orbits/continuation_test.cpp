#include "solvers/orbits/continuation.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "solvers/orbits/closed_forms.hpp"
#include "tests/known_answers/single_mass.hpp"

// Orbits one after the other along the frequency.
namespace frahm::periodic::continuation_test {
namespace {

constexpr double kSameOrbit = 1e-10;  // of the energy norm

// One mass with friction, followed from frequency to frequency.
class Row {
 public:
  Row(double zeta, double f) : zeta_(zeta), f_(f), assembly_(single_mass()), continuation_(flow_) {
    assembly_.set_values(single_mass_values(1.0, zeta_, f_), system_);
    assembly_.set_forcing(single_mass_values(1.0, zeta_, f_), system_);
    flow_.set_system(system_);
  }

  const Orbit<1, 1>& at(double r) {
    assembly_.set_forcing(single_mass_values(r, zeta_, f_), system_);
    flow_.set_forcing(system_);
    continuation_.find(system_, orbit_);
    return orbit_;
  }
  // Displacement and velocity [m/s] at omega t = 0.
  Eigen::Vector2d start() {
    Walk<1, 1> walk(flow_);
    Passage<1, 1> passage;
    const double turn = 2.0 * M_PI, rest = turn - orbit_.section;
    walk.pass(orbit_.z, orbit_.section, rest / flow_.fundamental_rate(), passage);
    return {passage.end[0], passage.end[1] / flow_.equations().step};
  }
  void forget() { continuation_.forget(); }
  void begin_row() { continuation_.begin_row(); }

 private:
  double zeta_, f_;
  mechanics::Assembly assembly_;
  mechanics::LinearSystem system_;
  Flow<1, 1> flow_;
  Continuation<1, 1> continuation_;
  Orbit<1, 1> orbit_;
};

TEST_CASE("Along a fine row an orbit takes fewer Newton steps than from nothing") {
  Row followed(0.05, 0.3), alone(0.05, 0.3);
  int with_neighbours = 0, without = 0;
  for (double r = 0.3; r < 1.6; r += 0.01) {
    const Orbit<1, 1>& next = followed.at(r);
    REQUIRE(next.is_found());
    with_neighbours += next.newton_iterations;
    alone.forget();
    const Orbit<1, 1>& fresh = alone.at(r);
    REQUIRE(fresh.is_found());
    without += fresh.newton_iterations;
  }
  INFO(with_neighbours << " against " << without);
  CHECK(2 * with_neighbours < without);
}

TEST_CASE("An orbit is the same whichever frequencies were visited before it") {
  Row wandering(0.02, 0.4), fresh(0.02, 0.4);
  for (const double r : {0.9, 0.91, 0.92, 0.9, 0.3, 2.0, 0.9000000001, 0.9, 0.35, 0.34, 0.33}) {
    wandering.at(r);
    const Eigen::Vector2d from_neighbours = wandering.start();
    fresh.forget();
    fresh.at(r);
    INFO("r " << r);
    CHECK((from_neighbours - fresh.start()).norm() < kSameOrbit * (1.0 + from_neighbours.norm()));
  }
}

TEST_CASE("The section keeps away from events") {
  Row row(0.05, 0.5);
  for (double r = 0.4; r < 1.5; r += 0.013) {
    const Orbit<1, 1>& orbit = row.at(r);
    REQUIRE(orbit.is_found());
    if (orbit.passage.segments.size() < 2) continue;
    double length = 0.0;
    for (const auto& segment : orbit.passage.segments) length += segment.length;
    INFO("r " << r << " of " << orbit.passage.segments.size() << " segments");
    CHECK(orbit.passage.segments.front().length > 0.005 * length);
    CHECK(orbit.passage.segments.back().length > 0.005 * length);
    CHECK_FALSE(orbit.passage.starts_at_event);
  }
}

TEST_CASE("A new row starts from the start of the one before it") {
  Row row(0.05, 0.3);
  row.at(0.5);
  for (double r = 0.51; r < 1.0; r += 0.01) row.at(r);
  row.begin_row();
  CHECK(row.at(0.5).newton_iterations <= 1);
}

}  // namespace
}  // namespace frahm::periodic::continuation_test
