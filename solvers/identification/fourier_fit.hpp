#pragma once

#include <Eigen/Core>
#include <vector>

// A Fourier series of one frequency through samples of a periodic motion.
namespace frahm::identification {

// y(t) = a_0 + sum_n a_n cos(n omega t) + b_n sin(n omega t), n = 1 ... harmonics, t from the origin given.
struct FourierFit {
  double omega = 0.0;  // [rad/s]
  int harmonics = 0;
  Eigen::VectorXd coefficients;  // a_0, a_1, b_1, a_2, b_2 ...
  Eigen::MatrixXd covariance;    // of them, at this omega
  Eigen::VectorXd by_omega;      // how they change with omega
  Eigen::VectorXd fitted;        // at the samples
  double variance = 0.0;         // of the residuals; NaN without degrees of freedom
  double degrees_of_freedom = 0.0;
  double omega_variance = 0.0;  // of omega, from these samples alone

  double a(int n) const { return coefficients[n == 0 ? 0 : 2 * n - 1]; }
  double b(int n) const { return coefficients[2 * n]; }
};

// Least squares at a given omega, with as many harmonics as Akaike's corrected criterion prefers: an odd
// number, as a symmetric motion has odd harmonics only.
// time [s] from an origin near its middle.
FourierFit fourier_fit(const Eigen::VectorXd& time, const Eigen::VectorXd& y, double omega);

// The same with omega fitted, from a start that is right to a fraction of a cycle over the record.
FourierFit fourier_fit_from(const Eigen::VectorXd& time, const Eigen::VectorXd& y, double omega);

// Omega from the mean's upward crossings; 0: there are fewer than two.
double crossing_frequency(const Eigen::VectorXd& time, const Eigen::VectorXd& y);

}  // namespace frahm::identification
