#include "studies/map/regime_crossings.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

namespace regime_crossings_test {
namespace {

using namespace frahm::studies;
using frahm::periodic::Regime;
using frahm::periodic::Stretch;

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
constexpr double place_tolerance = 0.5 * crossing_width;
constexpr int most_probes = 100;  // of a crossing, as promised

// Counts the points asked for.
struct Line {
  std::function<RegimePoint(double)> point;
  int probes = 0;

  std::vector<RegimeCrossing> crossings() {
    return find_crossings(point(0.0).regime, point(1.0).regime, [this](double at) {
      ++probes;
      return point(at);
    });
  }
};

void check(const RegimeCrossing& crossing, double at, Regime below, Regime above) {
  CHECK_THAT(crossing.at, Catch::WithinAbs(at, place_tolerance));
  CHECK(crossing.below == below);
  CHECK(crossing.above == above);
}

// No stop below `place`, beyond it stops of the length given by the distance.
Line stops_beyond(double place, const std::function<double(double)>& length) {
  return {[=](double at) -> RegimePoint {
    if (at < place) return {Regime::non_stop, nothing};
    return {Regime::one_stop, length(at - place)};
  }};
}

TEST_CASE("a stop that grows with the distance leads to the crossing in few points") {
  for (const double place : {0.9, 0.45, 0.3183, 0.01}) {
    Line line =
        stops_beyond(place, [](double distance) { return 0.2 * distance + 0.1 * distance * distance; });
    const auto crossings = line.crossings();
    INFO(place << ": " << line.probes);
    REQUIRE(crossings.size() == 1);
    check(crossings[0], place, Regime::non_stop, Regime::one_stop);
    CHECK(line.probes <= 16);
  }
}

TEST_CASE("so does one that grows with the root of the distance, where a velocity touches zero") {
  for (const double place : {0.9, 0.45, 0.3183, 0.01}) {
    Line line = stops_beyond(place, [](double distance) { return std::sqrt(distance) + 0.2 * distance; });
    const auto crossings = line.crossings();
    INFO(place << ": " << line.probes);
    REQUIRE(crossings.size() == 1);
    check(crossings[0], place, Regime::non_stop, Regime::one_stop);
    CHECK(line.probes <= 22);
  }
}

TEST_CASE("the crossing is found by bisection where the lengths of stops tell nothing") {
  for (const double length : {1.0, nothing}) {
    Line line = stops_beyond(0.3183, [=](double) { return length; });
    const auto crossings = line.crossings();
    REQUIRE(crossings.size() == 1);
    check(crossings[0], 0.3183, Regime::non_stop, Regime::one_stop);
    CHECK(line.probes <= 32);
  }
  // Nothing has a stop at all on either side.
  Line jump{[](double at) -> RegimePoint { return {at < 0.7 ? Regime::stuck : Regime::non_stop, nothing}; }};
  const auto crossings = jump.crossings();
  REQUIRE(crossings.size() == 1);
  check(crossings[0], 0.7, Regime::stuck, Regime::non_stop);
}

TEST_CASE("where regimes count stops from a length on, the crossing is where they have none") {
  constexpr double counted = 2e-9 * std::numbers::pi;
  for (const double slope : {1e-1, 1e-2, 1e-3}) {
    Line line{[=](double at) -> RegimePoint {
      const double length = slope * (at - 0.3183) * (1.0 + at);
      if (length < counted) return {Regime::non_stop, nothing};
      return {Regime::one_stop, length};
    }};
    const auto crossings = line.crossings();
    INFO(slope);
    REQUIRE(crossings.size() == 1);
    check(crossings[0], 0.3183, Regime::non_stop, Regime::one_stop);
  }
}

TEST_CASE("lengths that mislead cost no more points than were promised") {
  Line line = stops_beyond(0.3183, [](double distance) { return 2.0 + std::sin(1e4 * distance); });
  const auto crossings = line.crossings();
  REQUIRE(crossings.size() == 1);
  check(crossings[0], 0.3183, Regime::non_stop, Regime::one_stop);
  CHECK(line.probes <= most_probes);
}

TEST_CASE("a forecast saves points where it is right, and misleads for a few where it is wrong") {
  const auto probes = [](double place, CrossingForecast forecast) {
    Line line =
        stops_beyond(place, [](double distance) { return 0.2 * distance + 0.1 * distance * distance; });
    const auto crossings = find_crossings(
        Regime::non_stop, Regime::one_stop,
        [&](double at) {
          ++line.probes;
          CHECK(at > 0.0);
          CHECK(at < 1.0);
          return line.point(at);
        },
        forecast);
    REQUIRE(crossings.size() == 1);
    check(crossings[0], place, Regime::non_stop, Regime::one_stop);
    return line.probes;
  };
  for (const double place : {0.9, 0.45, 0.3183, 0.01}) {
    INFO(place);
    CHECK(probes(place, {place + 3e-5, 1e-4}) <= 10);
    CHECK(probes(place, {place - 3e-5, 1e-4}) <= 10);
    for (const double wrong : {-0.5, 0.0, 0.2, 0.999, 1.0, 7.0}) CHECK(probes(place, {wrong, 1e-4}) <= 24);
  }
}

TEST_CASE("regimes that lie between are found with all their crossings, in order") {
  Line line{[](double at) -> RegimePoint {
    if (at < 0.2) return {Regime::non_stop, nothing};
    if (at < 0.55) return {Regime::one_stop, at - 0.2};
    if (at < 0.8) return {Regime::multi_stop, std::min(at - 0.55, 0.8 - at)};
    return {Regime::stuck, nothing};
  }};
  const auto crossings = line.crossings();
  REQUIRE(crossings.size() == 3);
  check(crossings[0], 0.2, Regime::non_stop, Regime::one_stop);
  check(crossings[1], 0.55, Regime::one_stop, Regime::multi_stop);
  check(crossings[2], 0.8, Regime::multi_stop, Regime::stuck);
}

TEST_CASE("regimes that change without end are cut off, and what is told of them is seen") {
  const auto regime = [](double at) {
    return at < 0.1 ? Regime::non_stop : at > 0.9 ? Regime::stuck : Regime(2 + std::lround(1e9 * at) % 4);
  };
  Line line{[&](double at) -> RegimePoint { return {regime(at), nothing}; }};
  const auto crossings = line.crossings();
  CHECK_FALSE(crossings.empty());
  CHECK(crossings.size() <= 32);
  CHECK(line.probes <= 33 * most_probes);
  for (std::size_t i = 1; i < crossings.size(); ++i) CHECK(crossings[i - 1].at < crossings[i].at);
}

TEST_CASE("where there is no regime there is no crossing") {
  for (const Regime none : {Regime::not_computed, Regime::no_friction}) {
    Line end{[=](double at) -> RegimePoint { return {at < 0.5 ? none : Regime::stuck, nothing}; }};
    CHECK(end.crossings().empty());
    CHECK(end.probes == 0);
    Line between{[=](double at) -> RegimePoint {
      return {at < 0.4 ? Regime::non_stop : at < 0.6 ? none : Regime::stuck, nothing};
    }};
    CHECK(between.crossings().empty());
  }
  Line same{[](double) -> RegimePoint { return {Regime::stuck, nothing}; }};
  CHECK(same.crossings().empty());
}

TEST_CASE("the briefest event is the shortest stop or slide, also where it spans the turn of the period") {
  const double turn = 2.0 * std::numbers::pi;
  const auto stretches = [](std::initializer_list<std::pair<double, const char*>> parts) {
    std::vector<Stretch> result;
    double start = 0.0;
    for (const auto& [length, contact] : parts) {
      result.push_back({start, length, {"slides +", contact}});
      start += length;
    }
    return result;
  };
  const auto briefest = [&](std::initializer_list<std::pair<double, const char*>> parts) {
    return regime_point(Regime::one_stop, stretches(parts), 1).briefest;
  };
  CHECK(briefest({{1.0, "sticks"}, {2.0, "slides +"}, {turn - 3.0, "slides -"}}) == 1.0);
  CHECK(briefest({{0.25, "sticks"}, {5.0, "slides +"}, {turn - 5.25, "sticks"}}) == turn - 5.25 + 0.25);
  CHECK(briefest({{3.0, "sticks"}, {0.5, "slides +"}, {turn - 3.5, "sticks"}}) == 0.5);
  // A stop too short for one.
  CHECK(briefest({{1.0, "slides +"}, {1e-12, "sticks"}, {2.0, "slides -"}, {turn - 3.0, "sticks"}}) == 1.0);
  CHECK(std::isnan(briefest({{3.0, "slides +"}, {turn - 3.0, "slides -"}})));
  CHECK(std::isnan(briefest({{turn, "sticks"}})));
}

}  // namespace
}  // namespace regime_crossings_test
