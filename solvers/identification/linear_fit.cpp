#include "solvers/identification/linear_fit.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "solvers/algebra/no_value.hpp"

namespace frahm::identification {

LinearFit linear_fit(const Eigen::MatrixXd& A, const Eigen::VectorXd& y, const Eigen::VectorXd& sigma) {
  const Eigen::VectorXd weight = sigma.cwiseInverse();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(weight.asDiagonal() * A);
  LinearFit fit;
  fit.p = qr.solve(weight.cwiseProduct(y));
  // dp/dy = R^-1 Q^T diag(1/sigma)
  const Eigen::Index n = A.cols();
  Eigen::MatrixXd thin = qr.householderQ() * Eigen::MatrixXd::Identity(A.rows(), n);
  fit.influence = qr.matrixR().topLeftCorner(n, n).triangularView<Eigen::Upper>().solve(
      Eigen::MatrixXd(thin.transpose()));
  fit.influence = qr.colsPermutation() * fit.influence * weight.asDiagonal();
  fit.residuals = y - A * fit.p;
  fit.chi_squared = weight.cwiseProduct(fit.residuals).squaredNorm();
  fit.degrees_of_freedom = static_cast<double>(A.rows() - n);
  return fit;
}

double corrected_akaike(double rss, Eigen::Index data, Eigen::Index unknowns, double rounding) {
  const auto n = static_cast<double>(data), k = static_cast<double>(unknowns) + 1.0;  // and the variance
  if (!(n - k - 1.0 > 0.0)) return kInfinity;
  // AICc = n ln(rss / n) + 2 k + 2 k (k + 1) / (n - k - 1)
  return n * std::log(std::max(rss / n, rounding * rounding)) + 2.0 * k + 2.0 * k * (k + 1.0) / (n - k - 1.0);
}

Scatter scatter(double chi_squared, double degrees_of_freedom, double data_degrees_of_freedom) {
  const bool few = degrees_of_freedom < kFewResiduals;
  if (few && data_degrees_of_freedom > 0.0) return {1.0, data_degrees_of_freedom};
  if (degrees_of_freedom > 0.0) return {chi_squared / degrees_of_freedom, degrees_of_freedom};
  return {kNone, 0.0};
}

}  // namespace frahm::identification
