#include "solvers/tuning/problem/nonnegative_least_squares.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <vector>

namespace frahm::tuning {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kDescent = 1e-14;  // of |column| |b|: a slope no larger is rounding
constexpr double kZero = 1e-15;     // of the largest component: no larger is zero

struct System {
  const MatrixXd& A;
  const VectorXd &b, &weight;
};

// The least-squares solution of the passive columns alone, 0 elsewhere.
VectorXd solve_passive(const System& system, const std::vector<Index>& passive) {
  VectorXd x = VectorXd::Zero(system.A.cols());
  if (passive.empty()) return x;
  const Index m = system.A.rows(), p = static_cast<Index>(passive.size());
  MatrixXd columns = MatrixXd::Zero(m + p, p);
  columns.topRows(m) = system.A(Eigen::all, passive);
  columns.bottomRows(p).diagonal() = system.weight(passive);
  VectorXd b = VectorXd::Zero(m + p);
  b.head(m) = system.b;
  x(passive) = columns.colPivHouseholderQr().solve(b);
  return x;
}

// The column whose increase from zero reduces the error most for its length; -1: none.
Index steepest(const System& system, const VectorXd& x, const std::vector<bool>& held) {
  const VectorXd slopes = system.A.transpose() * (system.b - system.A * x);
  Index best = -1;
  double best_slope = kDescent * system.b.norm();
  for (Index j = 0; j < x.size(); ++j) {
    const double length = std::hypot(system.A.col(j).norm(), system.weight[j]);
    if (held[j] || length == 0.0 || slopes[j] <= best_slope * length) continue;
    best = j;
    best_slope = slopes[j] / length;
  }
  return best;
}

// The largest step, at most 1, from x towards the target that keeps the passive components from below zero.
double feasible_step(const VectorXd& x, const VectorXd& target, const std::vector<Index>& passive) {
  double step = 1.0;
  for (const Index k : passive) {
    if (target[k] <= 0.0) step = std::min(step, x[k] / (x[k] - target[k]));
  }
  return step;
}

}  // namespace

VectorXd nonnegative_least_squares(const MatrixXd& A, const VectorXd& b, const VectorXd& weight) {
  const System system{A, b, weight};
  VectorXd x = VectorXd::Zero(A.cols());
  std::vector<Index> passive;                                  // columns with x > 0
  std::vector<bool> held(static_cast<std::size_t>(A.cols()));  // passive, or of no use at this x
  for (Index j = steepest(system, x, held); j >= 0; j = steepest(system, x, held)) {
    held[j] = true;
    passive.push_back(j);
    VectorXd target = solve_passive(system, passive);
    if (target[j] <= 0.0) {  // its slope was rounding: a column that depends on the others
      passive.pop_back();
      continue;
    }
    // From x towards the target as far as every component stays positive; those that reach zero leave.
    while (!passive.empty() && target(passive).minCoeff() <= 0.0) {
      x += feasible_step(x, target, passive) * (target - x);
      std::erase_if(passive, [&](Index k) { return target[k] <= 0.0 && x[k] <= kZero * x.maxCoeff(); });
      target = solve_passive(system, passive);
    }
    x = target;
    std::fill(held.begin(), held.end(), false);
    for (const Index k : passive) held[k] = true;
  }
  return x;
}

}  // namespace frahm::tuning
