#include "studies/map/known_digits.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "studies/map/map_groups.hpp"
#include "studies/map/map_plan.hpp"
#include "studies/reading/parse_study.hpp"
#include "tests/studies/small_studies.hpp"

namespace known_digits_test {
namespace {

using namespace frahm::studies;
using small_studies::axis, small_studies::oscillator;

MapPlan plan_of(const std::string& output) {
  return plan_map(parse_study(oscillator() + axis("r", 0.8, 1.2, 5) + output, "small.toml"), {});
}

// A point of the record: 0.1 everywhere, with this error bound.
std::vector<double> rounded_point(const MapPlan& plan, double bound) {
  std::vector<double> point(plan.variables.size(), 0.1);
  for (std::size_t i = 0; i < point.size(); ++i) {
    if (plan.variables[i].name == "error_bound") point[i] = bound;
  }
  KnownDigits(plan.study, plan.variables).round(point);
  return point;
}

double value_of(const MapPlan& plan, const std::vector<double>& point, const std::string& name) {
  for (std::size_t i = 0; i < point.size(); ++i) {
    if (plan.variables[i].name == name) return point[i];
  }
  FAIL(name);
  return 0.0;
}

TEST_CASE("a number is rounded to the nearest of so many bits, ties to even") {
  CHECK(rounded(1.0 + 0x1p-11, 10) == 1.0);               // a tie
  CHECK(rounded(1.0 + 3 * 0x1p-11, 10) == 1.0 + 0x1p-9);  // a tie
  CHECK(rounded(1.0 + 0x1.8p-11, 10) == 1.0 + 0x1p-10);
  CHECK(rounded(-(2.0 - 0x1p-52), 10) == -2.0);  // a carry into the exponent
  CHECK(rounded(0.1, 0) == 0.1);
  CHECK(rounded(0.0, 10) == 0.0);
  CHECK(std::isnan(rounded(NAN, 10)));
  CHECK(std::isinf(rounded(INFINITY, 10)));
}

TEST_CASE("rounding adds less than a quarter of the error bound, and keeps 40 to 48 bits") {
  const MapPlan plan = plan_of("");
  for (double bound = 1e-9; bound > 1e-17; bound *= 0.37) {
    const double value = value_of(plan, rounded_point(plan, bound), "main_peak");
    INFO(bound);
    CHECK(std::abs(value - 0.1) <= std::max(0.25 * bound, 0.1 * 0x1p-49));
    CHECK(value == rounded(value, most_bits));
    CHECK(std::abs(value - 0.1) <= 0.1 * 0x1p-41);
  }
}

TEST_CASE("without a bound a value keeps 48 bits, a diagnostic always 10, a count and a flag all") {
  const MapPlan plan = plan_of("");
  const std::vector<double> point = rounded_point(plan, NAN);
  CHECK(value_of(plan, point, "main_peak") == rounded(0.1, 48));
  CHECK(value_of(plan, point, "residual") == rounded(0.1, 10));
  CHECK(value_of(plan, point, "energy_balance") == rounded(0.1, 10));
  CHECK(value_of(plan, point, "friction_stops") == 0.1);
  CHECK(value_of(plan, point, "friction_regime") == 0.1);
  CHECK(value_of(plan, rounded_point(plan_of("[output]\nquantities = [\"main_peak\"]\n"), 0.0),
                 "main_peak") == rounded(0.1, 48));
}

TEST_CASE("a study of full precision keeps every bit") {
  const MapPlan plan = plan_of("[output]\nprecision = \"full\"\n");
  CHECK(rounded_point(plan, 1e-9) == [&] {
    std::vector<double> point(plan.variables.size(), 0.1);
    for (std::size_t i = 0; i < point.size(); ++i) {
      if (plan.variables[i].name == "error_bound") point[i] = 1e-9;
    }
    return point;
  }());
}

}  // namespace
}  // namespace known_digits_test
