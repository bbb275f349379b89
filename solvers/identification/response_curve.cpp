#include "solvers/identification/response_curve.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/algebra/no_value.hpp"
#include "solvers/identification/linear_fit.hpp"
#include "solvers/identification/statement.hpp"

namespace frahm::identification {
namespace {

using Index = Eigen::Index;
constexpr Index kHighestDegree = 12;
constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();

// The points about the highest one, contiguous, with X > kPeakPart X_max and the next on either side, in the
// terms of the fit: z = (omega^2 - middle) / half in [-1, 1], X over X_max.
struct Window {
  std::size_t first = 0, size = 0;
  double middle = 0.0, half = 1.0, most = 0.0;
  Eigen::VectorXd z, X;
};

Window window_of(const ResponseCurve& curve) {
  const auto& X = curve.amplitude;
  const auto top = static_cast<std::size_t>(std::max_element(X.begin(), X.end()) - X.begin());
  Window window;
  window.most = X[top];
  std::size_t first = top, last = top;
  while (first > 0 && X[first - 1] > kPeakPart * X[top]) --first;
  while (last + 1 < X.size() && X[last + 1] > kPeakPart * X[top]) ++last;
  if (first > 0) --first;  // so that the half-power points lie within, however few points there are
  if (last + 1 < X.size()) ++last;
  window.first = first;
  window.size = last - first + 1;
  const double low = curve.omega[first] * curve.omega[first], high = curve.omega[last] * curve.omega[last];
  window.middle = 0.5 * (low + high);
  window.half = std::max(0.5 * (high - low), std::numeric_limits<double>::min());
  window.z.resize(static_cast<Index>(window.size));
  window.X.resize(window.z.size());
  for (Index i = 0; i < window.z.size(); ++i) {
    const std::size_t at = first + static_cast<std::size_t>(i);
    window.z[i] = (curve.omega[at] * curve.omega[at] - window.middle) / window.half;
    window.X[i] = X[at] / window.most;
  }
  return window;
}

// y = 1/X^2 = p_0 + p_1 z + ..., fitted so that the squared errors of X are least.
struct Parabola {
  Eigen::VectorXd p;
  Eigen::MatrixXd influence;  // dp / dX
  double rss = 0.0, criterion = kInfinity;

  bool empty() const { return p.size() == 0; }
  Eigen::VectorXd basis(double z) const {
    Eigen::VectorXd powers = Eigen::VectorXd::Ones(p.size());
    for (Index k = 1; k < p.size(); ++k) powers[k] = powers[k - 1] * z;
    return powers;
  }
  Eigen::VectorXd basis_slope(double z) const {
    Eigen::VectorXd slopes = Eigen::VectorXd::Zero(p.size());
    for (Index k = 1; k < p.size(); ++k) slopes[k] = static_cast<double>(k) * std::pow(z, k - 1);
    return slopes;
  }
  double operator()(double z) const { return p.dot(basis(z)); }
  double slope(double z) const { return p.dot(basis_slope(z)); }
  double curvature(double z) const {
    double sum = 0.0;
    for (Index k = 2; k < p.size(); ++k) sum += static_cast<double>(k * (k - 1)) * p[k] * std::pow(z, k - 2);
    return sum;
  }
};

Parabola fit_of_degree(const Window& window, Index degree) {
  constexpr int kSteps = 8;  // of Gauss and Newton, whose start is off by the noise only
  const Index n = window.z.size();
  Eigen::MatrixXd A(n, degree + 1);
  A.col(0).setOnes();
  for (Index k = 1; k <= degree; ++k) A.col(k) = A.col(k - 1).cwiseProduct(window.z);
  Parabola fit;
  Eigen::VectorXd X = window.X;
  for (int step = 0; step < kSteps; ++step) {
    // dX = -X^3/2 dy about the last fit
    const Eigen::VectorXd by_X = -2.0 * X.array().cube().inverse();
    const Eigen::VectorXd y = X.array().square().inverse().matrix() + by_X.cwiseProduct(window.X - X);
    const LinearFit linear = linear_fit(A, y, -by_X);
    const Eigen::VectorXd fitted = A * linear.p;
    if (!(fitted.minCoeff() > 0.0)) return {};
    X = fitted.array().rsqrt();
    fit.p = linear.p;
    fit.influence = linear.influence * by_X.asDiagonal();
  }
  fit.rss = (window.X - X).squaredNorm();
  fit.criterion = corrected_akaike(fit.rss, n, degree + 1, kRounding);
  return fit;
}

// The degree goes up by two until a degree does not predict better: one of many degrees would fit the noise.
Parabola best_fit(const Window& window, ResponseTo shaken_by) {
  // To a support 1/X^2 is a parabola over 1 + 4 zeta^2 u: two degrees more cover the difference.
  const Index wanted = shaken_by == ResponseTo::force ? 2 : 4, most = window.z.size() - 3;
  Parabola best = fit_of_degree(window, std::clamp(most, Index{2}, wanted));
  for (Index degree = wanted + 2; degree <= std::min(kHighestDegree, most); degree += 2) {
    Parabola fit = fit_of_degree(window, degree);
    if (fit.empty() || !(fit.criterion < best.criterion)) break;
    best = std::move(fit);
  }
  return best;
}

constexpr int kScan = 512;  // points of the window that are scanned; the fit has 12 extremes at most

double place(int i) {
  return -1.0 + 2.0 * i / kScan;
}

template <class Function>
double bisect(const Function& f, double low, double high) {
  const bool rises = f(high) > 0.0;
  for (double middle = 0.5 * (low + high); middle > low && middle < high; middle = 0.5 * (low + high))
    ((f(middle) > 0.0) == rises ? high : low) = middle;
  return 0.5 * (low + high);
}

// Where 1/X^2 is least inside the window; NaN: at an end.
double lowest(const Parabola& fit) {
  int least = 0;
  for (int i = 1; i <= kScan; ++i) {
    if (fit(place(i)) < fit(place(least))) least = i;
  }
  if (least == 0 || least == kScan) return kNone;
  return bisect([&](double z) { return fit.slope(z); }, place(least - 1), place(least + 1));
}

// Where 1/X^2 has first risen to twice its least value, towards -1 or 1; NaN: not in the window.
double half_power_place(const Parabola& fit, double peak, int side) {
  const double level = 2.0 * fit(peak);
  double inside = peak;
  for (int i = 1; i <= kScan; ++i) {
    const double z = peak + (side - peak) * i / kScan;
    if (fit(z) >= level)
      return bisect([&](double at) { return fit(at) - level; }, std::min(inside, z), std::max(inside, z));
    inside = z;
  }
  return kNone;
}

std::string wrong(const ResponseCurve& curve) {
  const std::string bad =
      first_of({unless_equal("frequency and amplitude", {curve.omega.size(), curve.amplitude.size()}),
                unless_positive("frequency", curve.omega), unless_positive("amplitude", curve.amplitude)});
  if (!bad.empty()) return bad;
  for (std::size_t i = 1; i < curve.omega.size(); ++i) {
    if (!(curve.omega[i] > curve.omega[i - 1]))
      return "frequency " + std::to_string(i + 1) + " is " + number(curve.omega[i]) + " rad/s after " +
             number(curve.omega[i - 1]) + ": frequencies must increase";
  }
  if (curve.omega.size() < 3)
    return "at least three points of a curve are needed, there are " + std::to_string(curve.omega.size());
  return "";
}

CurvePeak no_peak(std::string why) {
  CurvePeak peak;
  peak.failure = std::move(why);
  return peak;
}

// Derivatives of omega, amplitude, lower, upper by the coefficients.
Eigen::MatrixXd by_coefficients(const Parabola& fit, const Window& window, const CurvePeak& found,
                                double peak, double lower, double upper) {
  const Eigen::RowVectorXd at_peak = fit.basis(peak).transpose();
  Eigen::MatrixXd by_p(4, fit.p.size());
  // y'(z) = 0;  y(z) = 2 y_least
  by_p.row(0) = -fit.basis_slope(peak).transpose() / fit.curvature(peak) * window.half / (2.0 * found.omega);
  by_p.row(1) = -0.5 * found.amplitude / fit(peak) * at_peak;
  by_p.row(2) =
      (2.0 * at_peak - fit.basis(lower).transpose()) / fit.slope(lower) * window.half / (2.0 * found.lower);
  by_p.row(3) =
      (2.0 * at_peak - fit.basis(upper).transpose()) / fit.slope(upper) * window.half / (2.0 * found.upper);
  return by_p;
}

}  // namespace

CurvePeak curve_peak(const ResponseCurve& curve, ResponseTo shaken_by) {
  if (const std::string why = wrong(curve); !why.empty()) return no_peak(why);
  const Window window = window_of(curve);
  if (window.size < 3)
    return no_peak("only " + std::to_string(window.size) + " points lie above half the peak of " +
                   number(window.most) + ": at least three are needed");
  const Parabola fit = best_fit(window, shaken_by);
  const double peak = fit.empty() ? kNone : lowest(fit);
  if (std::isnan(peak))
    return no_peak("the curve has no peak inside: it is highest at its end, " + number(curve.omega.front()) +
                   " to " + number(curve.omega.back()) + " rad/s");
  const double lower = half_power_place(fit, peak, -1), upper = half_power_place(fit, peak, 1);
  if (std::isnan(lower) || std::isnan(upper))
    return no_peak("the curve does not fall to 1/sqrt(2) of its peak on both sides between " +
                   number(curve.omega.front()) + " and " + number(curve.omega.back()) + " rad/s");
  const auto omega_at = [&](double z) { return std::sqrt(window.middle + window.half * z); };
  CurvePeak found;
  found.omega = omega_at(peak);
  found.amplitude = window.most / std::sqrt(fit(peak));
  found.lower = omega_at(lower);
  found.upper = omega_at(upper);
  const Scatter s = scatter(fit.rss, static_cast<double>(window.z.size() - fit.p.size()), 0.0);
  found.degrees_of_freedom = s.degrees_of_freedom;
  const Eigen::MatrixXd by_X = by_coefficients(fit, window, found, peak, lower, upper) * fit.influence;
  found.covariance = s.variance * by_X * by_X.transpose();
  for (Index i = 0; i < window.z.size(); ++i) {
    found.at.push_back(curve.omega[window.first + static_cast<std::size_t>(i)]);
    found.measured.push_back(window.most * window.X[i]);
    found.fitted.push_back(window.most / std::sqrt(fit(window.z[i])));
  }
  return found;
}

FittedRecord fitted_record(const CurvePeak& peak) {
  FittedRecord record{
      .name = "curve", .over = "frequency", .over_unit = "rad s-1", .at = peak.at, .series = {}};
  record.series = {{"amplitude", "m", peak.measured, peak.fitted}};
  record.nrmse = nrmse(record.series);
  return record;
}

}  // namespace frahm::identification
