#pragma once

#include <Eigen/Core>
#include <cmath>

namespace frahm::periodic {

// The larger modulus of the roots of x^2 - sum x + product, which leave (sum/2)^2 - product = `under`.
inline double larger_root(double half_sum, double under, double product) {
  return under < 0.0 ? std::sqrt(product) : std::abs(half_sum) + std::sqrt(under);
}

// The largest modulus of the eigenvalues of a square matrix, by A^m, m = 2^squarings: two eigenvalues of
// largest modulus have its trace and half of trace^2 - trace(A^2m) as their sum and product. No iteration can
// fail; the error is 1/m of what the others add to these, log(their number) / m at most.
template <class Square>
double spectral_radius(Square A, int squarings = 36) {
  if constexpr (Square::RowsAtCompileTime == 2) {
    // x^2 - trace x + det = 0; (trace/2)^2 - det written so that no digits cancel.
    const double half_trace = 0.5 * (A(0, 0) + A(1, 1)), half_difference = 0.5 * (A(0, 0) - A(1, 1));
    const double discriminant = half_difference * half_difference + A(0, 1) * A(1, 0);
    if (discriminant >= 0.0) return std::abs(half_trace) + std::sqrt(discriminant);
    return std::hypot(half_trace, std::sqrt(-discriminant));
  }
  constexpr int kBetweenScalings = 4;  // squarings that neither over- nor underflow
  constexpr double kNothing = 1e-290;  // below, a power of two that scales it is infinite
  double exponent = 0.0, share = 1.0;  // rho = 2^exponent; powers of two scale without rounding
  for (int done = 0;; done += kBetweenScalings) {
    const double size = A.cwiseAbs().maxCoeff();
    if (!(size > kNothing)) return size;
    if (done >= squarings) {
      const Square once = A / size;
      const double trace = once.trace(), product = 0.5 * (trace * trace - (once * once).trace());
      const double largest = larger_root(0.5 * trace, 0.25 * trace * trace - product, product);
      // For a defective matrix both may be rounding; the norm's own root is right then.
      const double power = largest > 1e-8 ? largest * size : size;
      return std::exp2(exponent + share * std::log2(power));
    }
    const int scale = std::ilogb(size);
    exponent += share * scale;
    A *= std::ldexp(1.0, -scale);
    for (int k = 0; k < kBetweenScalings; ++k, share *= 0.5) A = (A * A).eval();
  }
}

}  // namespace frahm::periodic
