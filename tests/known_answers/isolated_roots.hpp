#pragma once

#include <Eigen/Core>
#include <cmath>

// Roots of a polynomial, isolated by bounds on its derivatives, so that no double root is missed.
namespace frahm::periodic {

// A polynomial over [0, 1] by its coefficients, from the constant on.
struct SeriesOverStep {
  const double* c;
  Eigen::Index count;

  double operator()(double t) const {
    double sum = 0.0;
    for (Eigen::Index k = count - 1; k >= 0; --k) sum = sum * t + c[k];
    return sum;
  }
  double slope(double t) const {
    double sum = 0.0;
    for (Eigen::Index k = count - 1; k >= 1; --k) sum = sum * t + static_cast<double>(k) * c[k];
    return sum;
  }
  // Bounds of |g'| and |g''| over [0, 1].
  double most_slope() const {
    double sum = 0.0;
    for (Eigen::Index k = 1; k < count; ++k) sum += static_cast<double>(k) * std::abs(c[k]);
    return sum;
  }
  double most_bend() const {
    double sum = 0.0;
    for (Eigen::Index k = 2; k < count; ++k) sum += static_cast<double>(k * (k - 1)) * std::abs(c[k]);
    return sum;
  }
};

// A root between a and b, where the signs differ: on the side of b.
inline double root_between(const SeriesOverStep& g, double a, double b) {
  const bool falls = g(b) <= 0.0;
  for (double middle = 0.5 * (a + b); middle > a && middle < b; middle = 0.5 * (a + b))
    ((g(middle) <= 0.0) == falls ? b : a) = middle;
  return b;
}

// Visits, from left to right, intervals in which g has at most one root, until `visit` says true. Below
// `little` g is rounding.
template <class Visit>
bool isolate(const SeriesOverStep& g, double bend, double little, double a, double b, const Visit& visit) {
  constexpr double kNarrow = 1e-9;  // a minimum so narrow only touches
  const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
  const double value = std::abs(g(middle)), slope = std::abs(g.slope(middle));
  const double change = slope * half + 0.5 * bend * half * half;
  if (value > change) return false;
  if (slope > bend * half || half < kNarrow || value + change < little) return visit(a, b);
  return isolate(g, bend, little, a, middle, visit) || isolate(g, bend, little, middle, b, visit);
}

// The first place in [0, 1] where g, positive at first, is not; or 2. A start within rounding of zero is left
// out: where g then grows, the mode has just begun.
inline double first_end(SeriesOverStep g, double little) {
  for (int zeros = 0; zeros < 2 && g.count > 1 && std::abs(g.c[0]) <= little; ++zeros) {
    ++g.c;
    --g.count;
  }
  const double most_slope = g.most_slope();
  if (std::abs(g.c[0]) + most_slope <= little) return 2.0;
  if (g.c[0] <= 0.0) return 0.0;
  if (g.c[0] > most_slope) return 2.0;
  double found = 2.0;
  isolate(g, g.most_bend(), little, 0.0, 1.0, [&](double a, double b) {
    if (g(b) > 0.0) return false;
    found = root_between(g, a, b);
    return true;
  });
  return found;
}

}  // namespace frahm::periodic
