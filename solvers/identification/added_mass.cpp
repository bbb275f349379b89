#include "solvers/identification/added_mass.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/algebra/no_value.hpp"
#include "solvers/identification/linear_fit.hpp"
#include "solvers/identification/statement.hpp"

namespace frahm::identification {
namespace {

Eigen::VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

std::string wrong(const AddedMassRows& rows) {
  const std::string bad =
      first_of({unless_equal("added mass and frequency", {rows.added.size(), rows.omega.size()}),
                unless_finite("added mass", rows.added), unless_positive("frequency", rows.omega),
                unless_positive("standard error", rows.sigma)});
  if (!bad.empty()) return bad;
  if (!rows.sigma.empty() && rows.sigma.size() != rows.omega.size())
    return "there are " + std::to_string(rows.sigma.size()) + " standard errors for " +
           std::to_string(rows.omega.size()) + " frequencies";
  if (!rows.degrees_of_freedom.empty() && rows.degrees_of_freedom.size() != rows.sigma.size())
    return "there are degrees of freedom of " + std::to_string(rows.degrees_of_freedom.size()) +
           " standard errors, of " + std::to_string(rows.sigma.size());
  if (std::any_of(rows.degrees_of_freedom.begin(), rows.degrees_of_freedom.end(),
                  [](double nu) { return !(nu > 0.0); }))
    return "the degrees of freedom of a standard error must be positive";
  const auto [least, most] = std::minmax_element(rows.added.begin(), rows.added.end());
  if (rows.added.size() < 2 || *least == *most) return "at least two different added masses are needed";
  if (*least < 0.0) return "an added mass is " + number(*least) + " kg: it must not be negative";
  return "";
}

// For a value that changes by u_i with the standard error of datum i: nu = (sum u_i^2)^2 / sum u_i^4 / nu_i
double welch_satterthwaite(const Eigen::RowVectorXd& u, const std::vector<double>& degrees_of_freedom) {
  double fourth = 0.0;
  for (Eigen::Index i = 0; i < u.size(); ++i)
    fourth += std::pow(u[i], 4) / degrees_of_freedom[static_cast<std::size_t>(i)];
  return fourth > 0.0 ? std::pow(u.squaredNorm(), 2) / fourth : kInfinity;
}

}  // namespace

Identification added_mass(const AddedMassRows& rows) {
  if (const std::string why = wrong(rows); !why.empty()) return no_result(why);
  const Eigen::VectorXd added = vector_of(rows.added), omega = vector_of(rows.omega);
  // 1/omega^2 = m/k + (1/k) added, whose error is 2 sigma / omega^3; equal parts of omega where not known.
  const Eigen::VectorXd y = omega.array().square().inverse();
  const bool known = !rows.sigma.empty();
  Eigen::VectorXd sigma = 2.0 * y;
  if (known) sigma = sigma.cwiseProduct(vector_of(rows.sigma)).cwiseQuotient(omega);
  Eigen::MatrixXd A(y.size(), 2);
  A << Eigen::VectorXd::Ones(y.size()), added;
  const LinearFit fit = linear_fit(A, y, sigma);
  const double at_zero = fit.p[0], slope = fit.p[1];
  if (!(slope > 0.0 && at_zero > 0.0))
    return no_result(
        "the frequencies do not fall with the added mass as those of a mass on a spring: 1/omega^2 = " +
        number(at_zero) + " + " + number(slope) + " added; both numbers must be positive");
  const Scatter s = known ? Scatter{1.0, kInfinity} : scatter(fit.chi_squared, fit.degrees_of_freedom, 0.0);
  // m = p_0 / p_1, k = 1 / p_1
  Eigen::Matrix2d by_p;
  by_p << 1.0 / slope, -at_zero / (slope * slope), 0.0, -1.0 / (slope * slope);
  const Eigen::MatrixXd by_data = by_p * fit.influence * sigma.asDiagonal();
  Identification result;
  result.estimates = {
      {.name = "mass", .unit = "kg", .long_name = "mass without added mass", .value = at_zero / slope},
      {.name = "stiffness", .unit = "N m-1", .long_name = "stiffness", .value = 1.0 / slope}};
  result.covariance = s.variance * by_data * by_data.transpose();
  result.degrees_of_freedom = s.degrees_of_freedom;
  for (std::size_t i = 0; !rows.degrees_of_freedom.empty() && i < result.estimates.size(); ++i) {
    Estimate& estimate = result.estimates[i];
    estimate.degrees_of_freedom =
        welch_satterthwaite(by_data.row(static_cast<Eigen::Index>(i)), rows.degrees_of_freedom);
    result.degrees_of_freedom = std::min(result.degrees_of_freedom, estimate.degrees_of_freedom);
  }
  const Eigen::VectorXd fitted = (A * fit.p).array().rsqrt();
  FittedRecord record{
      .name = "added_mass", .over = "added_mass", .over_unit = "kg", .at = rows.added, .series = {}};
  record.series = {{"natural_frequency", "rad s-1", rows.omega, {fitted.begin(), fitted.end()}}};
  record.nrmse = nrmse(record.series);
  result.records = {record};
  set_intervals(result);
  return result;
}

}  // namespace frahm::identification
