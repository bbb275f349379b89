#include "solvers/nonstop/sliding_modes.hpp"

#include <Eigen/LU>
#include <cmath>

#include "solvers/algebra/no_value.hpp"
#include "solvers/algebra/solve.hpp"
#include "solvers/algebra/spectrum.hpp"
#include "solvers/algebra/symmetric_modes.hpp"

namespace frahm::periodic::nonstop {
namespace {

// q' = v,  v' = M^-1 (-K q - C v - D s),  s' = k D^T v - rate s.
Eigen::MatrixXd state_matrix(const mechanics::LinearSystem& system) {
  const Eigen::Index n = system.masses(), s = system.internal_forces();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n + s, 2 * n + s);
  A.block(0, n, n, n).setIdentity();
  A.block(n, 0, n, n) = -algebra::solve_positive(system.M, system.K);
  A.block(n, n, n, n) = -algebra::solve_positive(system.M, system.C);
  if (s == 0) return A;
  A.block(n, 2 * n, n, s) = -algebra::solve_positive(system.M, system.D);
  A.block(2 * n, n, s, n) = system.internal_stiffness.asDiagonal() * system.D.transpose();
  A.block(2 * n, 2 * n, s, s).diagonal() = -system.internal_rate;
  return A;
}

// R with R^T R = blockdiag(K, M, 1/k).
Eigen::MatrixXd energy_root(const mechanics::LinearSystem& system) {
  const Eigen::Index n = system.masses(), s = system.internal_forces();
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(2 * n + s, 2 * n + s);
  R.topLeftCorner(n, n) = algebra::upper_root(system.K);
  R.block(n, n, n, n) = algebra::upper_root(system.M);
  R.diagonal().tail(s) = system.internal_stiffness.cwiseSqrt().cwiseInverse();
  return R;
}

// sigma_max / sigma_min, by the eigenvalues of A^T A, and so to about 1e7 at most; infinite beyond.
double condition_of(const Eigen::MatrixXd& A) {
  const Eigen::VectorXd squares = algebra::symmetric_modes(A.transpose() * A).values;
  const double most = squares[squares.size() - 1], least = squares[0];
  return least > 1e-14 * most ? std::sqrt(most / least) : kInfinity;
}

}  // namespace

// In coordinates R y the undamped part of A is skew and its eigenvectors orthogonal.
SlidingModes sliding_modes(const mechanics::LinearSystem& system) {
  SlidingModes result;
  const Eigen::MatrixXd root = energy_root(system);
  const Eigen::MatrixXd back = algebra::inverse(root);
  const algebra::Spectrum spectrum = algebra::spectrum(root * state_matrix(system) * back);
  if (!spectrum.values.allFinite()) {
    result.condition = kInfinity;
    return result;
  }
  const Eigen::Index D = spectrum.values.size();
  Eigen::Index M = 0;
  for (Eigen::Index i = 0; i < D; ++i) M += spectrum.values[i].imag() >= 0.0 ? 1 : 0;
  result.lambda.resize(M);
  result.vectors.resize(D, M);
  result.left.resize(M, D);
  result.norms.resize(M);
  result.to_energy.resize(D, D);
  Eigen::Index mode = 0, column = 0;
  for (Eigen::Index i = 0; i < D; ++i) {
    if (spectrum.values[i].imag() < 0.0) continue;
    const bool is_pair = spectrum.values[i].imag() > 0.0;
    const auto vector = spectrum.vectors.col(i);
    result.lambda[mode] = spectrum.values[i];
    result.is_pair.push_back(is_pair ? 1 : 0);
    result.vectors.col(mode) = back * vector;
    result.left.row(mode) = (is_pair ? 2.0 : 1.0) * (spectrum.inverse.row(i) * root);
    result.norms[mode] = std::sqrt(0.5) * vector.norm();
    result.to_energy.col(column++) = vector.real();
    if (is_pair) result.to_energy.col(column++) = -vector.imag();
    ++mode;
  }
  result.condition = spectrum.inverse.allFinite() ? condition_of(result.to_energy) : kInfinity;
  if (std::isfinite(result.condition)) result.from_energy = algebra::inverse(result.to_energy);
  return result;
}

}  // namespace frahm::periodic::nonstop
