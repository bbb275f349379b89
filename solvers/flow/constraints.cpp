#include "solvers/flow/constraints.hpp"

#include <vector>

#include "solvers/algebra/shortest_solution.hpp"
#include "solvers/algebra/solve.hpp"
#include "solvers/algebra/symmetric_modes.hpp"

namespace frahm::periodic {
namespace {

// The case in which all weights are positive. In coordinates in which G has a diagonal of ones, a solution
// is found without the weights, which may differ much in size; these share only the free part, G Z = 0:
//   G^+ = Q G0^+ Q^T,  Q = 1 - Z H,  H x the least squares solution c of (Z c) / weight = x / weight.
Eigen::MatrixXd pseudo_inverse_of(const Eigen::MatrixXd& G, const Eigen::VectorXd& weight) {
  constexpr double kDependent = 1e-11;  // of the largest: below, a direction depends on the others
  const Eigen::Index m = G.rows();
  const Eigen::VectorXd size = G.diagonal().cwiseSqrt().cwiseInverse();
  const algebra::SymmetricModes modes = algebra::symmetric_modes(size.asDiagonal() * G * size.asDiagonal());
  Eigen::Index dependent = 0;  // the values ascend
  while (dependent < m && modes.values[dependent] <= kDependent * modes.values[m - 1]) ++dependent;
  const Eigen::MatrixXd serving = size.asDiagonal() * modes.vectors.rightCols(m - dependent);
  const Eigen::MatrixXd any =
      serving * modes.values.tail(m - dependent).cwiseInverse().asDiagonal() * serving.transpose();
  if (dependent == 0) return any;
  Eigen::MatrixXd Z = size.asDiagonal() * modes.vectors.leftCols(dependent);
  for (Eigen::Index j = 0; j < m; ++j) {
    constexpr double kRounding = 1e-12;  // of a vector of length 1: this one is in no loop
    if (modes.vectors.row(j).head(dependent).norm() < kRounding) Z.row(j).setZero();
  }
  const Eigen::MatrixXd per_weight = weight.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd Q =
      Eigen::MatrixXd::Identity(m, m) - Z * algebra::shortest_solutions(per_weight * Z, per_weight);
  return Q * any * Q.transpose();
}

}  // namespace

Eigen::MatrixXd weighted_pseudo_inverse(const Eigen::MatrixXd& G, const Eigen::VectorXd& weight) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index j = 0; j < weight.size(); ++j) {
    if (weight[j] > 0.0 && G(j, j) > 0.0) kept.push_back(j);
  }
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(G.rows(), G.cols());
  if (kept.size() == 1) result(kept[0], kept[0]) = 1.0 / G(kept[0], kept[0]);
  if (kept.size() > 1) result(kept, kept) = pseudo_inverse_of(G(kept, kept), weight(kept));
  return result;
}

Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& G) {
  if (G.size() == 0) return G;
  return algebra::solve_positive(G, Eigen::MatrixXd(Eigen::MatrixXd::Identity(G.rows(), G.cols())));
}

}  // namespace frahm::periodic
