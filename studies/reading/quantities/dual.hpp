#pragma once

#include <cmath>

// Forward-mode differentiation in one direction at a time: a Dual is a + a' eps with eps^2 = 0, so that
// f(a + a' eps) = f(a) + f'(a) a' eps carries the exact derivative through any expression.
//
// One direction rather than a whole gradient: it needs no storage beyond two doubles, and the column of a
// Jacobian for a parameter is one evaluation with a' = 1 for that parameter and 0 for the others.
namespace frahm::studies {

struct Dual {
  double value;
  double derivative;
};

// The chain rule f(a) + f'(a) a'. Where a' = 0 the derivative is 0 even if f'(a) is infinite (sqrt at 0).
inline Dual chain(const Dual& a, double value, double slope) {
  return {value, a.derivative == 0.0 ? 0.0 : slope * a.derivative};
}

inline Dual operator-(const Dual& a) {
  return {-a.value, -a.derivative};
}
inline Dual operator+(const Dual& a, const Dual& b) {
  return {a.value + b.value, a.derivative + b.derivative};
}
inline Dual operator-(const Dual& a, const Dual& b) {
  return {a.value - b.value, a.derivative - b.derivative};
}
inline Dual operator*(const Dual& a, const Dual& b) {
  return {a.value * b.value, a.derivative * b.value + a.value * b.derivative};
}
inline Dual operator/(const Dual& a, const Dual& b) {
  const double quotient = a.value / b.value;
  return {quotient, (a.derivative - quotient * b.derivative) / b.value};
}

inline Dual sqrt(const Dual& a) {
  const double root = std::sqrt(a.value);
  return chain(a, root, 0.5 / root);
}
inline Dual exp(const Dual& a) {
  const double power = std::exp(a.value);
  return chain(a, power, power);
}
inline Dual log(const Dual& a) {
  return chain(a, std::log(a.value), 1.0 / a.value);
}
inline Dual sin(const Dual& a) {
  return chain(a, std::sin(a.value), std::cos(a.value));
}
inline Dual cos(const Dual& a) {
  return chain(a, std::cos(a.value), -std::sin(a.value));
}
inline Dual tan(const Dual& a) {
  const double tangent = std::tan(a.value);
  return chain(a, tangent, 1.0 + tangent * tangent);
}
inline Dual atan(const Dual& a) {
  return chain(a, std::atan(a.value), 1.0 / (1.0 + a.value * a.value));
}

// |a|; at its kink the middle of the two one-sided slopes, 0.
inline Dual abs(const Dual& a) {
  const double sign = a.value > 0.0 ? 1.0 : (a.value < 0.0 ? -1.0 : 0.0);
  return chain(a, std::abs(a.value), sign);
}

// a^b: d(a^b) = b a^(b-1) da + a^b log(a) db. Two separate terms: a constant exponent allows a <= 0.
inline Dual pow(const Dual& a, const Dual& b) {
  const double power = std::pow(a.value, b.value);
  const double by_base =
      a.derivative == 0.0 ? 0.0 : b.value * std::pow(a.value, b.value - 1.0) * a.derivative;
  const double by_exponent = b.derivative == 0.0 ? 0.0 : power * std::log(a.value) * b.derivative;
  return {power, by_base + by_exponent};
}

// The smaller and the larger of two numbers; a NaN on either side gives NaN. At a tie the second counts.
inline double minimum(double a, double b) {
  return std::isnan(a) || a < b ? a : b;
}
inline double maximum(double a, double b) {
  return std::isnan(a) || a > b ? a : b;
}
inline Dual minimum(const Dual& a, const Dual& b) {
  return std::isnan(a.value) || a.value < b.value ? a : b;
}
inline Dual maximum(const Dual& a, const Dual& b) {
  return std::isnan(a.value) || a.value > b.value ? a : b;
}

}  // namespace frahm::studies
