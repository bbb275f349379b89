#include "solvers/tuning/variance/lyapunov.hpp"

#include <Eigen/Core>
#include <complex>

namespace frahm::tuning {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

constexpr int kRefinements = 2;  // each removes the rounding of the solve from the last residual

// Y of T Y + Y T^H + W = 0, the columns from the last to the first:
//   (T + conj(T_kk)) y_k = -w_k - sum_{j > k} y_j conj(T_kj)
MatrixXcd solve_triangular(const MatrixXcd& T, const MatrixXcd& W) {
  const Index size = T.rows();
  MatrixXcd Y = -W, shifted = T;
  for (Index k = size - 1; k >= 0; --k) {
    for (Index j = k + 1; j < size; ++j) Y.col(k) -= Y.col(j) * std::conj(T(k, j));
    shifted.diagonal() = T.diagonal().array() + std::conj(T(k, k));
    shifted.triangularView<Eigen::Upper>().solveInPlace(Y.col(k));
  }
  return Y;
}

// Y of T^H Y + Y T + W = 0, the columns from the first to the last:
//   (T^H + T_kk) y_k = -w_k - sum_{j < k} y_j T_jk
MatrixXcd solve_triangular_adjoint(const MatrixXcd& T, const MatrixXcd& W) {
  const Index size = T.rows();
  MatrixXcd Y = -W, shifted = T.adjoint();
  for (Index k = 0; k < size; ++k) {
    for (Index j = 0; j < k; ++j) Y.col(k) -= Y.col(j) * T(j, k);
    shifted.diagonal() = T.diagonal().conjugate().array() + T(k, k);
    shifted.triangularView<Eigen::Lower>().solveInPlace(Y.col(k));
  }
  return Y;
}

// U^H R U
MatrixXcd in_schur_basis(const MatrixXcd& U, const MatrixXd& R) {
  const MatrixXcd right = R.cast<std::complex<double>>() * U;
  return U.adjoint() * right;
}

// The symmetric part of U Y U^H, which is real but for rounding.
MatrixXd from_schur_basis(const MatrixXcd& U, const MatrixXcd& Y) {
  const MatrixXcd right = Y * U.adjoint();
  const MatrixXcd P = U * right;
  return 0.5 * (P.real() + P.real().transpose());
}

// A P + P A^T + W
MatrixXd residual(const MatrixXd& A, const MatrixXd& P, const MatrixXd& W) {
  MatrixXd R = W;
  R.noalias() += A * P;
  R.noalias() += P * A.transpose();
  return R;
}

}  // namespace

Lyapunov::Lyapunov(const MatrixXd& A) : A_(A), schur_(algebra::schur(A)) {}

double Lyapunov::abscissa() const {
  const Eigen::VectorXcd eigenvalues = schur_.T.diagonal();
  return eigenvalues.real().maxCoeff() / eigenvalues.cwiseAbs().maxCoeff();
}

MatrixXd Lyapunov::solve(const MatrixXd& W) const {
  MatrixXd P = MatrixXd::Zero(A_.rows(), A_.cols());
  for (int round = 0; round <= kRefinements; ++round) {
    const MatrixXcd R = in_schur_basis(schur_.U, residual(A_, P, W));
    P += from_schur_basis(schur_.U, solve_triangular(schur_.T, R));
  }
  return P;
}

MatrixXd Lyapunov::solve_adjoint(const MatrixXd& W) const {
  const MatrixXd transposed = A_.transpose();
  MatrixXd Q = MatrixXd::Zero(A_.rows(), A_.cols());
  for (int round = 0; round <= kRefinements; ++round) {
    const MatrixXcd R = in_schur_basis(schur_.U, residual(transposed, Q, W));
    Q += from_schur_basis(schur_.U, solve_triangular_adjoint(schur_.T, R));
  }
  return Q;
}

}  // namespace frahm::tuning
