#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "solvers/branches/branch_map.hpp"

namespace frahm::periodic {

// A place of a branch that has been found.
struct BranchPlace {
  Eigen::VectorXd y;        // (BranchMap)
  Eigen::VectorXd tangent;  // dy/ds of the curve, of length 1
  Eigen::VectorXcd multipliers;
  std::vector<int> events;         // how often each happens
  std::vector<std::size_t> order;  // in which they do
  int newton_iterations = 0;
  bool is_single = true;        // false: a whole family of orbits has this value of the parameter
  bool grazes = false;          // an event only just happens: the map may have a kink here
  bool rests_at_limit = false;  // a contact that sticks throughout: a force nearly reaches its limit
  bool section_is_near_event = false;
  double better_section = 0.0;  // then: omega t [rad] in the middle of the longest stretch without events

  double parameter_rate() const { return tangent[tangent.size() - 1]; }  // dp/ds, scaled
  // Multipliers outside the unit circle; those of undamped motions are on it but for rounding.
  static constexpr double kOutside = 1e-10;
  int unstable() const;
};

// The place where the plane  row . (x - y) = 0  meets the branch, by Newton's method on the bordered system
//   ( dg/dz - 1   g_p ) dy = -(g(z) - z)
//   (      row        )      row . (y0 - y)
// from y. `towards`: its tangent leads there. Nothing where Newton's method fails.
std::optional<BranchPlace> correct(BranchMap& map, const Eigen::VectorXd& y, const Eigen::VectorXd& row,
                                   const Eigen::VectorXd& towards);

// The direction along which the residual of a shot does not change, turned towards another.
Eigen::VectorXd branch_tangent(const Eigen::MatrixXd& derivative, const Eigen::VectorXd& towards);

}  // namespace frahm::periodic
