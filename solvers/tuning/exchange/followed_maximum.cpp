#include "solvers/tuning/exchange/followed_maximum.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/algebra/no_value.hpp"

namespace frahm::tuning {
namespace {

struct Slope {
  double at = 0.0, value = 0.0;
};

// The curve at one design, by its slope.
class Climb {
 public:
  Climb(BandCurve& curve, std::span<const double> x, std::size_t side) : curve_(curve), x_(x), side_(side) {}

  // false: no response there
  bool ask(double at, Slope& slope) {
    if (curve_.solve(x_, at, Derivatives::along_band) != TunedResponse::State::solved) return false;
    value_ = curve_.value(side_);
    if (std::isnan(highest_at_) || value_ > highest_) {
      highest_ = value_;
      highest_at_ = at;
    }
    slope = {at, 0.5 * (curve_.slope_left(side_) + curve_.slope_right(side_))};
    return std::isfinite(slope.value);
  }
  // The gain of another step from here is below the rounding of the value.
  bool is_top(const Slope& here, double step) const {
    return std::abs(here.value * step) <= 1e-16 * std::abs(curve_.value(side_));
  }
  double value() const { return value_; }            // of the curve where it was asked last
  double highest_at() const { return highest_at_; }  // where it was highest; NaN: nowhere

 private:
  BandCurve& curve_;
  std::span<const double> x_;
  std::size_t side_;
  double value_ = kNone, highest_ = kNone, highest_at_ = kNone;
};

// Where a straight line through two slopes is zero.
double secant(const Slope& a, const Slope& b) {
  return b.at - b.value * (b.at - a.at) / (b.value - a.value);
}

// Between a place on a stretch that rises and one beyond its end, where the curve is lower: closes in on the
// end.
void close_in_on_end(Climb& climb, double on, double beyond) {
  constexpr int kHalvings = 30;
  double least = kNone;
  Slope slope;
  if (climb.ask(on, slope)) least = climb.value();
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (on + beyond);
    const bool on_stretch = climb.ask(middle, slope) && climb.value() >= least;
    (on_stretch ? on : beyond) = middle;
  }
}

// Leaves the curve solved at its maximum. Returns the maximum's place; NaN: no response, or the end of a
// stretch.
double climb_to_maximum(BandCurve& curve, Climb& climb, double near, double from, double to) {
  constexpr int kMostSteps = 60;
  // 1. Uphill from `near`, by longer and longer steps, until the slope turns: the maximum is between low and
  // high.
  Slope low, high;
  if (!climb.ask(near, low)) return kNone;
  const double direction = low.value > 0.0 ? 1.0 : -1.0;
  double stride = 1e-4 * (to - from);
  for (bool turned = false; !turned; stride *= 4.0) {
    if (low.value == 0.0) return low.at;
    const double next = std::clamp(low.at + direction * stride, from, to);
    if (next == low.at) return low.at;  // the end of the stretch is the highest
    const double value = climb.value();
    if (!climb.ask(next, high)) return kNone;
    turned = high.value * direction <= 0.0;
    if (!turned && curve.response().may_jump() && climb.value() < value) {
      close_in_on_end(climb, low.at, next);
      return kNone;
    }
    if (!turned) low = high;
  }
  // 2. The root of the slope between them: secants, halves where these do not help (Dekker 1969).
  Slope before = low, last = high;
  for (int i = 0; i < kMostSteps; ++i) {
    double next = secant(before, last);
    const double inner = std::min(low.at, high.at), outer = std::max(low.at, high.at);
    if (!(next > inner && next < outer)) next = 0.5 * (inner + outer);
    if (climb.is_top(last, next - last.at) || next == last.at) return last.at;
    before = last;
    if (!climb.ask(next, last)) return kNone;
    (last.value * direction > 0.0 ? low : high) = last;
  }
  return last.at;
}

}  // namespace

bool follow_maximum(BandCurve& curve, std::span<const double> x, double near, double from, double to,
                    std::size_t side, Derivatives derivatives) {
  Climb climb(curve, x, side);
  double at = climb_to_maximum(curve, climb, near, from, to);
  if (curve.response().may_jump() && at != climb.highest_at()) {
    at = climb.highest_at();
    return !std::isnan(at) && curve.solve(x, at, derivatives) == TunedResponse::State::solved;
  }
  if (std::isnan(at)) return false;
  return derivatives != Derivatives::all || curve.solve(x, at, derivatives) == TunedResponse::State::solved;
}

}  // namespace frahm::tuning
