#include "solvers/tuning/problem/kkt.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "solvers/tuning/problem/nonnegative_least_squares.hpp"

namespace frahm::tuning {
namespace {

constexpr double kNear = 1e-3;  // of the scale: a bound further away than this has no multiplier

// One bound and how its multiplier enters: outward = +1 at an upper bound, -1 at a lower one.
struct Bound {
  std::size_t index = 0;  // of the variable or constraint
  bool of_variable = true;
  double outward = 1.0;
  double slack = 0.0;  // >= 0, relative to the scale
};

void add_near_bounds(double lower, double upper, double value, double scale, Bound bound,
                     std::vector<Bound>& bounds) {
  const auto add = [&](double outward, double slack) {
    if (!(slack <= kNear)) return;
    bound.outward = outward;
    bound.slack = std::max(0.0, slack);
    bounds.push_back(bound);
  };
  add(+1.0, (upper - value) / scale);
  add(-1.0, (value - lower) / scale);
}

std::vector<Bound> near_bounds(const Problem& problem, const Linearization& at) {
  std::vector<Bound> bounds;
  for (std::size_t i = 0; i < problem.variables.size(); ++i) {
    const Variable& v = problem.variables[i];
    add_near_bounds(v.lower, v.upper, at.x[i], v.scale, {i, true}, bounds);
  }
  for (std::size_t j = 0; j < problem.constraints.size(); ++j) {
    const Constraint& c = problem.constraints[j];
    add_near_bounds(c.lower, c.upper, at.values[j], c.scale, {j, false}, bounds);
  }
  return bounds;
}

double complementarity(double multiplier, double lower, double upper, double value) {
  const double bound = multiplier > 0.0 ? upper : lower;
  return std::isfinite(bound) ? std::abs(multiplier * (bound - value)) : -1.0;
}

// Column j is d(g_j / scale_j) / d(x / scale).
Eigen::MatrixXd scaled_gradients(const Problem& problem, const Linearization& at) {
  Eigen::MatrixXd gradients =
      Eigen::MatrixXd::Zero(Eigen::Index(problem.variables.size()), Eigen::Index(problem.constraints.size()));
  for (std::size_t e = 0; e < problem.jacobian.size(); ++e) {
    const auto [j, i] = problem.jacobian[e];
    gradients(Eigen::Index(i), Eigen::Index(j)) =
        at.entries[e] * problem.variables[i].scale / problem.constraints[j].scale;
  }
  return gradients;
}

}  // namespace

double infeasibility(const Problem& problem, const std::vector<double>& values) {
  double worst = 0.0;
  for (std::size_t j = 0; j < problem.constraints.size(); ++j) {
    const Constraint& c = problem.constraints[j];
    worst = std::max(worst, std::max(c.lower - values[j], values[j] - c.upper) / c.scale);
  }
  return worst;
}

double kkt_residual(const Problem& problem, const Linearization& at, const Multipliers& multipliers) {
  std::vector<double> slope = at.gradient;  // dL/dx
  for (std::size_t e = 0; e < problem.jacobian.size(); ++e) {
    const auto [j, i] = problem.jacobian[e];
    slope[i] += multipliers.constraint[j] * at.entries[e];
  }
  double worst = 0.0;
  const auto complementary = [&](double multiplier, double lower, double upper, double value, double scale) {
    if (multiplier == 0.0) return;
    const double product = complementarity(multiplier, lower, upper, value);
    worst = std::max(worst, product < 0.0 ? std::abs(multiplier) * scale : product);
  };
  for (std::size_t i = 0; i < slope.size(); ++i) {
    const Variable& v = problem.variables[i];
    slope[i] += multipliers.upper[i] - multipliers.lower[i];
    worst = std::max(worst, v.scale * std::abs(slope[i]));
    complementary(multipliers.upper[i], v.lower, v.upper, at.x[i], v.scale);
    complementary(-multipliers.lower[i], v.lower, v.upper, at.x[i], v.scale);
  }
  for (std::size_t j = 0; j < problem.constraints.size(); ++j) {
    const Constraint& c = problem.constraints[j];
    complementary(multipliers.constraint[j], c.lower, c.upper, at.values[j], c.scale);
  }
  return worst / problem.objective_scale;
}

// Non-negative least squares for the multipliers mu of all bounds, in scaled units, with a the outward
// gradient:
//   sum_k mu_k a_k = -grad f        stationarity
//   mu_k slack_k   = 0              complementarity
Multipliers least_squares_multipliers(const Problem& problem, const Linearization& at) {
  const std::vector<Bound> bounds = near_bounds(problem, at);
  const Eigen::MatrixXd gradients = scaled_gradients(problem, at);
  const Eigen::Index n = gradients.rows(), count = Eigen::Index(bounds.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, count);
  Eigen::VectorXd b(n), slack(count);
  for (Eigen::Index i = 0; i < n; ++i) {
    b[i] = -at.gradient[std::size_t(i)] * problem.variables[std::size_t(i)].scale / problem.objective_scale;
  }
  for (Eigen::Index k = 0; k < count; ++k) {
    const Bound& bound = bounds[std::size_t(k)];
    const auto index = Eigen::Index(bound.index);
    if (bound.of_variable) {
      A(index, k) = bound.outward;
    } else {
      A.col(k) = bound.outward * gradients.col(index);
    }
    slack[k] = bound.slack;
  }
  const Eigen::VectorXd mu = nonnegative_least_squares(A, b, slack) * problem.objective_scale;

  Multipliers result{std::vector<double>(problem.variables.size()),
                     std::vector<double>(problem.variables.size()),
                     std::vector<double>(problem.constraints.size())};
  for (std::size_t k = 0; k < bounds.size(); ++k) {
    const Bound& bound = bounds[k];
    const double multiplier = mu[Eigen::Index(k)];
    if (bound.of_variable) {
      (bound.outward > 0.0 ? result.upper : result.lower)[bound.index] =
          multiplier / problem.variables[bound.index].scale;
    } else {
      result.constraint[bound.index] += bound.outward * multiplier / problem.constraints[bound.index].scale;
    }
  }
  return result;
}

}  // namespace frahm::tuning
