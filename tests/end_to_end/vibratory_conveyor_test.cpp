// vibratory_conveyor.toml: the part's velocity, followed from rest by its straight lines.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/end_to_end/runs.hpp"

namespace vibratory_conveyor_test {
namespace {

using Catch::Matchers::WithinAbs;

// The trough moves with A cos(w t) + B cos(2 w t + pi/2).
struct Trough {
  double w = 0.0, B = 0.0;           // [rad/s], [m]
  static constexpr double A = 4e-3;  // [m]
  double displacement(double t) const { return A * std::cos(w * t) - B * std::sin(2.0 * w * t); }
  double velocity(double t) const { return -w * (A * std::sin(w * t) + 2.0 * B * std::cos(2.0 * w * t)); }
  double acceleration(double t) const {
    return w * w * (4.0 * B * std::sin(2.0 * w * t) - A * std::cos(w * t));
  }
};

// The instant in (start, end] from which `holds` is true, or end if it is not there.
template <typename Condition>
double instant(double start, double end, const Condition& holds) {
  if (!holds(end)) return end;
  double before = start, after = end;
  while (after - before > 1e-15 * end) {
    const double middle = (before + after) / 2.0;
    (holds(middle) ? after : before) = middle;
  }
  return after;
}

// What a period carries the part [m], after many. Sliding, its velocity u goes towards the trough's by mu g
// until it meets it. Then the part sticks while the trough accelerates by at most mu g.
double carried(const Trough& trough) {
  constexpr double pull = 0.4 * 9.81;  // [m/s2]
  constexpr int steps = 2000, periods = 200;
  const double h = 2.0 * std::numbers::pi / trough.w / steps;
  const auto releases = [&](double t) { return std::abs(trough.acceleration(t)) > pull; };
  double u = 0.0, travel = 0.0;
  bool sticks = false;
  for (int step = 0; step < steps * periods; ++step) {
    if (step % steps == 0) travel = 0.0;
    double t = step % steps * h;
    const double end = t + h;
    while (t < end) {
      if (sticks) {
        const double next = instant(t, end, releases);
        travel += trough.displacement(next) - trough.displacement(t);
        u = trough.velocity(next);
        sticks = !releases(next);
        t = next;
        continue;
      }
      const double slip = trough.velocity(t) - u;
      const double rate = std::copysign(pull, slip != 0.0 ? slip : trough.acceleration(t));
      const auto meets = [&](double at) { return (trough.velocity(at) - u - rate * (at - t)) * rate < 0.0; };
      const double next = instant(t, end, meets);
      travel += u * (next - t) + rate * (next - t) * (next - t) / 2.0;
      const bool met = meets(next);
      u = met ? trough.velocity(next) : u + rate * (next - t);
      sticks = met && !releases(next);
      t = next;
    }
  }
  return travel;
}

TEST_CASE("vibratory_conveyor.toml: a period carries the part as far as its velocity, line by line, says") {
  constexpr double kFollowed = 1e-9, kExact = 1e-12;  // [m]
  const runs::Map map = runs::run_study(runs::reduced("vibratory_conveyor", {{"w", 11}}));
  const auto &w = map.coordinate("w"), &B = map.coordinate("B");  // [rad/s], [mm]
  double furthest = 0.0;
  for (std::size_t i = 0; i < w.size(); ++i)
    for (std::size_t j = 0; j < B.size(); ++j) {
      INFO("w = " << w[i] << " rad/s, B = " << B[j] << " mm");
      const std::size_t at = i * B.size() + j;
      const double drift = map["part_drift"][at];
      CHECK(map["energy_balance"][at] < 1e-10);
      if (B[j] == 0.0)
        CHECK(std::abs(drift) < kExact);
      else
        CHECK_THAT(drift, WithinAbs(carried({w[i], 1e-3 * B[j]}), kFollowed));
      furthest = std::max(furthest, std::abs(drift));
    }
  CHECK(furthest > 0.01);
}

}  // namespace
}  // namespace vibratory_conveyor_test
