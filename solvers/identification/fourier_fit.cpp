#include "solvers/identification/fourier_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "solvers/identification/linear_fit.hpp"

namespace frahm::identification {
namespace {

using Index = Eigen::Index;
constexpr std::array<int, 8> kHarmonics{1, 3, 5, 9, 15, 25, 35, 49};

Eigen::MatrixXd basis(const Eigen::VectorXd& time, double omega, int harmonics) {
  Eigen::MatrixXd A(time.size(), 2 * harmonics + 1);
  A.col(0).setOnes();
  for (int n = 1; n <= harmonics; ++n) {
    A.col(2 * n - 1) = (n * omega * time.array()).cos();
    A.col(2 * n) = (n * omega * time.array()).sin();
  }
  return A;
}

// dy/domega at the samples.
Eigen::VectorXd by_omega(const Eigen::VectorXd& time, const Eigen::MatrixXd& A, const Eigen::VectorXd& p) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(time.size());
  for (Index n = 1; 2 * n < p.size(); ++n)
    sum += static_cast<double>(n) * (p[2 * n] * A.col(2 * n - 1) - p[2 * n - 1] * A.col(2 * n));
  return sum.cwiseProduct(time);
}

FourierFit fit_of(const Eigen::VectorXd& time, const Eigen::VectorXd& y, double omega, int harmonics) {
  const Eigen::MatrixXd A = basis(time, omega, harmonics);
  // A is nearly orthogonal over a period and more: the normal equations lose no digits.
  const Eigen::LDLT<Eigen::MatrixXd> normal(A.transpose() * A);
  FourierFit fit;
  fit.omega = omega;
  fit.harmonics = harmonics;
  fit.coefficients = normal.solve(A.transpose() * y);
  fit.coefficients += normal.solve(A.transpose() * (y - A * fit.coefficients));  // to the last digit
  fit.fitted = A * fit.coefficients;
  const Scatter s = scatter((y - fit.fitted).squaredNorm(), static_cast<double>(time.size() - A.cols()), 0.0);
  fit.variance = s.variance;
  fit.degrees_of_freedom = s.degrees_of_freedom;
  fit.covariance = s.variance * normal.solve(Eigen::MatrixXd::Identity(A.cols(), A.cols()));
  const Eigen::VectorXd slope = by_omega(time, A, fit.coefficients);
  fit.by_omega = -normal.solve(A.transpose() * slope);
  fit.omega_variance = s.variance / (slope + A * fit.by_omega).squaredNorm();
  return fit;
}

double criterion(const FourierFit& fit, const Eigen::VectorXd& y) {
  constexpr double kEpsilon = 8.0 * std::numeric_limits<double>::epsilon();
  return corrected_akaike((y - fit.fitted).squaredNorm(), y.size(), fit.coefficients.size(),
                          kEpsilon * y.cwiseAbs().maxCoeff());
}

// Gauss-Newton step: uses the part of dy/domega that no change of the coefficients can produce.
double step(const FourierFit& fit, const Eigen::VectorXd& time, const Eigen::VectorXd& y) {
  const Eigen::MatrixXd A = basis(time, fit.omega, fit.harmonics);
  const Eigen::VectorXd own = by_omega(time, A, fit.coefficients) + A * fit.by_omega;
  return own.dot(y - fit.fitted) / own.squaredNorm();
}

FourierFit settle(const Eigen::VectorXd& time, const Eigen::VectorXd& y, double omega, int harmonics) {
  constexpr int kMostSteps = 30;
  constexpr double kSettled = 1e-15;
  FourierFit fit = fit_of(time, y, omega, harmonics);
  for (int i = 0; i < kMostSteps; ++i) {
    const double change = step(fit, time, y);
    const double most = 0.1 * fit.omega;  // a step further than that leaves the cycle
    fit = fit_of(time, y, fit.omega + std::clamp(change, -most, most), harmonics);
    if (std::abs(change) <= kSettled * fit.omega) break;
  }
  return fit;
}

}  // namespace

FourierFit fourier_fit(const Eigen::VectorXd& time, const Eigen::VectorXd& y, double omega) {
  FourierFit best = fit_of(time, y, omega, kHarmonics[0]);
  const double samples_a_period = 2.0 * std::numbers::pi / omega * static_cast<double>(time.size() - 1) /
                                  (time[time.size() - 1] - time[0]);
  double least = criterion(best, y);
  for (std::size_t i = 1; i < kHarmonics.size(); ++i) {
    const int harmonics = kHarmonics[i];
    if (3.0 * harmonics > samples_a_period || time.size() < 4 * harmonics) break;
    FourierFit fit = fit_of(time, y, omega, harmonics);
    const double value = criterion(fit, y);
    if (!(value < least)) break;
    least = value;
    best = std::move(fit);
  }
  return best;
}

FourierFit fourier_fit_from(const Eigen::VectorXd& time, const Eigen::VectorXd& y, double omega) {
  const FourierFit rough = settle(time, y, omega, 1);
  const FourierFit chosen = fourier_fit(time, y, rough.omega);
  return settle(time, y, rough.omega, chosen.harmonics);
}

double crossing_frequency(const Eigen::VectorXd& time, const Eigen::VectorXd& y) {
  constexpr double kBand = 0.3;  // of the amplitude: noise does not cross such a band twice
  const double mean = 0.5 * (y.maxCoeff() + y.minCoeff()), band = 0.5 * kBand * (y.maxCoeff() - y.minCoeff());
  double first = 0.0, last = 0.0;
  int crossings = 0;
  bool below = false;
  for (Index i = 0; i < y.size(); ++i) {
    if (y[i] < mean - band) below = true;
    if (!below || !(y[i] > mean + band)) continue;
    below = false;
    last = time[i];
    if (crossings++ == 0) first = last;
  }
  return crossings < 2 ? 0.0 : 2.0 * std::numbers::pi * (crossings - 1) / (last - first);
}

}  // namespace frahm::identification
