#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "solvers/flow/flow.hpp"

// What the derivative of the period map says: Floquet multipliers and contraction in the energy norm.
namespace frahm::periodic {

// The largest modulus of the eigenvalues of a square matrix: lim ||A^m||^(1/m) (Gelfand), m = 2^squarings.
// There is no iteration that could fail; the error is log(condition of the eigenvectors) / m.
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
  double exponent = 0.0, share = 1.0;  // rho = 2^exponent; powers of two scale without rounding
  for (int done = 0;; done += kBetweenScalings) {
    const double size = A.cwiseAbs().maxCoeff();
    if (!(size > 0.0)) return size;
    if (done >= squarings) return std::exp2(exponent + share * std::log2(size));
    const int scale = std::ilogb(size);
    exponent += share * scale;
    A *= std::ldexp(1.0, -scale);
    for (int k = 0; k < kBetweenScalings; ++k, share *= 0.5) A = (A * A).eval();
  }
}

// The part of a tangent matrix that can contract: the rest positions of permanently stuck contacts, which
// keep any value for ever (multiplier +1), are projected out orthogonally in the energy norm.
template <int N, int H>
typename Sizes<N, H>::StateSquare moving_part(const StepEquations<N, H>& eq,
                                              const typename Sizes<N, H>::StateSquare& tangent,
                                              ContactMask stuck_throughout) {
  if (stuck_throughout == 0) return tangent;
  const Eigen::Index n = eq.masses(), m = eq.contacts();
  Eigen::MatrixXd W(n, __builtin_popcountll(stuck_throughout));
  Eigen::Index column = 0;
  for (Eigen::Index j = 0; j < m; ++j) {
    if (contains(stuck_throughout, j)) W.col(column++) = eq.W.col(j);
  }
  typename Sizes<N, H>::StateSquare projected = tangent;
  const Eigen::MatrixXd on_q = projector_off(eq.K, W), on_v = projector_off(eq.M, W);
  projected.leftCols(n) = (tangent.leftCols(n) * on_q).eval();
  projected.middleCols(n, n) = (tangent.middleCols(n, n) * on_v).eval();
  projected.topRows(n) = (on_q * projected.topRows(n)).eval();
  projected.middleRows(n, n) = (on_v * projected.middleRows(n, n)).eval();
  return projected;
}

// ||A||_E, the largest factor by which a tangent matrix can stretch the energy norm.
template <int N, int H>
double energy_operator_norm(const StepEquations<N, H>& eq, const typename Sizes<N, H>::StateSquare& A) {
  using S = Sizes<N, H>;
  const Eigen::Index n = eq.masses();
  // ||A||_E = ||R A R^-1||_2 with R^T R = blockdiag(K, M, 1/k of the Maxwell elements).
  typename S::StateSquare B = A;
  B.topRows(n) = (eq.K_root * B.topRows(n)).eval();
  B.middleRows(n, n) = (eq.M_root * B.middleRows(n, n)).eval();
  B.leftCols(n) = (B.leftCols(n) * eq.K_root_inverse).eval();
  B.middleCols(n, n) = (B.middleCols(n, n) * eq.M_root_inverse).eval();
  if constexpr (S::kInternal != 0) {
    const Eigen::VectorXd root = eq.internal_stiffness.cwiseSqrt();
    B.bottomRows(root.size()).array().colwise() /= root.array();
    B.rightCols(root.size()).array().rowwise() *= root.transpose().array();
  }
  const typename S::StateSquare gram = B.transpose() * B;
  constexpr int kSquarings = 20;  // symmetric: the error is log(2n) / 2^20, on the low side
  return std::sqrt(spectral_radius(gram, kSquarings));
}

}  // namespace frahm::periodic
