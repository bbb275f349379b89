#include "solvers/events/box_minimum.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "solvers/flow/constraints.hpp"

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
  const MatrixXd G_free = G(free, free);
  const VectorXd weight_free = weight(free), start = lambda(free);
  const VectorXd right = c(free) - G(free, Eigen::all) * lambda + G_free * start;
  const MatrixXd inverse = weighted_pseudo_inverse(G_free, weight_free);
  VectorXd target = inverse * right;  // of least sum (lambda / weight)^2
  target += inverse * (right - G_free * target);
  const VectorXd rest = right - G_free * target;
  const VectorXd size = G_free.cwiseAbs() * target.cwiseAbs() + right.cwiseAbs();
  // Rounding of the others reaches a contact that nothing pulls at.
  const double rounding = 1e-14 * size.maxCoeff();
  if ((rest.array().abs() <= 1e-10 * size.array() + rounding).all()) return {target - start, true};
  return {weight_free.cwiseAbs2().cwiseProduct(rest), false};
}

}  // namespace

BoxMinimum box_minimum(const MatrixXd& G, const VectorXd& c, const VectorXd& lower, const VectorXd& upper,
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
    // All free components are at their minimum: does a bound hold a component that should move?
    const VectorXd slope = G * lambda - c;
    const double rounding = 1e-12 * (c.cwiseAbs() + G.cwiseAbs() * lambda.cwiseAbs()).maxCoeff();
    Index worst = -1;
    double largest = rounding + 1e-300;
    for (Index j = 0; j < m; ++j) {
      if (is_free[static_cast<std::size_t>(j)] || !(lower[j] < upper[j])) continue;
      const double pull = lambda[j] == upper[j] ? slope[j] : -slope[j];
      if (pull > largest) {
        largest = pull;
        worst = j;
      }
    }
    if (worst < 0) return {lambda, true};
    is_free[static_cast<std::size_t>(worst)] = true;
  }
  return {lambda, false};
}

}  // namespace frahm::periodic
