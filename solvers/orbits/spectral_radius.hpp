#pragma once

#include <Eigen/Core>
#include <cmath>

namespace frahm::periodic {

// The largest modulus of the eigenvalues of a square matrix: lim ||A^m||^(1/m) (Gelfand), m = 2^squarings.
// No iteration can fail; the error is log(condition of the eigenvectors) / m.
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
    if (done >= squarings) return std::exp2(exponent + share * std::log2(size));
    const int scale = std::ilogb(size);
    exponent += share * scale;
    A *= std::ldexp(1.0, -scale);
    for (int k = 0; k < kBetweenScalings; ++k, share *= 0.5) A = (A * A).eval();
  }
}

}  // namespace frahm::periodic
