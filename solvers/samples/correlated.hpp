#pragma once

#include <Eigen/Core>
#include <optional>

namespace frahm::samples {

// Normal numbers of these means and this covariance, a row for each point of the unit cube (points x
// numbers): mean + D R^(1/2) z of standard normal z, covariance = D R D.  Nothing if the
// covariance is not positive semidefinite to rounding, whatever the units.
std::optional<Eigen::MatrixXd> correlated_normals(const Eigen::VectorXd& mean,
                                                  const Eigen::MatrixXd& covariance,
                                                  const Eigen::MatrixXd& unit_points);

}  // namespace frahm::samples
