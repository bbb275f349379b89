#include "solvers/tuning/stages/design_map.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "solvers/algebra/no_value.hpp"

namespace frahm::tuning::design_map_test {
namespace {

const std::function<bool()> never_stop = [] { return false; };

DesignMap map_of(const std::vector<DesignParameter>& parameters, const MeritAt& merit_at) {
  return map_designs(DesignSpace(parameters), merit_at, never_stop);
}

TEST_CASE("a map has a low place in each valley, the deepest first") {
  // (x^2 - 1)^2 + x/4 + y^2: valleys at x near -1 and, higher, near 1.
  const DesignMap map = map_of({{"x", -2.0, 2.0, 0.0, {}}, {"y", -1.0, 1.0, 0.0, {}}}, [](auto at) {
    return DesignMerit{std::pow(at[0] * at[0] - 1.0, 2) + 0.25 * at[0] + at[1] * at[1], -kInfinity};
  });
  CHECK(map.merit.size() == 121);
  const double cell = 4.0 / 11;
  const auto places = lowest_places(map, 4);
  REQUIRE(places.size() == 2);
  CHECK(std::abs(places[0][0] + 1.0) < cell);
  CHECK(std::abs(places[1][0] - 1.0) < cell);
  CHECK(places[0][1] == Approx(0.0).margin(1e-12));
  CHECK(lowest_places(map, 1).size() == 1);
}

TEST_CASE("low places elsewhere lie two cells or more from the lowest and from one another") {
  const DesignMap map = map_of({{"x", 0.0, 33.0, 0.0, {}}}, [](auto at) {
    return DesignMerit{1.0 + std::abs(at[0] - 10.5), -kInfinity};  // one valley, at the eleventh cell
  });
  const auto lowest = lowest_places(map, 4);
  REQUIRE(lowest.size() == 1);
  CHECK(lowest[0][0] == Approx(10.5));
  const auto elsewhere = low_places_elsewhere(map, 3);
  REQUIRE(elsewhere.size() == 3);
  CHECK(elsewhere[0][0] == Approx(8.5));
  CHECK(elsewhere[1][0] == Approx(12.5));
  CHECK(elsewhere[2][0] == Approx(6.5));
}

TEST_CASE("a map tells which share of the box has a response, and none of its places lies elsewhere") {
  const DesignMap map = map_of({{"x", 0.0, 1.0, 0.0, {}}, {"fixed", 7.0, 7.0, 7.0, {}}}, [](auto at) {
    CHECK(at[1] == 7.0);
    return DesignMerit{at[0] < 0.5 ? kNone : 1.0 + at[0], 0.0};
  });
  CHECK(map.merit.size() == 33);
  CHECK(map.seen() == 17);
  REQUIRE(lowest_places(map, 4).size() == 1);
  CHECK(lowest_places(map, 4)[0][0] == Approx(0.5));
}

TEST_CASE("a map that was stopped has places among its first cells, as if there were no others") {
  // A plane that falls along both: of a part the lowest are the last cells that it has.
  const MeritAt plane = [](auto at) { return DesignMerit{10.0 - at[0] - 2.0 * at[1], -kInfinity}; };
  const DesignSpace box({{"x", 0.0, 1.1, 0.0, {}}, {"y", 0.0, 1.1, 0.0, {}}});
  for (std::size_t cells = 1; cells <= 121; ++cells) {
    const DesignMap map = map_designs(box, plane, [left = cells]() mutable { return left-- == 0; });
    REQUIRE(map.merit.size() == cells);
    const auto lowest = lowest_places(map, 4);
    REQUIRE_FALSE(lowest.empty());
    for (const auto& place : lowest) CHECK(std::ranges::find(map.design, place) != map.design.end());
    CHECK(lowest[0] ==
          *std::ranges::min_element(map.design, {}, [&](const auto& at) { return plane(at).objective; }));
    CHECK(low_places_elsewhere(map, 3).size() <= 3);
  }
}

TEST_CASE("a range over more than a decade has cells of equal ratios") {
  const DesignMap map = map_of({{"x", 1e-3, 1.0, 0.0, {}}}, [](auto) { return DesignMerit{}; });
  CHECK(map.design[1][0] / map.design[0][0] == Approx(map.design[32][0] / map.design[31][0]));
}

TEST_CASE("where no design of a map meets the limits its low places are those that break them least") {
  const DesignMap map = map_of({{"x", 0.0, 1.0, 0.0, {}}}, [](auto at) {
    return DesignMerit{10.0 * at[0], 1.0 + std::pow(at[0] - 0.75, 2)};
  });
  const auto places = lowest_places(map, 4);
  REQUIRE(places.size() == 1);
  CHECK(std::abs(places[0][0] - 0.75) < 1.0 / 33);
}

}  // namespace
}  // namespace frahm::tuning::design_map_test
