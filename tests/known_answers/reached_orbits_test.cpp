#include "tests/known_answers/reached_orbits.hpp"

#include <catch2/catch.hpp>
#include <random>

// Random systems of laws that are not monotone: stops on one and on both sides, springs with tables, static
// friction, dampers with falling tables.
namespace frahm::periodic::reached_orbits_test {
namespace {

RandomNetwork draw(unsigned trial) {
  std::mt19937 random(trial);
  const auto pick = [&](int count) { return static_cast<int>(random() % static_cast<unsigned>(count)); };
  RandomNetworkOptions options;
  options.masses = 1 + static_cast<int>(trial % 3);
  options.contacts = pick(2);
  options.static_friction = pick(2) == 0;
  options.stops = pick(2);
  options.two_sided_stops = pick(3) == 0 ? 1 : 0;
  options.spring_tables = pick(3) == 0 ? 1 : 0;
  options.falling_dampers = pick(4) == 0 ? 1 : 0;
  const int bends = options.stops + options.two_sided_stops + options.spring_tables + options.falling_dampers;
  if (bends == 0 && !(options.static_friction && options.contacts > 0)) options.stops = 1;
  options.orders = pick(3) == 0 ? std::vector<int>{0, 1} : std::vector<int>{1};
  options.shaken = pick(2) == 0;
  options.largest_friction = 0.5;
  return random_network(options, random);
}

struct Totals {
  int reached = 0, found = 0, missed = 0, unclosed = 0;
};

Totals compare(unsigned first, unsigned count, int starts, const OrbitsWanted& wanted) {
  Totals totals;
  for (unsigned trial = first; trial < first + count; ++trial) {
    const RandomNetwork drawn = draw(trial);
    OrbitComparison comparison(drawn, wanted);
    comparison.follow(starts, trial);
    const ReachedOrbits& result = comparison.result();
    if (result.missed() > 0) WARN("system " << trial << ": " << result.missed() << " orbits missed");
    totals.reached += result.reached();
    totals.found += result.found();
    totals.missed += result.missed();
    totals.unclosed += result.unclosed;
  }
  return totals;
}

TEST_CASE("The search finds every stable orbit that random starts of an independent integration reach",
          "[slow]") {
  const Totals totals = compare(0, 40, 20, {});
  CHECK(totals.missed == 0);
  CHECK(totals.unclosed == 0);
  CHECK(totals.found >= totals.reached);
}

// Ten minutes and more: test_known_answers "[thorough]". What is missed are subharmonics of small basins.
TEST_CASE("In 300 systems, from 500 starts each, it misses few", "[.thorough]") {
  constexpr double kFew = 0.03;  // of the orbits reached
  const Totals totals = compare(0, 300, 500, {});
  WARN(totals.reached << " orbits reached, " << totals.found << " found, " << totals.missed << " missed");
  CHECK(totals.missed <= kFew * totals.reached);
  CHECK(totals.unclosed == 0);
}

}  // namespace
}  // namespace frahm::periodic::reached_orbits_test
