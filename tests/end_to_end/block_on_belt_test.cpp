// block_on_belt.toml: stick and slip by its closed form.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/end_to_end/motion_file.hpp"
#include "tests/study_path.hpp"

namespace block_on_belt_test {
namespace {

using Catch::Matchers::WithinRel;

TEST_CASE("block_on_belt.toml: period, time of sticking and amplitude are those of the closed form") {
  constexpr double kExact = 1e-10;  // relative
  const double m = 2.0, k = 800.0, f_k = 3.0, f_s = 8.0, V = 0.05;
  const double D = (f_s - f_k) / k, w = std::sqrt(k / m);
  const double T = 2.0 * D / V + 2.0 / w * (std::numbers::pi - std::atan(w * D / V));
  const runs::MotionFile file(study_path("block_on_belt"), "transient");
  const auto &onset = file["friction_stop_onset"], &release = file["friction_release"];
  REQUIRE(onset.size() == 12);  // it rides from the start, then once in each period
  CHECK(onset[0] == 0.0);
  CHECK_THAT(release[0], WithinRel(f_s / (k * V), kExact));
  for (std::size_t i = 1; i + 1 < onset.size(); ++i) {
    CHECK_THAT(release[i] - release[i - 1], WithinRel(T, kExact));
    CHECK_THAT(release[i] - onset[i], WithinRel(2.0 * D / V, kExact));
  }
  CHECK_THAT(file["block_peak"][0], WithinRel(f_k / k + std::hypot(D, V / w), kExact));
  CHECK(file["energy_balance"][0] < 1e-10);
  CHECK(file["energy_input"][0] > file["friction_energy"][0]);  // the rest is in the spring at the end
}

}  // namespace
}  // namespace block_on_belt_test
