// The dimensionless studies of studies/*.toml on reduced grids, against the closed forms of their authors.
#include "solvers/orbits/closed_forms.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "tests/end_to_end/runs.hpp"

namespace closed_forms_test {
namespace {

using namespace frahm::periodic;
using runs::Map;

constexpr double amplitude_tolerance = 1e-9;  // of amplitudes of order 1; near resonance relative to them
constexpr double balance_tolerance = 1e-10;

void check_quality(const Map& map) {
  for (const double status : map["status"]) CHECK((status >= 1.0 && status <= 3.0));
  for (const double balance : map["energy_balance"])
    CHECK((std::isnan(balance) || balance < balance_tolerance));
}

// Compares amplitudes over zeta, f and r with a closed form, where it holds. Returns the number of points
// compared.
int compare(const Map& map, const std::string& variable,
            const std::function<double(double r, double zeta, double f)>& closed_form) {
  int compared = 0;
  std::size_t point = 0;
  for (const double zeta : map.coordinate("zeta")) {
    for (const double f : map.coordinate("f")) {
      for (const double r : map.coordinate("r")) {
        const double expected = closed_form(r, zeta, f), found = map[variable][point++];
        // Without any damping a free vibration of period 1/r persists beside the forced one.
        const bool unique = zeta > 0.0 || f > 0.0 || std::abs(1.0 / r - std::round(1.0 / r)) > 1e-9;
        if (std::isnan(expected) || std::isnan(found) || !unique) continue;
        INFO("zeta " << zeta << ", f " << f << ", r " << r);
        CHECK_THAT(found, Catch::WithinAbs(expected, amplitude_tolerance * std::max(1.0, expected)));
        ++compared;
      }
    }
  }
  return compared;
}

TEST_CASE("den_hartog.toml: amplitudes are those of Den Hartog, without stops and with one") {
  const Map map = runs::run_study(runs::reduced("den_hartog", {{"f", 13}, {"r", 49}}));
  check_quality(map);
  CHECK(compare(map, "main_amplitude", classical_amplitude) > 6 * 13 * 49 / 2);
}

TEST_CASE("den_hartog.toml: without damping resonance is unbounded below f = pi/4 and bounded above") {
  std::string study = runs::reduced("den_hartog", {{"f", 13}});
  const std::string range = "from = 0.1\nto = 2.5\npoints = 481";
  study.replace(study.find(range), range.size(), "values = [0.95, 1.0, 1.05]");
  const Map map = runs::run_study(study);
  REQUIRE(map.coordinate("zeta").front() == 0.0);
  for (std::size_t i = 0; i < 13; ++i) {
    const double f = map.coordinate("f")[i];
    INFO("f = " << f);
    CHECK((map["status"][3 * i + 1] == 3.0) == (f < 0.785));
    CHECK(std::isnan(map["main_peak"][3 * i + 1]) == (f < 0.785));
  }
}

TEST_CASE("hundal.toml: amplitudes are those of Hundal's mapping") {
  const Map map = runs::run_study(runs::reduced("hundal", {{"f", 13}, {"r", 49}}));
  check_quality(map);
  CHECK(compare(map, "main_amplitude", hundal_amplitude) > 5 * 13 * 49 / 2);
}

TEST_CASE("levitan.toml: strokes are those of Levitan's mapping, and the mass rides with the base") {
  const Map map = runs::run_study(runs::reduced("levitan", {{"f", 13}, {"r", 49}}));
  check_quality(map);
  CHECK(compare(map, "spring_stroke", levitan_amplitude) > 5 * 13 * 49 / 2);
}

TEST_CASE("cheng_zu.toml: amplitudes are those of Cheng and Zu where two reversals a period are all") {
  const Map map = runs::run_study(runs::reduced("cheng_zu", {{"FP", 7}, {"r1", 25}}));
  check_quality(map);
  int compared = 0;
  std::size_t point = 0;
  for (const double phase : map.coordinate("phase")) {
    for (const double p2 : map.coordinate("P2P1")) {
      for (const double f : map.coordinate("FP")) {
        for (const double r1 : map.coordinate("r1")) {
          const std::size_t at = point++;
          const auto expected = two_frequency_response(
              {.r1 = r1, .M = 1, .N = 3, .zeta = 0.1, .f = f, .p2 = p2, .phase = phase});
          if (!expected.valid()) continue;
          INFO("r1 " << r1 << ", f " << f << ", P2/P1 " << p2 << ", phase " << phase);
          CHECK_THAT(
              map["main_amplitude"][at],
              Catch::WithinAbs(expected.amplitude, amplitude_tolerance * std::max(1.0, expected.amplitude)));
          ++compared;
        }
      }
    }
  }
  CHECK(compared > 500);
}

TEST_CASE("cheng_zu_even.toml: an even order moves the mean, and without it there is none") {
  const Map map = runs::run_study(runs::reduced("cheng_zu_even", {{"FP", 4}, {"r1", 13}}));
  check_quality(map);
  const std::size_t row = 4 * 13;
  double largest = 0.0;
  for (std::size_t point = 0; point < 5 * row * map.coordinate("phase").size(); ++point) {
    const double p2 = map.coordinate("P2P1")[point / row % 5];
    const double mean = std::abs(map["main_mean"][point]);
    if (p2 == 0.0) CHECK(mean < 1e-9);
    largest = std::max(largest, mean);
  }
  CHECK(largest > 0.01);
}

}  // namespace
}  // namespace closed_forms_test
