// Shipped maps, whole, from the phases of events where that serves, and by shooting alone.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/end_to_end/runs.hpp"

namespace two_ways_test {
namespace {

using runs::Map;

constexpr double kSame = 1e-10;      // relative
constexpr double kSamePhase = 1e-8;  // [rad]
// Of a variable's largest value: below, relative to this part of it. An rms of short slides between long
// rests, the difference of larger motions, has fewer digits by shooting (0.0013 in the regime map: 5e-10 off,
// from its phases 6e-13).
constexpr double kSlight = 1e-3;

bool is_of_computation(const std::string& name) {
  return name == "residual" || name == "error_bound" || name == "energy_balance" ||
         name == "newton_iterations";
}

// Shares of 1, compared as such: the duration of a slight stop is as sensitive as a square root.
bool is_share(const std::string& name) {
  return name == "floquet_radius" || name.ends_with("_stuck_fraction");
}

Map run(const std::string& text, const std::string& path) {
  const std::string keys = "precision = \"full\"\npath = \"" + path + "\"\n";
  const auto output = text.find("[output]\n");
  if (output == std::string::npos) return runs::run_study(text + "\n[output]\n" + keys);
  return runs::run_study(runs::replaced(text, "[output]\n", "[output]\n" + keys));
}

void check_same(const std::string& study) {
  const std::string text = runs::reduced(study, {});
  const Map general = run(text, "general"), fastest = run(text, "fastest");
  REQUIRE(general.values.size() == fastest.values.size());
  for (const auto& [name, values] : general.values) {
    if (is_of_computation(name)) continue;
    const std::vector<double>& others = fastest[name];
    REQUIRE(values.size() == others.size());
    double largest = 0.0, worst = 0.0;
    for (const double value : values)
      largest = std::isnan(value) ? largest : std::max(largest, std::abs(value));
    std::size_t missing = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (std::isnan(values[i]) != std::isnan(others[i])) ++missing;
      if (std::isnan(values[i]) || values[i] == others[i]) continue;
      const bool is_angle = name.ends_with("_phase");
      const double apart = is_angle ? std::abs(std::remainder(values[i] - others[i], 2.0 * std::numbers::pi))
                                    : std::abs(values[i] - others[i]);
      const double scale = is_angle         ? kSamePhase / kSame
                           : is_share(name) ? 1.0
                                            : std::max(std::abs(values[i]), kSlight * largest);
      worst = std::max(worst, apart / scale);
    }
    INFO(study << " " << name);
    CHECK(missing == 0);
    CHECK(worst <= kSame);
  }
}

TEST_CASE("den_hartog, cheng_zu, levitan and the regime map are the same both ways, at every point") {
  for (const char* study : {"den_hartog", "cheng_zu", "levitan", "regime_map"}) check_same(study);
}

}  // namespace
}  // namespace two_ways_test
