#include "studies/map/value_match.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

namespace value_match_test {
namespace {

using frahm::studies::match_values;
using frahm::studies::ValueMatch;
using Values = std::vector<double>;
using Numbers = std::vector<std::uint32_t>;

constexpr std::uint32_t none = ValueMatch::none;

// As the axes of a study are made.
Values even_steps(double from, double to, std::size_t points) {
  Values values;
  for (std::size_t i = 0; i < points; ++i)
    values.push_back(std::lerp(from, to, static_cast<double>(i) / static_cast<double>(points - 1)));
  return values;
}

Values even_ratios(double from, double to, std::size_t points) {
  Values values;
  for (std::size_t i = 0; i < points; ++i)
    values.push_back(from * std::pow(to / from, static_cast<double>(i) / static_cast<double>(points - 1)));
  return values;
}

TEST_CASE("the values of an axis are known by their number, upwards, wherever they stand") {
  const ValueMatch match = match_values(Values{3, 1, 2, 1}, Values{2, 5, 1, 3});
  CHECK(match.known == Numbers{2, 0, 1, 0});
  CHECK(match.wanted == Numbers{1, none, 0, 2});
}

TEST_CASE("a longer axis of finer steps has all values of the coarser one, though their last digits differ") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> end(-500.0, 500.0);
  int unequal = 0;
  for (std::size_t round = 0; round < 200; ++round) {
    const double from = end(random), to = end(random);
    INFO("from " << from << " to " << to);
    const std::size_t finer = 1 + round % 4, steps = 400 * 3 * finer;
    const Values coarse = even_steps(from, to, 401),
                 fine = even_steps(from, to + 2.0 * (to - from), steps + 1);
    const Numbers found = match_values(fine, coarse).wanted;
    for (std::size_t i = 0; i < found.size(); ++i) {
      REQUIRE(found[i] == (from < to ? finer * i : steps - finer * i));
      unequal += coarse[i] != fine[finer * i];
    }
    CHECK(std::ranges::count(match_values(coarse, fine).wanted, none) ==
          static_cast<std::ptrdiff_t>(fine.size() - coarse.size()));
  }
  CHECK(unequal > 1000);  // or nothing was tried
}

TEST_CASE("an axis of finer ratios has all values of the coarser one") {
  for (const double to : {1e-3, 1.0, 1e6}) {
    const Values coarse = even_ratios(1e-6, to, 401), fine = even_ratios(1e-6, to, 1201);
    const Numbers found = match_values(fine, coarse).wanted;
    for (std::size_t i = 0; i < found.size(); ++i) REQUIRE(found[i] == 3 * i);
  }
}

TEST_CASE("values of another unit are the same, zero and its neighbourhood among them") {
  const double rpm = std::numbers::pi / 30.0, hertz = 2.0 * std::numbers::pi;
  Values of_rpm, of_hertz;
  for (int i = -300; i <= 300; ++i) {
    of_rpm.push_back(rpm * i);
    of_hertz.push_back(hertz * (i / 60.0));
  }
  const Numbers found = match_values(of_rpm, of_hertz).wanted;
  for (std::size_t i = 0; i < found.size(); ++i) REQUIRE(found[i] == i);
  CHECK(match_values(Values{-1, 0, 1}, even_steps(-1, 1, 7)).wanted ==
        Numbers{0, none, none, 1, none, none, 2});
}

TEST_CASE("values that differ by more than rounding are not the same, however near or small") {
  CHECK(match_values(Values{1.0, 2.0}, Values{1.0 + 1e-14, 2.0}).wanted == Numbers{none, 1});
  CHECK(match_values(Values{0.0, 1e-12, 1.0}, Values{1e-12, 2e-12}).wanted == Numbers{1, none});
  CHECK(match_values(Values{1e-6, 1e-3, 1.0}, Values{1.000001e-6}).wanted == Numbers{none});
  // The nearest of several:
  const double next = std::nextafter(1.0, 2.0);
  CHECK(match_values(Values{1.0, next}, Values{next, 1.0}).wanted == Numbers{1, 0});
}

}  // namespace
}  // namespace value_match_test
