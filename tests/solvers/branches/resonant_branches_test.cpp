#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "linear_values.hpp"
#include "one_mass.hpp"
#include "solvers/response/periodic_response.hpp"

// Branches that come to a resonance without damping.
namespace frahm::periodic::resonant_branches_test {
namespace {

using namespace mechanics;
using namespace one_mass;

constexpr double kPrinted = 1e-7;  // of orbits found in two ways
constexpr double kExact = 1e-9;    // of closed forms
const Node ground{}, mass{NodeKind::mass, 0};
const std::vector<Quantity> asked{{Measure::peak, 0}, {Measure::energy_balance, 0}};

// A mass on a spring and two sliders with springs, driven towards the resonance of the spring alone. Both
// sliders turn at one instant, where the velocity is rounding of a size that grows with the response: neither
// may let go at once, or one of them slides on against its velocity.
//   peak -> sqrt(P^2 - (4 F/pi)^2) / abs(k - r^2), F of both, as the peak grows (Den Hartog 1931)
TEST_CASE("A branch towards an undamped resonance stays right until its response is unbounded") {
  constexpr double kStiffness = 5.0, kForce = 2.0, kFriction = 0.1 + 0.4;
  Network network{.masses = {"x"},
                  .elements = {{"spring", ElementType::spring, ground, mass},
                               {"first", ElementType::jenkins, ground, mass},
                               {"second", ElementType::jenkins, ground, mass}},
                  .excitations = {{ExcitationKind::force, 0, 1}}};
  const auto values = [](double r) {
    return NetworkValues{.omega = r,
                         .mass = {1.0},
                         .element = {kStiffness, 1.0, 2.0},
                         .excitation = {{kForce, 0.0}},
                         .second = {0.0, 0.1, 0.4}};
  };
  const Branch branch =
      follow_branch(network, asked, linear(values), {.low = 2.0, .high = 3.0, .start = 2.0});
  REQUIRE(branch.reason.empty());
  CHECK(branch.last_end == BranchEnd::unbounded);
  CHECK(branch.special.empty());
  PeriodicResponse response(network, asked);
  std::vector<double> quantities(asked.size());
  constexpr double kTurn = 0.3;  // times peak^-1/2: the angle in which the sliders' springs turn their force
  int compared = 0, large = 0;
  for (const BranchPoint& point : branch.points) {
    const double r = point.parameter, peak = point.quantities[0];
    INFO("r = " << r);
    CHECK(point.stable);
    if (peak < 1e4) {
      response.set_values(values(r));
      REQUIRE(response.solve().status == Status::ok);
      response.quantities(quantities);
      CHECK(peak == Approx(quantities[0]).epsilon(kPrinted));
      ++compared;
    } else if (peak > 1e5 && peak < 1e8) {  // beyond, k - r^2 is rounding
      const double free = std::sqrt(kForce * kForce - std::pow(4.0 * kFriction / std::numbers::pi, 2));
      CHECK(peak == Approx(free / std::abs(kStiffness - r * r)).epsilon(kTurn / std::sqrt(peak)));
      ++large;
    }
  }
  CHECK(compared > 300);
  CHECK(large > 100);
}

// Two masses that a spring with a slider joins, without damping. It begins to slip next to where seven times
// the frequency is a natural frequency of the stuck system: the branch turns there by nearly a right angle.
TEST_CASE("A branch goes on where a slider begins to slip next to a resonance of a higher harmonic") {
  const mechanics::Node other{mechanics::NodeKind::mass, 1};
  Network network{.masses = {"x", "y"},
                  .elements = {{"first", ElementType::spring, ground, mass},
                               {"second", ElementType::spring, mass, other},
                               {"slider", ElementType::jenkins, mass, other}},
                  .excitations = {{ExcitationKind::force, 0, 1}}};
  constexpr double kJoint = 2.716, kLimit = 0.1864, kFrom = 0.4;
  const auto values = [](double r) {
    return NetworkValues{.omega = r,
                         .mass = {1.0, 1.0},
                         .element = {1.0, 1.0, kJoint},
                         .excitation = {{1.0, 0.0}},
                         .second = {0.0, 0.0, kLimit}};
  };
  const Branch branch =
      follow_branch(network, asked, linear(values), {.low = kFrom, .high = 1.2, .start = kFrom});
  REQUIRE(branch.reason.empty());
  CHECK(branch.last_end == BranchEnd::unbounded);
  CHECK(of_kind(branch, SpecialKind::jump).empty());
  // Stuck, the forced motion of two masses is
  //   x = (K - r^2) / D,  y = K / D,  D = r^4 - (1 + 2 K) r^2 + K,  K = 1 + k_j
  // and it slips from where k_j (y - x) is the limit: D = k_j r^2 / limit.
  const double K = 1.0 + kJoint, sum = 1.0 + 2.0 * K + kJoint / kLimit;
  const double slips_from = std::sqrt(0.5 * (sum - std::sqrt(sum * sum - 4.0 * K)));
  const std::vector<SpecialPoint> grazings = of_kind(branch, SpecialKind::grazing);
  REQUIRE_FALSE(grazings.empty());
  CHECK(grazings.front().at.parameter == Approx(slips_from).epsilon(kExact));
  PeriodicResponse response(network, asked);
  std::vector<double> quantities(asked.size());
  int slipping = 0;
  for (const BranchPoint& point : branch.points) {
    if (point.parameter <= slips_from || point.parameter > 0.5) continue;
    INFO("r = " << point.parameter);
    response.set_values(values(point.parameter));
    REQUIRE(response.solve().status == Status::ok);
    response.quantities(quantities);
    CHECK(point.quantities[0] == Approx(quantities[0]).epsilon(kPrinted));
    ++slipping;
  }
  CHECK(slipping > 50);
}

// A mass on a spring and a slider with a spring, without damping: stuck, any motion at the natural frequency
// may be added where that is three times the excitation's.
TEST_CASE("A branch ends where a family of orbits has one value of the parameter, and says so") {
  Network network{.masses = {"x"},
                  .elements = {{"spring", ElementType::spring, ground, mass},
                               {"slider", ElementType::jenkins, ground, mass}},
                  .excitations = {{ExcitationKind::force, 0, 1}}};
  constexpr double kJoint = 2.716;
  const auto values = [](double r) {
    return NetworkValues{.omega = r,
                         .mass = {1.0},
                         .element = {1.0, kJoint},
                         .excitation = {{1.0, 0.0}},
                         .second = {0.0, 0.8}};
  };
  const Branch branch =
      follow_branch(network, asked, linear(values), {.low = 0.4, .high = 3.0, .start = 0.4});
  REQUIRE(branch.reason.empty());
  CHECK(branch.last_end == BranchEnd::family);
  CHECK(branch.points.back().parameter == Approx(std::sqrt(1.0 + kJoint) / 3.0).epsilon(kExact));
  CHECK(of_kind(branch, SpecialKind::fold).empty());  // all laws are monotone: nothing turns back
}

}  // namespace
}  // namespace frahm::periodic::resonant_branches_test
