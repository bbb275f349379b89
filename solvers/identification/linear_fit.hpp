#pragma once

#include <Eigen/Core>

// Linear least squares, and how errors of the data affect the unknowns.
namespace frahm::identification {

struct LinearFit {
  Eigen::VectorXd p;
  Eigen::MatrixXd influence;  // dp/dy, unknowns x data
  Eigen::VectorXd residuals;  // y - A p
  double chi_squared = 0.0;   // sum of (residual / sigma)^2
  double degrees_of_freedom = 0.0;
};

// y = A p, weighed by 1 / sigma. A: data x unknowns, of full rank; sigma > 0, or relative sizes of it.
LinearFit linear_fit(const Eigen::MatrixXd& A, const Eigen::VectorXd& y, const Eigen::VectorXd& sigma);

// Akaike's criterion corrected for few data (source [26]): the model of least value predicts best. Of `data`
// residuals whose squares sum to `rss`, by a model of `unknowns` coefficients; infinite for too few data.
// rounding: standard deviation of the residuals that rounding leaves for exact data; no model is better.
double corrected_akaike(double rss, Eigen::Index data, Eigen::Index unknowns, double rounding);

// The variance that scales squared standard errors, and the degrees of freedom behind it.
struct Scatter {
  double variance = 0.0, degrees_of_freedom = 0.0;
};
// From the residuals; if there are fewer than kFewResiduals, from the standard errors of the data where these
// are known (their degrees of freedom; 0: not known). NaN and 0: unknown.
Scatter scatter(double chi_squared, double degrees_of_freedom, double data_degrees_of_freedom);
inline constexpr double kFewResiduals = 4.0;  // Student's t is then below 3

}  // namespace frahm::identification
