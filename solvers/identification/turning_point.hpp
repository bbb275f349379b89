#pragma once

#include <Eigen/Core>

#include "solvers/algebra/no_value.hpp"

// One turning point of a measured free vibration, from the samples about it.
namespace frahm::identification {

// The samples over about a quarter period on either side.
struct Quarters {
  double at = 0.0, radian = 0.0;  // [s] a sample near the turn; the time in which the phase grows by one
  double decrease = 0.0;          // delta, free vibration being exp(-delta s) cos s
  Eigen::VectorXd phase, x;       // (t - at) / radian, [m]
};

struct TurningPoint {
  bool converged = false;
  double phase = 0.0, x = 0.0;       // of the turn, [m]
  double rss = 0.0, rounding = 0.0;  // [m^2], [m]
  Eigen::Matrix2d cofactor;          // of x and phase, for samples of variance 1
  double criterion = kInfinity;
  Eigen::VectorXd before, after;  // coefficients of phi_2, phi_3 ... on the two sides
  Eigen::Index unknowns = 0;
};

// x = X + a_2 phi_2(s) + a_3 phi_3(s) + ..., s = phase - turn; after the turn b_2 phi_2 + ... is added:
// friction makes the acceleration and its derivatives jump there. The shapes are those of a mass on a spring
// with a damper: phi_2 = 1 - exp(-delta s) (cos s + delta sin s), then phi_k' = phi_{k-1}. So a_2 and b_2
// suffice for a mass with friction on a known damper; a_3 corrects an error of delta, a_4 one of the
// frequency. These are always fitted: a term left out moves the turn by as much as noise that hides the term;
// a_4 only with eight samples or more. Akaike's corrected criterion chooses how many more there are.
// Not converged: samples too few, fewer than two on a side or six in all, or that do not turn.
TurningPoint turning_point(const Quarters& quarters);

}  // namespace frahm::identification
