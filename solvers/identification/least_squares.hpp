#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "solvers/algebra/no_value.hpp"

// Nonlinear least squares within bounds:  minimise sum_i r_i(p)^2,  lower <= p <= upper. Levenberg-Marquardt
// (Eigen's port of MINPACK's lmder), in variables without bounds by MINUIT's transformation p = a + (b - a)
// (sin q + 1) / 2.  Source: [21].
namespace frahm::identification {

struct Unknown {
  std::string name;
  double start = 0.0;  // moved inside the bounds where it is not
  double lower = -kInfinity;
  double upper = kInfinity;
  double scale = 1.0;  // typical size, > 0
};

// Residuals at p, and, unless null, their derivatives (residuals x unknowns). False: there are none at this
// p, and a shorter step is taken. What it throws is passed on.
using Residuals =
    std::function<bool(const Eigen::VectorXd& p, Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian)>;

struct LeastSquaresOptions {
  double tolerance = 1e-12;  // of the step and of the sum of squares, relative; Gauss-Newton steps follow
  int most_evaluations = 200;
};

struct LeastSquaresFit {
  bool converged = false;
  std::string reason;         // a sentence: why it ended
  Eigen::VectorXd p;          // the best met
  Eigen::VectorXd residuals;  // at p
  Eigen::MatrixXd jacobian;   // at p; empty where it does not exist
  std::vector<int> at_bound;  // of each unknown: -1 at its lower, 1 at its upper bound, 0 between
  int iterations = 0;

  double sum_of_squares() const { return residuals.squaredNorm(); }
};

LeastSquaresFit least_squares(const std::vector<Unknown>& unknowns, const Residuals& residuals,
                              const LeastSquaresOptions& options = {});

// Covariance of the unknowns, s^2 (J^T J)^-1 with s^2 = variance of a residual. By the singular values of J
// with its columns scaled; unknowns with a part in a direction without effect have an infinite
// variance, and NaN covariances.
// scales: typical sizes of the unknowns.
Eigen::MatrixXd covariance(const Eigen::MatrixXd& jacobian, double variance, const Eigen::VectorXd& scales);

}  // namespace frahm::identification
