// Which places of the band a round's problem is made of, on scans made up.
#include "solvers/tuning/exchange/active_points.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace frahm::tuning::active_points_test {
namespace {

constexpr std::size_t kGrid = 33;  // places of an even grid

// One parameter, constant or with knots at both ends and in the middle of the band from 1 to 3.
DesignSpace space_of(bool has_schedule) {
  DesignParameter parameter{.name = "k", .lower = 0.0, .upper = 1.0, .schedule = {}};
  if (has_schedule) parameter.schedule = Schedule{.knots = {1.0, 2.0, 3.0}};
  return DesignSpace({parameter});
}

std::vector<CurveKind> curves(std::initializer_list<CurveKind::Of> kinds) {
  std::vector<CurveKind> all;
  for (const CurveKind::Of of : kinds)
    all.push_back({.of = of, .quantity = {}, .band = {1.0, 3.0}, .constant = {}});
  return all;
}

Scan scan_with(std::vector<Scan::Maximum> maxima) {
  Scan scan;
  scan.maxima = std::move(maxima);
  return scan;
}

constexpr auto kObjective = CurveKind::Of::objective;
const Goal kWorst{Goal::Of::worst};

TEST_CASE("constants begin on an even grid, schedules on their knots and the middles between them") {
  const auto objective = curves({kObjective});
  CHECK(ActivePoints(space_of(false), objective, kWorst, {}).all().size() == kGrid);
  const ActivePoints scheduled(space_of(true), objective, kWorst, {});
  std::vector<double> places;
  for (const ActivePoint& point : scheduled.all()) places.push_back(point.at);
  CHECK(places == std::vector<double>{1.0, 1.5, 2.0, 2.5, 3.0});
}

TEST_CASE("an integral bounds its limits only, and a dominating schedule needs no grid for its objective") {
  const auto limited = curves({kObjective, CurveKind::Of::upper_limit});
  const Goal square{Goal::Of::mean_square};
  const ActivePoints of_square(space_of(false), limited, square, {});
  for (const ActivePoint& point : of_square.all()) CHECK(point.curve == 1);
  const auto both = curves({kObjective, CurveKind::Of::dominated});
  const ActivePoints dominating(space_of(true), both, kWorst, {});
  for (const ActivePoint& point : dominating.all()) CHECK(point.curve == 1);
}

TEST_CASE("maxima join, each followed half the way to the next, and take the place of those before") {
  const auto objective = curves({kObjective});
  const Scan first = scan_with({{0, 1.43, 5.0, 1}, {0, 2.03, 5.0, 1}});
  ActivePoints points(space_of(false), objective, kWorst, first);
  points.join(first, true);
  REQUIRE(points.all().size() == kGrid + 2);
  const ActivePoint& low = points.all()[kGrid];
  CHECK(low.followed);
  CHECK(low.from == 1.0);  // the end of the band
  CHECK(low.to == Approx(1.73));
  CHECK(points.all().back().from == Approx(1.73));
  points.join(scan_with({{0, 1.51, 4.0, 1}}), true);
  REQUIRE(points.all().size() == kGrid + 1);
  CHECK(points.all().back().at == 1.51);
}

TEST_CASE("a maximum that is not followed stays, once") {
  const auto objective = curves({kObjective});
  const Scan scan = scan_with({{0, 1.43, 5.0, 1}});
  ActivePoints points(space_of(false), objective, kWorst, scan);
  points.join(scan, false);
  points.join(scan_with({{0, 1.43 * (1.0 + 1e-9), 5.0, 1}}), false);
  CHECK(points.all().size() == kGrid + 1);
  CHECK_FALSE(points.all().back().followed);
}

TEST_CASE("a maximum on a knot or on an end of the band is not followed, one beside a knot not across it") {
  const auto objective = curves({kObjective});
  const Scan scan = scan_with({{0, 2.0, 5.0, 1}, {0, 2.4, 5.0, 1}, {0, 3.0, 5.0, 1}});
  ActivePoints points(space_of(true), objective, kWorst, scan);
  points.join(scan, true);
  std::size_t followed = 0;
  for (const ActivePoint& point : points.all()) {
    if (!point.followed) continue;
    ++followed;
    CHECK(point.at == 2.4);
    CHECK(point.from > 2.0);
    CHECK(point.to < 3.0);
  }
  CHECK(followed == 1);
}

TEST_CASE("a peak without symmetry brings a point for each of its sides") {
  const auto objective = curves({kObjective});
  const Scan scan = scan_with({{0, 1.43, 5.0, 2}});
  ActivePoints points(space_of(false), objective, kWorst, scan);
  CHECK(points.all().size() == 2 * kGrid);
  points.join(scan, true);
  REQUIRE(points.all().size() == 2 * kGrid + 2);
  CHECK(points.all().back().side == 1);
}

TEST_CASE("points far below their bound are dropped, those near it and those without response stay") {
  const auto limited = curves({kObjective, CurveKind::Of::upper_limit});
  ActivePoints points(space_of(false), limited, kWorst, {});
  REQUIRE(points.all().size() == 2 * kGrid);
  std::vector<double> responses(2 * kGrid, 0.1);
  responses[3] = 9.0;  // of the objective, whose bound is 10
  responses[4] = 7.9;  // below 80 % of it
  responses[5] = std::nan("");
  responses[kGrid + 7] = 0.9;  // of the limit, whose bound is 1
  const double kept[] = {points.all()[3].at, points.all()[5].at, points.all()[kGrid + 7].at};
  points.drop_idle(responses, 10.0);
  REQUIRE(points.all().size() == 3);
  for (std::size_t i = 0; i < 3; ++i) CHECK(points.all()[i].at == kept[i]);
  CHECK(points.all()[2].curve == 1);
}

}  // namespace
}  // namespace frahm::tuning::active_points_test
