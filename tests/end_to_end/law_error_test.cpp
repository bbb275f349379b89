// law_error_rig.toml and law_error_slope.toml: the error of the smoothed friction law as a map.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "studies/map/grid.hpp"
#include "studies/reading/parse_study.hpp"
#include "tests/end_to_end/runs.hpp"

namespace law_error_test {
namespace {

using runs::Map;

// The largest error on the full grid of law_error_rig.toml is 1.9e-4, at I = 12.9 kg, FP = 0.3 and 350 rpm;
// an integrator of its own confirms it (tests/known_answers/arctan_test.cpp).
constexpr double largest_error = 2e-4;
constexpr double kKept = 0x1p-48;  // of recorded values; the difference was taken before they were rounded

std::string of_slope() {
  return runs::reduced("law_error_slope", {{"slope", 5}});
}

TEST_CASE("law_error_rig.toml: both laws are solved everywhere, and the smoothed one is near") {
  const Map map = runs::run_study(runs::reduced("law_error_rig", {{"I", 2}, {"FP", 3}, {"omega", 6}}));
  for (const double status : map["status"]) CHECK((status == 1.0 || status == 2.0));
  for (const double status : map["status_compared"]) CHECK(status == 1.0);
  const auto &own = map["main_peak"], &other = map["main_peak_compared"],
             &error = map["main_peak_difference"];
  for (std::size_t i = 0; i < own.size(); ++i) {
    CHECK_THAT(error[i], Catch::WithinAbs(std::abs(own[i] - other[i]) / own[i], kKept));
    CHECK(error[i] < largest_error);
    CHECK(error[i] > 0.0);
  }
}

TEST_CASE("law_error_rig.toml: the differences say under which law, and the status has its meanings") {
  const Map map = runs::run_study(runs::reduced("law_error_rig", {{"I", 2}, {"FP", 2}, {"omega", 2}}));
  const auto& variables = map.layout.variables;
  const auto named = [&](const std::string& name) {
    return *std::find_if(variables.begin(), variables.end(), [&](const auto& v) { return v.name == name; });
  };
  CHECK(named("main_peak_compared").unit == "m");
  CHECK(named("main_peak_difference").unit == "1");
  CHECK(named("main_peak_difference").long_name == "relative difference of main_peak under the arctan law");
  CHECK(named("status_compared").flags.size() == 7);
  for (const double difference : map["guide_energy_difference"]) {
    CHECK((std::isnan(difference) || difference < 1e-2));  // NaN where FP = 0: no energy to compare
  }
}

TEST_CASE("law_error_slope.toml: the error falls with the slope by nearly 10 a decade") {
  const Map map = runs::run_study(of_slope());
  for (const double regime : map["friction_regime"]) CHECK(regime == 2.0);
  const auto& error = map["main_peak_difference"];
  const std::size_t points = error.size() / 5;
  std::vector<double> decades;
  for (std::size_t i = 0; i < points; ++i) {
    for (std::size_t s = 0; s < 5; ++s) CHECK(error[s * points + i] < 5e-3 * std::pow(0.2, s));
    decades.push_back(std::log10(error[3 * points + i] / error[4 * points + i]));
  }
  // (A + B ln slope) / slope: 1 less 1/ln(C slope), where A and B do not nearly cancel.
  std::nth_element(decades.begin(), decades.begin() + static_cast<std::ptrdiff_t>(points / 2), decades.end());
  CHECK_THAT(decades[points / 2], Catch::WithinAbs(1.0 - 1.0 / std::log(1e6), 0.05));
}

TEST_CASE("law_error_slope.toml: the values do not depend on the number of threads") {
  REQUIRE(frahm::studies::grid_of(frahm::studies::parse_study(of_slope(), "slope.toml")).tiles() > 3);
  const runs::Folder folder;
  const std::string study = folder.write("study.toml", of_slope());
  std::map<std::string, std::vector<double>> one;
  for (const char* threads : {"1", "3"}) {
    const std::string output = folder / std::string(threads) + ".h5";
    REQUIRE(runs::frahm({"run", study, "-o", output, "--threads", threads, "--progress", "none"}).code == 0);
    const Map map = runs::read_map(output);
    if (one.empty()) one = map.values;
    CHECK(map.values == one);
  }
}

}  // namespace
}  // namespace law_error_test
