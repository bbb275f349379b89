#include "solvers/identification/energy_balance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solvers/identification/linear_fit.hpp"
#include "solvers/identification/statement.hpp"

namespace frahm::identification {
namespace {

std::string wrong(const EnergyRows& rows) {
  const std::size_t n = rows.amplitude.size();
  const std::string bad = first_of(
      {unless_equal("amplitude and energy", {n, rows.energy.size()}),
       unless_positive("amplitude", rows.amplitude), unless_finite("energy", rows.energy),
       unless_positive("frequency", rows.omega), unless_positive("rms velocity", rows.velocity_rms)});
  if (!bad.empty()) return bad;
  const auto negative =
      std::find_if(rows.energy.begin(), rows.energy.end(), [](double E) { return E < 0.0; });
  if (negative != rows.energy.end())
    return "energy " + std::to_string(negative - rows.energy.begin() + 1) + " of " + std::to_string(n) +
           " is " + number(*negative) + " J: the energy that a damper and friction take must not be negative";
  if (n < 2) return "at least two amplitudes are needed, there is " + std::to_string(n);
  if (rows.omega.size() != 1 && rows.omega.size() != n)
    return "there are " + std::to_string(rows.omega.size()) + " frequencies for " + std::to_string(n) +
           " rows";
  if (!rows.velocity_rms.empty() && rows.velocity_rms.size() != n)
    return "there are " + std::to_string(rows.velocity_rms.size()) + " rms velocities for " +
           std::to_string(n) + " rows";
  return "";
}

// The energy that a damper of 1 N s/m and a friction of 1 N take in a cycle of each row [J].
Eigen::MatrixXd losses(const EnergyRows& rows) {
  using std::numbers::pi;
  Eigen::MatrixXd A(static_cast<Eigen::Index>(rows.amplitude.size()), 2);
  for (std::size_t i = 0; i < rows.amplitude.size(); ++i) {
    const double X = rows.amplitude[i], omega = rows.omega.size() == 1 ? rows.omega[0] : rows.omega[i];
    const double v = rows.velocity_rms.empty() ? omega * X / std::numbers::sqrt2 : rows.velocity_rms[i];
    const auto row = static_cast<Eigen::Index>(i);
    // E = c (2 pi / omega) v_rms^2 + F 4 X
    A(row, 0) = 2.0 * pi / omega * v * v;
    A(row, 1) = 4.0 * X;
  }
  return A;
}

// Why the two losses grow alike from row to row: their ratio is 2 pi v_rms^2 / (4 omega X), or pi omega X
// / 4.
std::string alike(const EnergyRows& rows) {
  const double X = rows.amplitude[0], omega = rows.omega[0];
  constexpr double kRounding = 1e-6;
  const bool one_amplitude = std::all_of(rows.amplitude.begin(), rows.amplitude.end(),
                                         [&](double each) { return std::abs(each - X) <= kRounding * X; });
  std::string what = "one amplitude";
  if (!one_amplitude && rows.velocity_rms.empty())
    what = "one velocity, frequency times amplitude, " + number(omega * X) + " m/s,";
  if (!one_amplitude && !rows.velocity_rms.empty())
    what = "one rms velocity squared over frequency times amplitude, " +
           number(rows.velocity_rms[0] * rows.velocity_rms[0] / (omega * X)) + " m/s,";
  return "all " + std::to_string(rows.energy.size()) + " rows have " + what +
         ": damper and friction cannot be distinguished";
}

}  // namespace

Identification energy_balance(const EnergyRows& rows) {
  if (const std::string why = wrong(rows); !why.empty()) return no_result(why);
  const Eigen::MatrixXd A = losses(rows);
  const auto n = static_cast<Eigen::Index>(rows.energy.size());
  const Eigen::Map<const Eigen::VectorXd> energy(rows.energy.data(), n);
  // Parallel columns: the sine of the angle between them is rounding.
  constexpr double kParallel = 1e-7;
  const double cosine = A.col(0).normalized().dot(A.col(1).normalized());
  if (1.0 - cosine < kParallel * kParallel) return no_result(alike(rows));
  const LinearFit fit = linear_fit(A, energy, Eigen::VectorXd::Ones(n));
  const Scatter s = scatter(fit.chi_squared, fit.degrees_of_freedom, 0.0);
  Identification result;
  result.estimates = {
      {.name = "damping", .unit = "N s m-1", .long_name = "viscous damping", .value = fit.p[0]},
      {.name = "friction_force", .unit = "N", .long_name = "Coulomb friction force", .value = fit.p[1]}};
  result.covariance = s.variance * fit.influence * fit.influence.transpose();
  result.degrees_of_freedom = s.degrees_of_freedom;
  const Eigen::VectorXd fitted = A * fit.p;
  FittedRecord record{
      .name = "energy_balance", .over = "amplitude", .over_unit = "m", .at = rows.amplitude, .series = {}};
  record.series = {{"energy", "J", rows.energy, {fitted.begin(), fitted.end()}}};
  record.nrmse = nrmse(record.series);
  result.records = {record};
  set_intervals(result);
  return result;
}

}  // namespace frahm::identification
