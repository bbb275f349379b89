#include "solvers/identification/resonance_magnification.hpp"

#include <cmath>

#include "solvers/algebra/no_value.hpp"
#include "solvers/identification/linear_fit.hpp"
#include "solvers/identification/statement.hpp"

namespace frahm::identification {
namespace {

std::string wrong(const MagnificationRows& rows) {
  const std::string bad = first_of({unless_equal("static and resonant displacement",
                                                 {rows.static_displacement.size(), rows.resonant.size()}),
                                    unless_positive("static displacement", rows.static_displacement),
                                    unless_positive("resonant displacement", rows.resonant)});
  if (!bad.empty()) return bad;
  if (rows.resonant.empty()) return "there are no rows";
  for (std::size_t i = 0; i < rows.resonant.size(); ++i) {
    if (!(rows.static_displacement[i] < rows.resonant[i]))
      return "row " + std::to_string(i + 1) + " has a resonant displacement of " + number(rows.resonant[i]) +
             " m, not larger than the static one of " + number(rows.static_displacement[i]) + " m";
  }
  return "";
}

std::vector<Estimate> ratios() {
  return {{.name = "damping_ratio", .unit = "1", .long_name = "equivalent viscous damping ratio"},
          {.name = "damping_ratio_first_order", .unit = "1", .long_name = "damping ratio to first order"}};
}

}  // namespace

double magnification_first_order(double static_displacement, double resonant) {
  return static_displacement / (2.0 * resonant);
}

double magnification_exact(double static_displacement, double resonant, ResponseTo shaken_by) {
  const double part = static_displacement / resonant;
  if (!(part > 0.0 && part < 1.0)) return kNone;
  // X_st / X_r = 2 zeta sqrt(1 - zeta^2) = sin(2 asin zeta)
  if (shaken_by == ResponseTo::force) return std::sin(0.5 * std::asin(part));
  // T_p^2 = y^2 / (y^2 - 4), y = w + 1, w = sqrt(1 + 8 zeta^2): y^2 - 4 = 4 part^2 / (1 - part^2),
  // 8 zeta^2 = y (y - 2)
  const double over_four = 4.0 * part * part / ((1.0 - part) * (1.0 + part));
  const double y = std::sqrt(4.0 + over_four);
  return std::sqrt(y * over_four / (y + 2.0) / 8.0);
}

Identification resonance_magnification(const MagnificationRows& rows, ResponseTo shaken_by) {
  if (const std::string why = wrong(rows); !why.empty()) return no_result(why);
  const auto n = static_cast<Eigen::Index>(rows.resonant.size());
  Eigen::MatrixXd zeta(n, 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto row = static_cast<std::size_t>(i);
    zeta(i, 0) = magnification_exact(rows.static_displacement[row], rows.resonant[row], shaken_by);
    zeta(i, 1) = magnification_first_order(rows.static_displacement[row], rows.resonant[row]);
  }
  const Eigen::RowVectorXd mean = zeta.colwise().mean();
  const Eigen::MatrixXd off = zeta.rowwise() - mean;
  Identification result;
  result.estimates = ratios();
  for (std::size_t k : {0U, 1U}) result.estimates[k].value = mean[static_cast<Eigen::Index>(k)];
  result.degrees_of_freedom = static_cast<double>(n - 1);
  const double each = n > 1 ? 1.0 / (result.degrees_of_freedom * static_cast<double>(n)) : kNone;
  result.covariance = each * off.transpose() * off;
  result.rows = {{"zeta", "1", "damping ratio, to first order", {zeta.col(1).begin(), zeta.col(1).end()}},
                 {"zeta_exact",
                  "1",
                  "damping ratio of the viscous mass with this peak",
                  {zeta.col(0).begin(), zeta.col(0).end()}}};
  set_intervals(result);
  return result;
}

Identification resonance_magnification(const ResponseCurve& curve, double static_displacement,
                                       ResponseTo shaken_by) {
  if (!(std::isfinite(static_displacement) && static_displacement > 0.0))
    return no_result("the static displacement is " + number(static_displacement) +
                     " m: it must be positive and finite");
  const CurvePeak peak = curve_peak(curve, shaken_by);
  if (!peak.failure.empty()) return no_result(peak.failure);
  if (!(static_displacement < peak.amplitude))
    return no_result("the peak of " + number(peak.amplitude) +
                     " m is not larger than the static displacement of " + number(static_displacement) +
                     " m");
  Identification result;
  result.estimates = {
      {.name = "peak_frequency",
       .unit = "rad s-1",
       .long_name = "frequency of the peak",
       .value = peak.omega},
      {.name = "peak_amplitude", .unit = "m", .long_name = "amplitude at the peak", .value = peak.amplitude}};
  result.covariance = peak.covariance.topLeftCorner(2, 2);
  result.degrees_of_freedom = peak.degrees_of_freedom;
  const auto exact = [&](double X) { return magnification_exact(static_displacement, X, shaken_by); };
  const double h = 1e-5 * std::min(peak.amplitude, peak.amplitude - static_displacement);
  auto found = ratios();
  found[0].value = exact(peak.amplitude);
  found[1].value = magnification_first_order(static_displacement, peak.amplitude);
  // Central differences suffice for error bars.
  const double slope = (exact(peak.amplitude + h) - exact(peak.amplitude - h)) / (2.0 * h);
  add_from(result, found[0], {{"peak_amplitude", slope}});
  add_from(result, found[1], {{"peak_amplitude", -found[1].value / peak.amplitude}});
  result.records = {fitted_record(peak)};
  set_intervals(result);
  return result;
}

}  // namespace frahm::identification
