#include "solvers/samples/correlated.hpp"

#include <cmath>

#include "solvers/algebra/symmetric_modes.hpp"
#include "solvers/samples/elementary.hpp"

namespace frahm::samples {

std::optional<Eigen::MatrixXd> correlated_normals(const Eigen::VectorXd& mean,
                                                  const Eigen::MatrixXd& covariance,
                                                  const Eigen::MatrixXd& unit_points) {
  constexpr double kRounding = 1e-10;  // of the correlations
  if (!covariance.allFinite() || (covariance.diagonal().array() < 0.0).any()) return std::nullopt;
  // For the correlation, so that no unit counts: covariance = D R D.
  const Eigen::VectorXd deviation = covariance.diagonal().cwiseSqrt();
  const Eigen::VectorXd inverse = (deviation.array() > 0.0).select(deviation.cwiseInverse(), 0.0);
  const Eigen::MatrixXd correlation = inverse.asDiagonal() * covariance * inverse.asDiagonal();
  const algebra::SymmetricModes modes = algebra::symmetric_modes(correlation);
  if ((modes.values.array() < -kRounding).any()) return std::nullopt;
  // The root R^(1/2) = V sqrt(lambda) V^T: there is one alone, which rounding of R hardly changes, where a
  // triangular one would take another order of its rows.
  const Eigen::MatrixXd root =
      modes.vectors * modes.values.cwiseMax(0.0).cwiseSqrt().asDiagonal() * modes.vectors.transpose();
  const Eigen::MatrixXd z = unit_points.unaryExpr([](double share) { return standard_normal(share); });
  return (z * root * deviation.asDiagonal()).rowwise() + mean.transpose();
}

}  // namespace frahm::samples
