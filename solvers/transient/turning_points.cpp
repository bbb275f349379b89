#include "solvers/transient/turning_points.hpp"

#include <cmath>

namespace frahm::transient {
namespace {

using periodic::Polynomial;

constexpr double kHeld = 1e-13;  // of the speed scale: a mass that is held moves by rounding only

// The polynomial without the root it has at its start.
Polynomial without_root_at_start(const Polynomial& p, double tolerance) {
  int zeros = 0;
  while (zeros < 3 && std::abs(p[zeros]) <= tolerance) ++zeros;
  return periodic::deflate(p, zeros);
}

}  // namespace

void TurningPoints::enter(Sense sense, const MassStep& step, double at) {
  if (sense == sense_) return;
  const bool was_moving = sense_ == Sense::forward || sense_ == Sense::backward;
  const bool starts_from_rest =
      sense_ == Sense::unknown && std::abs(step.velocity[0]) <= periodic::kRest * step.speed_scale;
  const bool creeps = sense == Sense::held && (at > 0.0 || deceleration_ <= kCreeping);
  sense_ = sense;
  if (!starts_from_rest && (!was_moving || creeps)) return;
  extrema_.push_back({step.start + at * step.step, periodic::evaluate(step.displacement, at)});
}

void TurningPoints::follow(const MassStep& step) {
  const double tolerance = periodic::kRest * step.speed_scale, end = step.length;
  const Polynomial& v = step.velocity;
  const periodic::ValueAndSlope last = periodic::evaluate_with_slope(v, end);
  // A root at the very end belongs to the next step, which shows where the motion goes from there.
  constexpr double kAtEnd = 1e-6;
  const double last_root = std::abs(last.value) <= tolerance ? end * (1.0 - kAtEnd) : end;
  const periodic::Roots roots = periodic::sign_changes(without_root_at_start(v, tolerance));

  double from = 0.0;
  for (int i = 0; i <= roots.count; ++i) {
    double to = i < roots.count ? roots.at[static_cast<std::size_t>(i)] : end;
    if (to > last_root) to = end;
    const double middle = periodic::evaluate(v, 0.5 * (from + to));
    if (std::abs(middle) <= kHeld * step.speed_scale) {
      enter(Sense::held, step, from);
    } else {
      enter(middle > 0.0 ? Sense::forward : Sense::backward, step, from);
    }
    if (to == end) break;
    from = to;
  }
  deceleration_ = std::abs(last.slope) / (periodic::kStepRate * step.speed_scale);
}

}  // namespace frahm::transient
