#include "solvers/identification/half_power.hpp"

#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <functional>

#include "solvers/algebra/no_value.hpp"
#include "solvers/identification/statement.hpp"

namespace frahm::identification {
namespace {

// For a mass on a shaken support, T^2 = (1 + 4 zeta^2 u) / ((1 - u)^2 + 4 zeta^2 u), u = (omega/omega_n)^2.
// With w = sqrt(1 + 8 zeta^2) its peak is T_p^2 = (w + 1)^2 / ((w - 1)(w + 3)) at u = 2 / (w + 1), and
// T^2 = T_p^2 / 2 a quadratic in u, of product P and squared difference of its roots D^2: with y = w + 1,
// d = w - 1,
//   P = (8 - y^2) / y^2,   D^2 = d [8 (d + 4) / y^2 - 2 (8 - y^2) / y + d (8 - y^2)^2 / (4 y^2)].
double relative_width(double zeta) {  // D / sqrt(P)
  const double w = std::sqrt(1.0 + 8.0 * zeta * zeta);
  const double y = w + 1.0, d = 8.0 * zeta * zeta / y, e = 8.0 - y * y;
  return std::sqrt(d * (8.0 * (d + 4.0) / (y * y) - 2.0 * e / y + d * e * e / (4.0 * y * y)) * y * y / e);
}

// y^2 = 8: the peak is sqrt(2) high, and the lower half-power point at omega = 0.
const double kMostOfSupport = std::sqrt((std::sqrt(8.0) - 2.0) * std::sqrt(8.0) / 8.0);

double of_support(double lower, double upper) {
  const double width = upper / lower - lower / upper;  // (u_2 - u_1) / sqrt(u_1 u_2)
  const auto miss = [&](double zeta) { return relative_width(zeta) - width; };
  const double most = kMostOfSupport * (1.0 - 1e-12);
  if (!(miss(most) > 0.0)) return kNone;
  std::uintmax_t evaluations = 200;
  const auto [left, right] = boost::math::tools::toms748_solve(
      miss, 0.0, most, boost::math::tools::eps_tolerance<double>(52), evaluations);
  return 0.5 * (left + right);
}

// 1/X^2 = (u - 1 + 2 zeta^2)^2 + 4 zeta^2 (1 - zeta^2) is least at 1 - 2 zeta^2, and twice that where
// u = 1 - 2 zeta^2 -+ 2 zeta sqrt(1 - zeta^2):  (u_2 - u_1) / (u_2 + u_1) = tan(2 asin zeta)
double of_force(double lower, double upper) {
  return std::sin(0.5 * std::atan((upper - lower) * (upper + lower) / (upper * upper + lower * lower)));
}

// Peak over natural frequency, omega_peak / omega_n.
double peak_ratio(double zeta, ResponseTo shaken_by) {
  if (shaken_by == ResponseTo::force) return std::sqrt(1.0 - 2.0 * zeta * zeta);
  return std::sqrt(2.0 / (std::sqrt(1.0 + 8.0 * zeta * zeta) + 1.0));
}

std::string wrong(const HalfPowerRows& rows) {
  const std::string bad = first_of({unless_equal("peak and half-power frequencies",
                                                 {rows.peak.size(), rows.lower.size(), rows.upper.size()}),
                                    unless_positive("lower frequency", rows.lower),
                                    unless_positive("upper frequency", rows.upper),
                                    unless_positive("peak frequency", rows.peak)});
  if (!bad.empty()) return bad;
  if (rows.peak.empty()) return "there are no rows";
  for (std::size_t i = 0; i < rows.peak.size(); ++i) {
    if (!(rows.lower[i] < rows.peak[i] && rows.peak[i] < rows.upper[i]))
      return "row " + std::to_string(i + 1) + " has half-power points " + number(rows.lower[i]) + " and " +
             number(rows.upper[i]) + " of a peak at " + number(rows.peak[i]) +
             ": the peak must lie between them";
  }
  return "";
}

// f and its derivatives by omega, lower, upper of the peak; central differences suffice for error bars.
using OfPeak = std::function<double(double peak, double lower, double upper)>;
void add(Identification& result, Estimate estimate, const CurvePeak& peak, const OfPeak& f) {
  constexpr double kStep = 1e-5;
  const auto slope = [&](double dp, double dl, double du) {
    const double h = kStep * (peak.upper - peak.lower);
    return (f(peak.omega + h * dp, peak.lower + h * dl, peak.upper + h * du) -
            f(peak.omega - h * dp, peak.lower - h * dl, peak.upper - h * du)) /
           (2.0 * h);
  };
  estimate.value = f(peak.omega, peak.lower, peak.upper);
  add_from(result, std::move(estimate),
           {{"peak_frequency", slope(1, 0, 0)},
            {"lower_frequency", slope(0, 1, 0)},
            {"upper_frequency", slope(0, 0, 1)}});
}

}  // namespace

double half_power_first_order(double peak, double lower, double upper) {
  return (upper - lower) / (2.0 * peak);
}

double half_power_exact(double lower, double upper, ResponseTo shaken_by) {
  if (!(lower > 0.0 && upper > lower && std::isfinite(upper))) return kNone;
  return shaken_by == ResponseTo::force ? of_force(lower, upper) : of_support(lower, upper);
}

Identification half_power(const HalfPowerRows& rows, ResponseTo shaken_by) {
  if (const std::string why = wrong(rows); !why.empty()) return no_result(why);
  RowColumn zeta{"zeta", "1", "damping ratio, to first order", {}};
  RowColumn exact{"zeta_exact", "1", "damping ratio of the viscous mass with these half-power points", {}};
  RowColumn increase{"increase", "1", "zeta over that of the first row, minus one", {}};
  for (std::size_t i = 0; i < rows.peak.size(); ++i) {
    zeta.values.push_back(half_power_first_order(rows.peak[i], rows.lower[i], rows.upper[i]));
    exact.values.push_back(half_power_exact(rows.lower[i], rows.upper[i], shaken_by));
    increase.values.push_back(zeta.values.back() / zeta.values.front() - 1.0);
  }
  Identification result;
  result.covariance.resize(0, 0);
  result.rows = {zeta, exact, increase};
  return result;
}

Identification half_power(const ResponseCurve& curve, ResponseTo shaken_by) {
  const CurvePeak peak = curve_peak(curve, shaken_by);
  if (!peak.failure.empty()) return no_result(peak.failure);
  if (std::isnan(half_power_exact(peak.lower, peak.upper, shaken_by)))
    return no_result("the half-power points " + number(peak.lower) + " and " + number(peak.upper) +
                     " rad/s are further apart than those of any viscous mass on a support");
  Identification result;
  result.estimates = {{.name = "peak_frequency",
                       .unit = "rad s-1",
                       .long_name = "frequency of the peak",
                       .value = peak.omega},
                      {.name = "lower_frequency",
                       .unit = "rad s-1",
                       .long_name = "lower half-power point",
                       .value = peak.lower},
                      {.name = "upper_frequency",
                       .unit = "rad s-1",
                       .long_name = "upper half-power point",
                       .value = peak.upper}};
  const std::vector<int> kept{0, 2, 3};
  result.covariance = peak.covariance(kept, kept);
  result.degrees_of_freedom = peak.degrees_of_freedom;
  const auto exact = [&](double, double lower, double upper) {
    return half_power_exact(lower, upper, shaken_by);
  };
  add(result, {.name = "damping_ratio", .unit = "1", .long_name = "equivalent viscous damping ratio"}, peak,
      exact);
  add(result, {.name = "damping_ratio_first_order", .unit = "1", .long_name = "damping ratio to first order"},
      peak, half_power_first_order);
  add(result, {.name = "natural_frequency", .unit = "rad s-1", .long_name = "undamped natural frequency"},
      peak, [&](double omega, double lower, double upper) {
        return omega / peak_ratio(half_power_exact(lower, upper, shaken_by), shaken_by);
      });
  result.records = {fitted_record(peak)};
  set_intervals(result);
  return result;
}

}  // namespace frahm::identification
