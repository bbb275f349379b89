// pulled_trailer.toml: stick and slip by its closed form.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/end_to_end/motion_file.hpp"
#include "tests/study_path.hpp"

namespace pulled_trailer_test {
namespace {

using Catch::Matchers::WithinRel;

TEST_CASE("pulled_trailer.toml: the block jumps at the times and as far as the closed form says") {
  constexpr double kExact = 1e-10;  // relative
  const double m = 2.0, k = 800.0, f_k = 3.0, f_s = 8.0, V = 0.05;
  const double D = (f_s - f_k) / k, w = std::sqrt(k / m);
  const double T = 2.0 * D / V + 2.0 / w * (std::numbers::pi - std::atan(w * D / V));
  const runs::MotionFile file(study_path("pulled_trailer"), "transient");
  const auto &onset = file["friction_stop_onset"], &release = file["friction_release"];
  REQUIRE(onset.size() >= 11);
  CHECK(onset[0] == 0.0);
  CHECK_THAT(release[0], WithinRel(f_s / (k * V), kExact));
  for (std::size_t i = 1; i + 1 < onset.size(); ++i) {
    CHECK_THAT(release[i] - release[i - 1], WithinRel(T, kExact));
    CHECK_THAT(release[i] - onset[i], WithinRel(2.0 * D / V, kExact));
  }
  // At each release the rope is f_s/k longer than at the start.
  CHECK_THAT(file["lag_peak"][0], WithinRel(f_k / k + std::hypot(D, V / w), kExact));
  CHECK_THAT(file["block_displacement"].back() + file["lag_displacement"].back(), WithinRel(V * 5.0, kExact));
  CHECK(file["energy_balance"][0] < 1e-10);
}

}  // namespace
}  // namespace pulled_trailer_test
