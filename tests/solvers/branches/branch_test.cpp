#include "solvers/branches/branch.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "linear_values.hpp"
#include "one_mass.hpp"
#include "solvers/orbits/closed_forms.hpp"
#include "solvers/orbits/orbit.hpp"
#include "solvers/response/periodic_response.hpp"

namespace frahm::periodic::branch_test {
namespace {

using Catch::Matchers::WithinAbs;
using namespace mechanics;
using namespace one_mass;

constexpr double kPrinted = 1e-7;   // of the reference figures, by two independent methods
constexpr double kExact = 1e-9;     // of closed forms, and of the equations of special points
constexpr double kBalance = 1e-10;  // of the energy
constexpr double kOrbit = 1e-11;    // residual of the periodic condition
const std::vector<Quantity> asked{{Measure::peak, 0}, {Measure::energy_balance, 0}};

// x'' + 2 zeta x' + x + stops of stiffness k and damping c beyond |x| = 1 = cos(r tau).
NetworkValues stop_values(double r, double zeta, double k, double c) {
  return {.omega = r,
          .mass = {1.0},
          .element = {1.0, 2.0 * zeta, k},
          .excitation = {{1.0, 0.0}},
          .second = {0.0, 0.0, c},
          .bends = {{}, {}, {{1.0, k, c}, {1.0, k, c}}}};
}

// Along the frequency.
Branch stop_branch(double zeta, double k, double c, const BranchWanted& wanted) {
  return follow_branch(mass_between_stops(), asked,
                       linear([=](double r) { return stop_values(r, zeta, k, c); }), wanted);
}

void check_points(const Branch& branch) {
  REQUIRE(branch.reason.empty());
  double balance = 0.0, residual = 0.0;
  for (const BranchPoint& point : branch.points) {
    balance = std::max(balance, point.quantities[1]);
    residual = std::max(residual, point.residual);
  }
  CHECK(balance < kBalance);
  CHECK(residual < kOrbit);
}

TEST_CASE(
    "The branch of a mass between elastic stops has the known folds and its stops are touched where the "
    "linear response reaches them") {
  for (const double start : {1.2, 1.8}) {  // on either side of the folds
    INFO("start " << start);
    const Branch branch = stop_branch(0.05, 4.0, 0.0, {.low = 1.1, .high = 2.5, .start = start});
    check_points(branch);
    CHECK(branch.first_end == BranchEnd::range);
    CHECK(branch.last_end == BranchEnd::range);
    const auto folds = of_kind(branch, SpecialKind::fold);
    REQUIRE(branch.special.size() == 3);
    REQUIRE(folds.size() == 2);
    CHECK_THAT(folds[0].at.parameter, WithinAbs(2.0018066685, kPrinted));
    CHECK_THAT(folds[0].at.quantities[0], WithinAbs(4.9326330, kPrinted));
    CHECK_THAT(folds[1].at.parameter, WithinAbs(1.4086707284, kPrinted));
    CHECK_THAT(folds[1].at.quantities[0], WithinAbs(1.01774225, kPrinted));
    for (const SpecialPoint& fold : folds) {
      CHECK(fold.residual < kExact);
      CHECK_THAT(fold.at.floquet_radius, WithinAbs(1.0, kPrinted));
    }
    // (1 - r^2)^2 + (2 zeta r)^2 = 1
    const SpecialPoint& touch = branch.special.back();
    CHECK(touch.kind == SpecialKind::grazing);
    CHECK_THAT(touch.at.parameter, WithinAbs(std::sqrt(1.99), kExact));
    CHECK_THAT(touch.at.quantities[0], WithinAbs(1.0, kExact));
    CHECK(touch.residual < kExact);
    CHECK(touch.element == 2U);
  }
}

TEST_CASE("A branch is unstable between its folds and stable elsewhere") {
  const Branch branch = stop_branch(0.05, 4.0, 0.0, {.low = 1.1, .high = 2.5, .start = 1.2});
  const auto folds = of_kind(branch, SpecialKind::fold);
  REQUIRE(folds.size() == 2);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < branch.points.size(); ++i) {
    const bool between = i >= folds[0].next && i < folds[1].next;
    wrong += branch.points[i].stable == between ? 1 : 0;
  }
  CHECK(wrong == 0);
}

TEST_CASE("Branches pass fifty folds of twenty-five systems", "[slow]") {
  std::size_t passed = 0;
  for (const double zeta : {0.03, 0.04, 0.05, 0.06, 0.07}) {
    for (const double k : {2.0, 3.0, 4.0, 5.0, 6.0}) {
      INFO("zeta " << zeta << " k " << k);
      const Branch branch = stop_branch(zeta, k, 0.0, {.low = 1.1, .high = 4.0, .start = 1.15});
      check_points(branch);
      // On to the linear response above the jump.
      CHECK(branch.last_end == BranchEnd::range);
      CHECK_THAT(branch.points.back().quantities[0], WithinAbs(classical_amplitude(4.0, zeta, 0.0), kExact));
      for (const SpecialPoint& fold : of_kind(branch, SpecialKind::fold)) {
        CHECK(fold.residual < kExact);
        CHECK_THAT(fold.at.floquet_radius, WithinAbs(1.0, kPrinted));
        ++passed;
      }
    }
  }
  CHECK(passed == 50);
}

// Both folds end at zeta = 0.330665, where they meet (a cusp): there dp/ds touches zero, within one step.
TEST_CASE("Two folds next to the cusp at which they meet are both found") {
  std::size_t missed = 0;
  for (int i = 0; i < 24; ++i) {
    const double zeta = 0.33064 + 1e-6 * i;
    const Branch branch = stop_branch(zeta, 4.0, 0.0, {.low = 1.1, .high = 2.5, .start = 1.2});
    const auto folds = of_kind(branch, SpecialKind::fold);
    missed += folds.size() == 2 ? 0 : 1;
    for (const SpecialPoint& each : folds) CHECK(each.residual < kExact);
  }
  CHECK(missed == 0);
}

TEST_CASE("Where a damped stop gives the map a kink the branch turns at the touch") {
  for (const double c : {1.5, 6.0}) {
    INFO("damping " << c);
    const Branch branch = stop_branch(0.05, 4.0, c, {.low = 1.1, .high = 2.5, .start = 1.2});
    check_points(branch);
    CHECK(branch.last_end == BranchEnd::range);
    const auto corners = of_kind(branch, SpecialKind::corner);
    REQUIRE(corners.size() == 1);
    CHECK_THAT(corners[0].at.parameter, WithinAbs(std::sqrt(1.99), kExact));
    CHECK(corners[0].residual < kExact);
    CHECK(of_kind(branch, SpecialKind::fold).size() == 1);
  }
}

// Below its stop the response is linear, 1/hypot(1 - r^2, 0.02 r): it touches where that is the clearance.
TEST_CASE("A jump of the stability lies where the event that makes it begins") {
  const auto touch = [](double r) { return 1.0 / std::hypot(1.0 - r * r, 0.02 * r) - 0.3; };
  double low = 2.0, high = 2.2;
  for (int i = 0; i < 60; ++i) (touch(0.5 * (low + high)) > 0.0 ? low : high) = 0.5 * (low + high);
  const auto values = [](double r) {
    return NetworkValues{.omega = r,
                         .mass = {1.0},
                         .element = {1.0, 0.02, 20.0},
                         .excitation = {{1.0, 0.0}},
                         .second = {0.0, 0.0, 0.5},
                         .bends = {{}, {}, {{0.3, 20.0, 0.5}}}};
  };
  const Branch branch =
      follow_branch(mass_before_a_stop(), asked, linear(values), {.low = 1.9, .high = 2.4, .start = 2.3});
  const auto jumps = of_kind(branch, SpecialKind::stability_jump);
  REQUIRE_FALSE(jumps.empty());
  for (const SpecialPoint& jump : jumps) {
    CHECK(jump.residual < kExact);
    CHECK_THAT(jump.at.parameter, WithinAbs(low, kExact));
    CHECK_THAT(jump.at.quantities[0], WithinAbs(0.3, kExact));
  }
}

TEST_CASE("A branch along friction is Den Hartog's until stops begin, and ends at rest") {
  constexpr double r = 0.5, zeta = 0.05;
  const auto values = [&](double f) {
    return NetworkValues{
        .omega = r, .mass = {1.0}, .element = {1.0, 2.0 * zeta, f}, .excitation = {{1.0, 0.0}}};
  };
  const Branch branch =
      follow_branch(single_mass(), asked, linear(values), {.low = 0.0, .high = 1.2, .start = 0.5});
  check_points(branch);
  CHECK(branch.first_end == BranchEnd::range);
  CHECK(branch.last_end == BranchEnd::range);
  const auto grazings = of_kind(branch, SpecialKind::grazing);
  REQUIRE(branch.special.size() == 2);
  REQUIRE(grazings.size() == 2);
  CHECK_THAT(grazings[0].at.parameter, WithinAbs(critical_friction(r, zeta), kExact));
  CHECK_THAT(grazings[1].at.parameter, WithinAbs(1.0, kExact));
  CHECK_THAT(branch.points.back().quantities[0], WithinAbs(0.0, kExact));
}

TEST_CASE("A branch goes on where stops pass the phase at which it began") {
  const auto values = [](double r) {
    return NetworkValues{.omega = r, .mass = {1.0}, .element = {1.0, 0.1, 0.4}, .excitation = {{1.0, 0.0}}};
  };
  const Branch branch =
      follow_branch(single_mass(), asked, linear(values), {.low = 0.1, .high = 2.5, .start = 0.1});
  check_points(branch);
  CHECK(branch.last_end == BranchEnd::range);
  CHECK_THAT(branch.points.back().quantities[0], WithinAbs(classical_amplitude(2.5, 0.05, 0.4), kExact));
}

TEST_CASE("The border of sliding without stops under static friction is where it is known to be") {
  const auto values = [](double static_force) {
    return NetworkValues{.omega = 0.8,
                         .mass = {1.0},
                         .element = {1.0, 0.1, 0.2},
                         .excitation = {{1.0, 0.0}},
                         .second = {0.0, 0.0, static_force}};
  };
  const Branch branch =
      follow_branch(held_mass(), asked, linear(values), {.low = 0.2, .high = 2.0, .start = 0.5});
  check_points(branch);
  const auto grazings = of_kind(branch, SpecialKind::grazing);
  REQUIRE(grazings.size() == 1);
  CHECK_THAT(grazings[0].at.parameter, WithinAbs(1.5914263943, kExact));
  CHECK_THAT(grazings[0].at.quantities[0], WithinAbs(2.5001367841, kExact));
}

NetworkValues one_stop_values(double r) {
  return {.omega = r,
          .mass = {1.0},
          .element = {1.0, 0.05, 20.0},
          .excitation = {{1.0, 0.0}},
          .second = {0.0, 0.0, 0.0},
          .bends = {{}, {}, {{0.3, 20.0, 0.0}}}};
}

TEST_CASE("A branch of two periods ends where those of one double theirs, at both ends") {
  const auto followed = [](double start, int multiple) {
    return follow_branch(mass_before_a_stop(), asked, linear(one_stop_values),
                         {.low = 1.0, .high = 5.0, .start = start, .multiple = multiple});
  };
  const Branch one = followed(1.2, 1), two = followed(3.2, 2);
  check_points(two);
  CHECK(two.points.front().multiple == 2);
  CHECK(two.first_end == BranchEnd::origin);
  CHECK(two.last_end == BranchEnd::origin);
  const auto known = of_kind(one, SpecialKind::period_doubling);
  for (const SpecialPoint& end : {two.special.front(), two.special.back()}) {
    INFO("at " << end.at.parameter);
    CHECK(end.kind == SpecialKind::period_doubling);
    CHECK(end.residual < kExact);
    CHECK(std::ranges::any_of(known, [&](const SpecialPoint& each) {
      return std::abs(each.at.parameter - end.at.parameter) < kExact &&
             std::abs(each.at.quantities[0] - end.at.quantities[0]) < kExact;
    }));
  }
  const auto turns = [](const SpecialPoint& each) { return each.kind == SpecialKind::corner; };
  CHECK(std::ranges::none_of(two.special, turns));
}

TEST_CASE("The arclength of a branch grows from its first point, special ones between") {
  const Branch branch = stop_branch(0.05, 4.0, 0.0, {.low = 1.1, .high = 2.5, .start = 1.8});
  REQUIRE(branch.points.size() > 10);
  CHECK(branch.points.front().arclength == 0.0);
  for (std::size_t i = 1; i < branch.points.size(); ++i)
    CHECK(branch.points[i].arclength > branch.points[i - 1].arclength);
  for (const SpecialPoint& each : branch.special) {
    CHECK(each.at.arclength >= branch.points[each.next - 1].arclength);
    CHECK(each.at.arclength <= branch.points[each.next].arclength);
  }
}

// The forcing of a subharmonic is still that of one period.
TEST_CASE("A subharmonic repeats under the forcing of one period") {
  Network network = mass_before_a_stop();
  PeriodicResponse response(network, {{Measure::period_multiple, 0}, {Measure::peak, 0}});
  response.set_values(one_stop_values(3.2));
  response.solve();
  double found[2];
  response.quantities(found);
  REQUIRE(found[0] == 2.0);
  const Branch branch =
      follow_branch(network, asked, linear(one_stop_values),
                    {.low = 3.0, .high = 3.4, .start = 3.2, .most_points = 2, .multiple = 2});
  const auto start = std::ranges::find(branch.points, 3.2, &BranchPoint::parameter);
  REQUIRE(start != branch.points.end());
  CHECK_THAT(start->quantities[0], WithinAbs(found[1], kExact));
}

TEST_CASE("A branch without an orbit to start from says why") {
  const Branch branch = stop_branch(0.05, 4.0, 0.0, {.low = 1.1, .high = 2.5, .start = 1.2, .multiple = 3});
  CHECK(branch.points.empty());
  CHECK(branch.reason.find("3 periods") != std::string::npos);
}

TEST_CASE("A branch stops after as many points as are wanted") {
  const Branch branch =
      stop_branch(0.05, 4.0, 0.0, {.low = 1.1, .high = 2.5, .start = 1.2, .most_points = 20});
  CHECK(branch.last_end == BranchEnd::points);
  CHECK(branch.points.size() <= 39);
}

// The upper stop is only just touched at r = 1.25960079587108: where the largest displacement is the
// clearance, by halving over points.
TEST_CASE("A grazing that lies at the section of its orbits has its residual too") {
  Network network = driven_mass({elastic_stops({1.0, -1.0}), static_friction()});
  network.excitations.push_back({ExcitationKind::force, 0, 0});
  const auto values = [](double r) {
    return NetworkValues{.omega = r,
                         .mass = {1.25},
                         .element = {1.91, 0.153, 19.8, 0.198},
                         .excitation = {{1.0, 0.0}, {-0.4, 0.0}},
                         .second = {0.0, 0.0, 0.0, 0.542},
                         .bends = {{}, {}, {{1.08, 19.8, 0.0}, {1.08, 19.8, 0.0}}, {}}};
  };
  const Branch branch =
      follow_branch(network, asked, linear(values), {.low = 0.3, .high = 3.0, .start = 2.354});
  REQUIRE(branch.reason.empty());
  constexpr double kPlace = 1.25960079587108;
  int found = 0;
  for (const SpecialPoint& grazing : of_kind(branch, SpecialKind::grazing)) {
    CHECK(grazing.residual < kExact);
    if (std::abs(grazing.at.parameter - kPlace) < kExact) ++found;
  }
  CHECK(found == 1);
}

TEST_CASE("A branch over a wide range is not called closed where other parts of it come near") {
  const auto values = [](double r) {
    NetworkValues at = stop_values(r, 0.025, 2.0, 0.0);
    for (auto& bend : at.bends[2]) bend.place = 0.5;
    return at;
  };
  const Branch branch =
      follow_branch(mass_between_stops(), asked, linear(values), {.low = 0.05, .high = 20.0, .start = 0.05});
  CHECK(branch.first_end == BranchEnd::range);
  CHECK(branch.last_end != BranchEnd::closed);
  CHECK(branch.points.back().parameter > 1.0);
}

}  // namespace
}  // namespace frahm::periodic::branch_test
