#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "linear_values.hpp"
#include "one_mass.hpp"

// Branches through places where the period map has a kink.
namespace frahm::periodic::kinks_test {
namespace {

using namespace mechanics;
using namespace one_mass;

constexpr double kExact = 1e-9;  // of special points found in two ways
const std::vector<Quantity> asked{{Measure::peak, 0}};

// An orbit and its mirror image: the branch leads from the one to the other where it crosses the symmetric
// one.
TEST_CASE("Both halves of a branch of asymmetric orbits have the same special points") {
  const auto values = [](double clearance) {
    const BendValue stop{clearance, 5.728, 0.078};
    return NetworkValues{.omega = 0.579,
                         .mass = {1.0},
                         .element = {0.267, 0.106, stop.stiffness},
                         .excitation = {{1.0, 0.0}},
                         .second = {0.0, 0.0, stop.damping},
                         .bends = {{}, {}, {stop, stop}}};
  };
  for (const double start : {1.8, 1.803, 1.828, 1.83}) {  // each with other steps
    INFO("start " << start);
    const Branch branch = follow_branch(mass_between_stops(), asked, linear(values),
                                        {.low = 0.1, .high = 2.0, .start = start, .multiple = 1});
    REQUIRE(branch.first_end == BranchEnd::closed);
    std::vector<SpecialPoint> alone;
    for (const SpecialPoint& each : branch.special) {
      const auto is_alike = [&](const SpecialPoint& other) {
        return other.kind == each.kind && std::abs(other.at.parameter - each.at.parameter) < kExact;
      };
      const auto alike = std::ranges::count_if(branch.special, is_alike);
      CHECK(alike <= 2);
      if (alike == 1) alone.push_back(each);
    }
    CHECK(branch.special.size() == 18);
    REQUIRE(alone.size() == 2);  // at both crossings
    for (const SpecialPoint& each : alone) CHECK(each.kind == SpecialKind::fold);
  }
}

// There the multipliers do not exist.
TEST_CASE("A place where an event only just happens is one row, stable where the orbits next to it are") {
  const auto values = [](double r) {
    return NetworkValues{.omega = r,
                         .mass = {1.0},
                         .element = {1.0, 0.1, 0.2},
                         .excitation = {{1.0, 0.0}},
                         .second = {0.0, 0.0, 0.6}};
  };
  const Branch branch = follow_branch(driven_mass({static_friction()}), asked, linear(values),
                                      {.low = 0.5, .high = 1.6, .start = 0.8});
  const auto grazing = of_kind(branch, SpecialKind::grazing);
  REQUIRE(grazing.size() == 1);
  CHECK(grazing.front().at.stable);
  CHECK(std::isnan(grazing.front().at.floquet_radius));
  for (const BranchPoint& each : branch.points) {
    CHECK(each.stable);
    CHECK(each.arclength != grazing.front().at.arclength);
  }
}

// Contact with the stop and the end of a stop of the friction come to one instant and change places: the map
// has a kink where the number of events stays.
TEST_CASE("A branch goes on where two events change their order") {
  const auto values = [](double r) {
    const BendValue stop{0.307, 6.65, 0.0};
    return NetworkValues{.omega = r,
                         .mass = {1.0},
                         .element = {1.035, 0.05, stop.stiffness, 0.247},
                         .excitation = {{1.0, 0.0}},
                         .second = {0.0, 0.0, 0.0, 1.7 * 0.247},
                         .bends = {{}, {}, {stop, stop}, {}}};
  };
  const Network network = driven_mass({elastic_stops({1.0, -1.0}), static_friction()});
  const Branch branch =
      follow_branch(network, asked, linear(values), {.low = 0.15, .high = 2.5, .start = 0.395});
  CHECK(branch.first_end == BranchEnd::closed);
  CHECK(branch.last_end == BranchEnd::closed);
  CHECK(std::ranges::all_of(branch.points, &BranchPoint::stable));
  const auto of_no_element = [](const SpecialPoint& each) {
    return each.kind == SpecialKind::grazing && !each.element;
  };
  const auto place = std::ranges::find_if(branch.special, of_no_element);
  REQUIRE(place != branch.special.end());
  const auto [before, after] = std::pair{branch.points[place->next - 1], branch.points[place->next]};
  CHECK(std::abs(after.floquet_radius - before.floquet_radius) > 0.1);
  CHECK(std::abs(after.quantities[0] - before.quantities[0]) < 1e-4);
}

}  // namespace
}  // namespace frahm::periodic::kinks_test
