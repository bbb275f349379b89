#include "solvers/flow/polynomial.hpp"

#include <algorithm>

namespace frahm::periodic {
namespace {

using Bernstein = std::array<double, kTerms>;

// b_i = sum_{k <= i} binomial(i, k) / binomial(d, k) p_k, with d the degree (Farin, sec. 5.8).
Bernstein to_bernstein(const Polynomial& p) {
  Bernstein b{};
  double scale = 1.0;                   // 1 / binomial(d, k)
  std::array<double, kTerms> column{};  // binomial(i, k)
  column.fill(1.0);
  for (int k = 0; k < kTerms; ++k) {
    for (int i = k; i < kTerms; ++i)
      b[static_cast<std::size_t>(i)] += column[static_cast<std::size_t>(i)] * scale * p[k];
    scale *= (k + 1.0) / (kTerms - 1.0 - k);
    for (int i = k; i < kTerms; ++i) column[static_cast<std::size_t>(i)] *= (i - k) / (k + 1.0);
  }
  return b;
}

int sign_variations(const Bernstein& b) {
  int variations = 0;
  double last = 0.0;
  for (const double value : b) {
    if (value == 0.0) continue;
    if (last * value < 0.0) ++variations;
    last = value > 0.0 ? 1.0 : -1.0;
  }
  return variations;
}

// de Casteljau's algorithm at the middle.
void halve(const Bernstein& b, Bernstein& left, Bernstein& right) {
  right = b;
  for (std::size_t i = 0; i < kTerms; ++i) {
    left[i] = right[0];
    for (std::size_t k = 0; k + 1 + i < kTerms; ++k) right[k] = 0.5 * (right[k] + right[k + 1]);
  }
}

void collect(const Polynomial& p, const Bernstein& b, double lo, double hi, Roots& roots) {
  constexpr double kClosestPair = 1e-9;
  const int variations = sign_variations(b);
  if (variations == 0 || roots.count == Roots::kMaxRoots) return;
  const bool ends_differ = b.front() * b.back() < 0.0;
  if ((variations == 1 && ends_differ) || (hi - lo < kClosestPair && ends_differ)) {
    roots.at[static_cast<std::size_t>(roots.count++)] = root_between(p, lo, hi);
    return;
  }
  if (hi - lo < kClosestPair) return;
  Bernstein left, right;
  halve(b, left, right);
  const double middle = 0.5 * (lo + hi);
  collect(p, left, lo, middle, roots);
  // An exact zero at the middle is the end of both halves: count it once.
  if (left.back() == 0.0 && left[kTerms - 2] * right[1] < 0.0 && roots.count < Roots::kMaxRoots) {
    roots.at[static_cast<std::size_t>(roots.count++)] = middle;
  }
  collect(p, right, middle, hi, roots);
}

// Where the cubic Hermite interpolant between lo and hi changes sign, roughly: the start of Newton's method.
double hermite_root(ValueAndSlope left, ValueAndSlope right, double lo, double hi) {
  const double length = hi - lo, c1 = left.slope * length;
  const double rise = right.value - left.value;
  const double c2 = 3.0 * rise - 2.0 * c1 - right.slope * length;
  const double c3 = rise - c1 - c2;
  double s = -left.value / rise;
  for (int iteration = 0; iteration < 2; ++iteration) {
    const double value = left.value + s * (c1 + s * (c2 + s * c3)),
                 slope = c1 + s * (2.0 * c2 + 3.0 * s * c3);
    s = std::clamp(s - value / slope, 0.0, 1.0);
  }
  return s > 0.0 && s < 1.0 ? lo + s * length : 0.5 * (lo + hi);
}

// Within the sum of k (k-1) (k-2) (k-3) |p_k|, which bounds the fourth derivative.
SignVerdict verdict_from_ends(const Polynomial& p) {
  double fourth_derivative = 0.0, value = p[0], slope = 0.0;
  for (int k = 1; k < kTerms; ++k) {
    value += p[k];
    slope += k * p[k];
    fourth_derivative += (k * (k - 1.0) * (k - 2.0) * (k - 3.0)) * std::abs(p[k]);
  }
  return hermite_verdict({p[0], p[1]}, {value, slope}, fourth_derivative / 384.0);
}

}  // namespace

double root_between(const Polynomial& p, double lo, double hi) {
  const Polynomial d = derivative(p), dd = derivative(d);
  const bool whole = lo == 0.0 && hi == 1.0;
  const ValueAndSlope left = whole ? ValueAndSlope{p[0], p[1]} : evaluate_with_slope(p, lo);
  const ValueAndSlope right = whole ? ValueAndSlope{p.sum(), d.sum()} : evaluate_with_slope(p, hi);
  if (left.value == 0.0) return lo;
  if (right.value == 0.0) return hi;
  const double side = left.value > 0.0 ? 1.0 : -1.0;
  double s = hermite_root(left, right, lo, hi);
  constexpr double kResolution = 2e-16;  // of the step
  constexpr int kMostIterations = 100;
  double last_step = hi - lo;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    const Polynomial power = powers(s);
    const double value = p.dot(power), slope = d.dot(power), curvature = dd.dot(power);
    // Halley's method: the error is cubed each time, so what a step leaves is about step^4 / last_step^3.
    const double step = -2.0 * value * slope / (2.0 * slope * slope - value * curvature), next = s + step;
    const double ratio = step / last_step;
    if (std::abs(step) <= kResolution ||
        (std::abs(ratio) < 1e-2 && std::abs(step * ratio * ratio * ratio) <= 0.1 * kResolution)) {
      return std::clamp(next, lo, hi);
    }
    (side * value > 0.0 ? lo : hi) = s;
    if (hi - lo <= kResolution) return s;
    last_step = std::abs(step);
    s = next > lo && next < hi ? next : 0.5 * (lo + hi);
  }
  return s;
}

bool may_change_sign(const Polynomial& p) {
  return verdict_from_ends(p) != SignVerdict::no_change;
}

Roots sign_changes(const Polynomial& p) {
  Roots roots;
  switch (verdict_from_ends(p)) {
    case SignVerdict::no_change:
      return roots;
    case SignVerdict::one_change:
      roots.at[0] = root_between(p, 0.0, 1.0);
      roots.count = 1;
      return roots;
    case SignVerdict::unclear:
      break;
  }
  collect(p, to_bernstein(p), 0.0, 1.0, roots);
  return roots;
}

}  // namespace frahm::periodic
