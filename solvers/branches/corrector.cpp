#include "solvers/branches/corrector.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

namespace frahm::periodic {
namespace {

Eigen::MatrixXd bordered(const Eigen::MatrixXd& derivative, const Eigen::VectorXd& row) {
  Eigen::MatrixXd A(derivative.cols(), derivative.cols());
  A << derivative, row.transpose();
  return A;
}

// Whether the orbits next to this one form a curve. The columns are brought to one size: at a resonance that
// of the parameter is very large.
bool is_curve(const Eigen::MatrixXd& derivative, const Eigen::VectorXd& tangent) {
  constexpr double kRounding = 1e-14;  // a branch up to a peak of 1e9 was seen at 4e-13
  const Eigen::MatrixXd A = bordered(derivative, tangent).colwise().normalized();
  return A.partialPivLu().rcond() > kRounding;
}

}  // namespace

int BranchPlace::unstable() const {
  return static_cast<int>((multipliers.array().abs() > 1.0 + kOutside).count());
}

Eigen::VectorXd branch_tangent(const Eigen::MatrixXd& derivative, const Eigen::VectorXd& towards) {
  const Eigen::VectorXd last = Eigen::VectorXd::Unit(derivative.cols(), derivative.cols() - 1);
  return bordered(derivative, towards).partialPivLu().solve(last).normalized();
}

std::optional<BranchPlace> correct(BranchMap& map, const Eigen::VectorXd& start, const Eigen::VectorXd& row,
                                   const Eigen::VectorXd& towards) {
  constexpr int kMostIterations = 12;
  constexpr double kAtLimit = 1e-4;                          // of the force
  constexpr double kTolerance = 1e-13, kGoodEnough = 1e-11;  // of the relative residual (ShootingOptions)
  Eigen::VectorXd y = start;
  double before = HUGE_VAL;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    const Shot shot = map.shoot(y);
    if (shot.failed) return std::nullopt;
    const double size = std::max(1.0, y.head(y.size() - 1).norm());
    const double residual = shot.residual.norm() / size;
    const bool no_better = residual > 0.25 * before;
    if (residual <= kTolerance || (residual <= kGoodEnough && no_better)) {
      BranchPlace place;
      place.y = y;
      place.newton_iterations = iteration;
      const auto section = map.better_section(shot);
      place.section_is_near_event = section.has_value();
      place.better_section = section.value_or(0.0);
      place.tangent = branch_tangent(shot.derivative, towards);
      if (!place.tangent.allFinite()) return std::nullopt;
      place.grazes = shot.passage.margin < kGrazing;
      place.rests_at_limit = shot.stuck_throughout != 0 && shot.passage.margin < kAtLimit;
      place.is_single = is_curve(shot.derivative, place.tangent);
      place.multipliers = map.multipliers(shot);
      place.events = count_events(map.flow(), shot.passage);
      place.order = list_events(map.flow(), shot.passage);
      return place;
    }
    if (iteration > 3 && residual > 2.0 * before) return std::nullopt;
    before = residual;
    Eigen::VectorXd right(y.size());
    right << -shot.residual, row.dot(start - y);
    y += bordered(shot.derivative, row).partialPivLu().solve(right);
    if (!y.allFinite()) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace frahm::periodic
