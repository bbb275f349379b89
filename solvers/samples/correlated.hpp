#pragma once

#include <Eigen/Core>
#include <optional>

namespace frahm::samples {

// Normal numbers of these means and this covariance, a row for each point of the unit cube (points x
// numbers): mean + L z of standard normal z, covariance = L L^T by Cholesky with pivots.  Nothing if the
// covariance is not positive semidefinite to rounding, whatever the units.
std::optional<Eigen::MatrixXd> correlated_normals(const Eigen::VectorXd& mean,
                                                  const Eigen::MatrixXd& covariance,
                                                  const Eigen::MatrixXd& unit_points);

}  // namespace frahm::samples
