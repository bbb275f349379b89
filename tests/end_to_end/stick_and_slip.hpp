#pragma once

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/end_to_end/motion_file.hpp"

// A block that rubs on what moves away under it, and that a spring holds: on a belt, or pulled by the spring
// over the ground, which is the same motion seen from the belt.
namespace stick_and_slip {

inline constexpr double kExact = 1e-10;  // relative
inline constexpr double m = 2.0, k = 800.0, f_k = 3.0, f_s = 8.0, V = 0.05;
inline const double D = (f_s - f_k) / k, w = std::sqrt(k / m);
// It sticks while the spring gains 2 D, then slips along an ellipse through (D, V/w).
inline const double period = 2.0 * D / V + 2.0 / w * (std::numbers::pi - std::atan(w * D / V));
inline const double peak = f_k / k + std::hypot(D, V / w);  // of the spring

// When it stops and when it is released.
inline void check_times(const runs::MotionFile& file) {
  using Catch::Matchers::WithinRel;
  const auto &onset = file["friction_stop_onset"], &release = file["friction_release"];
  REQUIRE(onset.size() >= 11);
  CHECK(onset[0] == 0.0);
  CHECK_THAT(release[0], WithinRel(f_s / (k * V), kExact));
  for (std::size_t i = 1; i + 1 < onset.size(); ++i) {
    CHECK_THAT(release[i] - release[i - 1], WithinRel(period, kExact));
    CHECK_THAT(release[i] - onset[i], WithinRel(2.0 * D / V, kExact));
  }
}

}  // namespace stick_and_slip
