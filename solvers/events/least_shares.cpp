#include "solvers/events/least_shares.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/algebra/null_space.hpp"
#include "solvers/algebra/shortest_solution.hpp"

namespace frahm::periodic {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// All x with W x = 0, in columns; a contact in no loop has no part in them, not even by rounding.
MatrixXd loops_of(const MatrixXd& W) {
  constexpr double kRounding = 1e-12;
  MatrixXd loops = algebra::null_space(W);
  for (Index j = 0; j < loops.rows(); ++j) {
    if (loops.row(j).norm() <= kRounding * loops.norm()) loops.row(j).setZero();
  }
  return loops;
}

// Along these directions to the least sum (lambda_j / weight_j)^2.
VectorXd step_to_least(MatrixXd directions, const VectorXd& lambda, const VectorXd& weight) {
  MatrixXd counted = weight.cwiseInverse().asDiagonal() * directions;
  for (Index k = 0; k < counted.cols(); ++k) {
    const double size = counted.col(k).norm();
    counted.col(k) /= size;
    directions.col(k) /= size;
  }
  return directions * algebra::shortest_solution(counted, -lambda.cwiseQuotient(weight));
}

// The place in `active` of the bound that holds its contact back most against the sum's fall; -1 if none
// does. With x = lambda / weight and the loops' rows Y_j = L_j / weight_j:  Y^T x = -sum_A nu_j sigma_j
// Y_j^T, nu_j >= 0 where a bound is needed.
std::ptrdiff_t needless(const std::vector<Index>& active, const MatrixXd& loops, const VectorXd& lambda,
                        const VectorXd& weight) {
  constexpr double kRounding = 1e-10;
  const MatrixXd Y = weight.cwiseInverse().asDiagonal() * loops;
  const VectorXd pull = algebra::shortest_solution(MatrixXd(Y(active, Eigen::all).transpose()),
                                                   -(Y.transpose() * lambda.cwiseQuotient(weight)));
  std::ptrdiff_t worst = -1;
  double most = kRounding * (1.0 + pull.cwiseAbs().maxCoeff());
  for (std::size_t i = 0; i < active.size(); ++i) {
    const double against = -pull[static_cast<Index>(i)] * (lambda[active[i]] > 0.0 ? 1.0 : -1.0);
    if (against <= most) continue;
    most = against;
    worst = static_cast<std::ptrdiff_t>(i);
  }
  return worst;
}

}  // namespace

LeastShares least_shares(const MatrixXd& W, const VectorXd& start, const VectorXd& bound,
                         const VectorXd& weight) {
  LeastShares shares{start, {}};
  VectorXd& lambda = shares.lambda;
  std::vector<Index>& active = shares.bound;
  const MatrixXd loops = loops_of(W);
  if (loops.cols() == 0) return shares;
  const Index m = start.size();
  const int most_changes = 20 + 10 * static_cast<int>(m);
  for (int change = 0; change < most_changes; ++change) {
    const MatrixXd directions = loops * algebra::null_space(MatrixXd(loops(active, Eigen::all)));
    if (directions.cols() > 0) {
      const VectorXd step = step_to_least(directions, lambda, weight);
      double length = 1.0;
      Index blocking = -1;
      for (Index j = 0; j < m; ++j) {
        if (loops.row(j).isZero(0.0) || std::ranges::find(active, j) != active.end()) continue;
        const double ahead = step[j] > 0.0 ? bound[j] - lambda[j] : bound[j] + lambda[j];
        if (std::abs(step[j]) * length <= ahead) continue;
        length = std::max(0.0, ahead / std::abs(step[j]));
        blocking = j;
      }
      lambda += length * step;
      if (blocking >= 0) {
        lambda[blocking] = step[blocking] > 0.0 ? bound[blocking] : -bound[blocking];
        active.push_back(blocking);
        continue;
      }
    }
    if (active.empty()) break;
    const std::ptrdiff_t free = needless(active, loops, lambda, weight);
    if (free < 0) break;
    active.erase(active.begin() + free);
  }
  return shares;
}

}  // namespace frahm::periodic
