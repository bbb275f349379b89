#pragma once

namespace frahm::mechanics {

// A number and its derivative along one direction.
struct Dual {
  double value = 0.0, derivative = 0.0;

  friend constexpr Dual operator*(Dual a, Dual b) {
    return {a.value * b.value, a.derivative * b.value + a.value * b.derivative};
  }
  // q = a / b:  dq = (da - q db) / b
  friend constexpr Dual operator/(Dual a, Dual b) {
    const double quotient = a.value / b.value;
    return {quotient, (a.derivative - quotient * b.derivative) / b.value};
  }
};

}  // namespace frahm::mechanics
