#include "solvers/samples/correlated.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "solvers/samples/distribution.hpp"

namespace frahm::samples {

std::optional<Eigen::MatrixXd> correlated_normals(const Eigen::VectorXd& mean,
                                                  const Eigen::MatrixXd& covariance,
                                                  const Eigen::MatrixXd& unit_points) {
  constexpr double kRounding = 1e-10;  // of the correlations
  if (!covariance.allFinite() || (covariance.diagonal().array() < 0.0).any()) return std::nullopt;
  // Of the correlation, so that no unit counts: covariance = D R D.
  const Eigen::VectorXd deviation = covariance.diagonal().cwiseSqrt();
  const Eigen::VectorXd inverse = (deviation.array() > 0.0).select(deviation.cwiseInverse(), 0.0);
  const Eigen::MatrixXd correlation = inverse.asDiagonal() * covariance * inverse.asDiagonal();
  const Eigen::LDLT<Eigen::MatrixXd> cholesky(correlation);
  if ((cholesky.vectorD().array() < -kRounding).any()) return std::nullopt;
  // R = P^T L S (P^T L S)^T with S = sqrt(D).
  Eigen::MatrixXd factor = cholesky.matrixL();
  factor *= cholesky.vectorD().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  factor = cholesky.transpositionsP().transpose() * factor;
  const Eigen::MatrixXd z = unit_points.unaryExpr([](double share) { return standard_normal(share); });
  return (z * factor.transpose() * deviation.asDiagonal()).rowwise() + mean.transpose();
}

}  // namespace frahm::samples
