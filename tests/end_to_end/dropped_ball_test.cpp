// dropped_ball.toml: each flight and each contact by its closed form.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "tests/end_to_end/motion_file.hpp"
#include "tests/study_path.hpp"

namespace dropped_ball_test {
namespace {

using Catch::Matchers::WithinRel;

constexpr double m = 0.5, h = 1.0, k = 20e3, c = 3.0, g = 9.80665;

// Penetration and its rate a time after the ball met the floor at speed v: d = m g/k + e^{-b t} (A cos w t +
// B sin w t).
std::pair<double, double> in_the_floor(double v, double t) {
  const double b = c / (2.0 * m), w = std::sqrt(k / m - b * b), A = -m * g / k, B = (v + b * A) / w;
  const double fade = std::exp(-b * t), cosine = std::cos(w * t), sine = std::sin(w * t);
  return {m * g / k + fade * (A * cosine + B * sine),
          fade * ((w * B - b * A) * cosine - (w * A + b * B) * sine)};
}

// How long the floor pushes: until k d + c d' = 0.
double contact_time(double v) {
  const auto pushes = [&](double t) {
    const auto [d, rate] = in_the_floor(v, t);
    return k * d + c * rate > 0.0;
  };
  double low = 0.5 * std::sqrt(m / k), high = 4.0 * std::sqrt(m / k);  // one half swing takes pi sqrt(m/k)
  REQUIRE((pushes(low) && !pushes(high)));
  while (high - low > 2.0 * std::numeric_limits<double>::epsilon() * high)
    (pushes(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
  return low;
}

TEST_CASE("dropped_ball.toml: the ball falls, bounces and flies as its closed form says") {
  constexpr double kExact = 1e-11;  // relative; errors add up from bounce to bounce
  const runs::MotionFile file(study_path("dropped_ball"), "transient");
  const auto &touch = file["floor_touch"], &end = file["floor_touch_end"];
  REQUIRE(touch.size() >= 8);
  double at = std::sqrt(2.0 * h / g), v = g * at;
  for (std::size_t i = 0; i < 8; ++i) {
    INFO("bounce " << i);
    CHECK_THAT(touch[i], WithinRel(at, kExact));
    const double contact = contact_time(v);
    CHECK_THAT(end[i], WithinRel(at + contact, kExact));
    const auto [d, rate] = in_the_floor(v, contact);
    const double up = -rate;
    // It leaves d below the level of the floor, flies past it, and falls back to it.
    v = std::sqrt(up * up - 2.0 * g * d);
    at += contact + (up + v) / g;
  }
  CHECK(file["energy_balance"][0] < 1e-10);
  CHECK_THAT(file["initial_energy"][0] + file["energy_input"][0],
             WithinRel(file["floor_energy"][0] + file["final_energy"][0], 1e-10));
}

}  // namespace
}  // namespace dropped_ball_test
