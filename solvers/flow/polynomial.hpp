#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

// Taylor polynomials of the exact flow over one step, in the step fraction s in [0, 1], and their roots.
namespace frahm::periodic {

// A step is so short that its fastest rate times its length is at most kStepRate. The Taylor remainder is
// then below kStepRate^kTerms / kTerms! = 1.6e-16 of the scale: the flow is exact to the last digit.
inline constexpr int kTerms = 16;
inline constexpr double kStepRate = 0.7;

using Polynomial = Eigen::Matrix<double, kTerms, 1>;  // coefficient k belongs to s^k

// 1, s, s^2, ...
inline Polynomial powers(double s) {
  Polynomial p;
  p[0] = 1.0;
  p[1] = s;
  p[2] = s * s;
  p[3] = p[2] * s;
  const double s4 = p[2] * p[2];
  p.segment<4>(4) = p.head<4>() * s4;
  p.tail<8>() = p.head<8>() * (s4 * s4);
  return p;
}

struct ValueAndSlope {
  double value, slope;
};

inline double evaluate(const Polynomial& p, double s) {
  return p.dot(powers(s));
}

inline Polynomial derivative(const Polynomial& p) {
  Polynomial d;
  for (int k = 0; k + 1 < kTerms; ++k) d[k] = (k + 1) * p[k + 1];
  d[kTerms - 1] = 0.0;
  return d;
}

inline ValueAndSlope evaluate_with_slope(const Polynomial& p, double s) {
  const Polynomial power = powers(s);
  return {p.dot(power), derivative(p).dot(power)};
}

// p(s) / s^multiplicity, for a polynomial whose first `multiplicity` coefficients are zero by its physics.
inline Polynomial deflate(const Polynomial& p, int multiplicity) {
  Polynomial q = Polynomial::Zero();
  for (int k = multiplicity; k < kTerms; ++k) q[k - multiplicity] = p[k];
  return q;
}

// The root of p between lo and hi, where p changes sign: Halley's method, confined to the bracket.
double root_between(const Polynomial& p, double lo, double hi);

// The roots in [0, 1] at which p changes sign, ascending, from at most kMaxRoots brackets.
//
// No root is missed, however close to another: the Bernstein coefficients of p on an interval have at least
// as many sign changes as p has roots there, and an interval with more than one is halved (variation
// diminishing property; G. Farin, Curves and Surfaces for CAGD, 5th ed., sec. 5.3). Two roots closer than
// 1e-9 count as none.
struct Roots {
  static constexpr int kMaxRoots = 8;
  std::array<double, kMaxRoots> at{};
  int count = 0;
};
Roots sign_changes(const Polynomial& p);

// False if the values and slopes at the ends show that p keeps its sign by a clear margin.
bool may_change_sign(const Polynomial& p);

// What values and slopes at both ends show of a function's sign in between, if its fourth derivative is
// bounded by 384 `margin`: the Bernstein coefficients of the cubic Hermite interpolant, within `margin`.
enum class SignVerdict { no_change, one_change, unclear };
inline SignVerdict hermite_verdict(ValueAndSlope left, ValueAndSlope right, double margin) {
  const double b0 = left.value, b1 = left.value + left.slope / 3.0;
  const double b2 = right.value - right.slope / 3.0, b3 = right.value;
  const double least = std::min(std::min(b0, b1), std::min(b2, b3));
  const double most = std::max(std::max(b0, b1), std::max(b2, b3));
  if (least > margin || most < -margin) return SignVerdict::no_change;
  const double s = b0 > 0.0 ? 1.0 : -1.0;
  // + ? ? -  has one change of sign unless it reads + - + -.
  const bool clear_ends = s * b0 > margin && s * b3 < -margin;
  const bool alternates = s * b1 < margin && s * b2 > -margin;
  return clear_ends && !alternates ? SignVerdict::one_change : SignVerdict::unclear;
}

}  // namespace frahm::periodic
