#include "solvers/periodic/box_minimum.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <vector>

namespace frahm::periodic {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

struct Step {
  VectorXd direction;  // of the free components
  bool bounded;        // the objective has its minimum at direction * 1; otherwise it falls for ever
};

// From lambda to the minimum over the free components, or along a direction in which G is flat and c is not.
Step step_to_free_minimum(const MatrixXd& G, const VectorXd& c, const VectorXd& weight,
                          const VectorXd& lambda, const std::vector<Index>& free) {
  const auto m = static_cast<Index>(free.size());
  MatrixXd scaled(m, m);
  VectorXd right(m), start(m);
  for (Index i = 0; i < m; ++i) {
    const Index row = free[static_cast<std::size_t>(i)];
    double fixed_part = G.row(row).dot(lambda);
    for (Index k = 0; k < m; ++k) {
      const Index column = free[static_cast<std::size_t>(k)];
      scaled(i, k) = weight[row] * G(row, column) * weight[column];
      fixed_part -= G(row, column) * lambda[column];
    }
    right[i] = weight[row] * (c[row] - fixed_part);
    start[i] = lambda[row] / weight[row];
  }
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> solver;
  solver.setThreshold(1e-11);
  solver.compute(scaled);
  const VectorXd target = solver.solve(right);  // least norm: least sum (lambda / weight)^2
  const VectorXd rest = right - scaled * target;
  const double size = scaled.norm() * target.norm() + right.norm();
  const bool bounded = rest.norm() <= 1e-10 * size;
  Step step{bounded ? VectorXd(target - start) : rest, bounded};
  for (Index i = 0; i < m; ++i) step.direction[i] *= weight[free[static_cast<std::size_t>(i)]];
  return step;
}

}  // namespace

VectorXd box_minimum(const MatrixXd& G, const VectorXd& c, const VectorXd& lower, const VectorXd& upper,
                     const VectorXd& weight) {
  const Index m = c.size();
  VectorXd lambda = VectorXd::Zero(m).cwiseMax(lower).cwiseMin(upper);
  std::vector<bool> is_free(static_cast<std::size_t>(m));
  for (Index j = 0; j < m; ++j) is_free[static_cast<std::size_t>(j)] = lower[j] < upper[j];

  const int most_changes = 20 + 10 * static_cast<int>(m);
  for (int change = 0; change < most_changes; ++change) {
    std::vector<Index> free;
    for (Index j = 0; j < m; ++j) {
      if (is_free[static_cast<std::size_t>(j)]) free.push_back(j);
    }
    if (!free.empty()) {
      const Step step = step_to_free_minimum(G, c, weight, lambda, free);
      double length = step.bounded ? 1.0 : HUGE_VAL;
      Index blocking = -1;
      for (std::size_t i = 0; i < free.size(); ++i) {
        const Index j = free[i];
        const double d = step.direction[static_cast<Index>(i)];
        if (d == 0.0) continue;
        const double room = ((d > 0.0 ? upper[j] : lower[j]) - lambda[j]) / d;
        if (room < length) {
          length = room;
          blocking = j;
        }
      }
      for (std::size_t i = 0; i < free.size(); ++i) {
        lambda[free[i]] += length * step.direction[static_cast<Index>(i)];
      }
      if (blocking >= 0) {
        const bool at_upper =
            std::abs(lambda[blocking] - upper[blocking]) <= std::abs(lambda[blocking] - lower[blocking]);
        lambda[blocking] = at_upper ? upper[blocking] : lower[blocking];
        is_free[static_cast<std::size_t>(blocking)] = false;
        continue;
      }
    }
    // All free components are at their minimum: does a bound hold one back that should move?
    const VectorXd slope = G * lambda - c;
    Index worst = -1;
    double largest = 1e-12 * (c.cwiseAbs().maxCoeff() + 1e-300);
    for (Index j = 0; j < m; ++j) {
      if (is_free[static_cast<std::size_t>(j)] || !(lower[j] < upper[j])) continue;
      const double pull = lambda[j] == upper[j] ? slope[j] : -slope[j];
      if (pull > largest) {
        largest = pull;
        worst = j;
      }
    }
    if (worst < 0) return lambda;
    is_free[static_cast<std::size_t>(worst)] = true;
  }
  return lambda;
}

}  // namespace frahm::periodic
