#include "solvers/identification/free_decay.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "solvers/algebra/no_value.hpp"
#include "solvers/algebra/shortest_solution.hpp"
#include "solvers/identification/decay_fit.hpp"
#include "solvers/identification/least_squares.hpp"
#include "solvers/identification/statement.hpp"

namespace frahm::identification {
namespace {

using Index = Eigen::Index;
using std::numbers::pi;

// zeta of beta = exp(-pi zeta / sqrt(1 - zeta^2)):  zeta = delta / sqrt(pi^2 + delta^2), delta = -ln beta
double ratio_of(double beta) {
  const double delta = -std::log(beta);
  return delta / std::sqrt(pi * pi + delta * delta);
}

double ratio_slope(double beta) {  // d zeta / d beta
  const double delta = std::log(beta), root = std::sqrt(pi * pi + delta * delta);
  return -pi * pi / (root * root * root) / beta;
}

// Extreme i is side_i |x|_i + offset, |x|_i negative where the mass comes to rest before the middle.
double side_of(const Eigen::VectorXd& x, Index i) {
  return (x[0] > x[1] ? 1.0 : -1.0) * (i % 2 == 0 ? 1.0 : -1.0);
}

struct Recursion {
  double beta, x_f, offset;  // [1], [m], [m]
};

// The regression of each extreme on the one before, linear in its unknowns:
//   x_{i+1} = -beta x_i + side_i x_f (1 + beta) + offset (1 + beta)
Recursion regression(const Eigen::VectorXd& x, const Eigen::VectorXd& sigma, bool with_offset) {
  const Index n = x.size() - 1;
  Eigen::MatrixXd A(n, with_offset ? 3 : 2);
  for (Index i = 0; i < n; ++i) {
    A(i, 0) = -x[i];
    A(i, 1) = side_of(x, i);
    if (with_offset) A(i, 2) = 1.0;
  }
  const LinearFit fit = linear_fit(A, x.tail(n), sigma.tail(n));
  const double beta = fit.p[0];
  return {beta, fit.p[1] / (1.0 + beta), with_offset ? fit.p[2] / (1.0 + beta) : 0.0};
}

// How zeta and x_f of the regression change with each extreme: central differences suffice for error bars.
Eigen::MatrixXd regression_slopes(const Eigen::VectorXd& x, const Eigen::VectorXd& sigma, bool with_offset) {
  Eigen::MatrixXd slopes(2, x.size());
  for (Index i = 0; i < x.size(); ++i) {
    const double h = 1e-6 * x.cwiseAbs().maxCoeff();
    Eigen::VectorXd up = x, down = x;
    up[i] += h;
    down[i] -= h;
    const Recursion a = regression(up, sigma, with_offset), b = regression(down, sigma, with_offset);
    slopes(0, i) = (ratio_of(a.beta) - ratio_of(b.beta)) / (2.0 * h);
    slopes(1, i) = (a.x_f - b.x_f) / (2.0 * h);
  }
  return slopes;
}

// The whole sequence, in p = (|x|_0, beta, x_f, offset if any):
//   |x|_{i+1} = beta |x|_i - x_f (1 + beta)
struct Sequence {
  Eigen::VectorXd x;
  Eigen::MatrixXd by_p;
};
Sequence sequence_at(const Eigen::VectorXd& p, const Eigen::VectorXd& measured) {
  const Index n = measured.size(), unknowns = p.size();
  const double beta = p[1], x_f = p[2];
  Sequence sequence{Eigen::VectorXd(n), Eigen::MatrixXd::Zero(n, unknowns)};
  double size = p[0];
  Eigen::Vector3d slope(1.0, 0.0, 0.0);
  for (Index i = 0; i < n; ++i) {
    const double side = side_of(measured, i);
    sequence.x[i] = side * size + (unknowns > 3 ? p[3] : 0.0);
    sequence.by_p.row(i).head(3) = side * slope;
    if (unknowns > 3) sequence.by_p(i, 3) = 1.0;
    slope = beta * slope + Eigen::Vector3d(0.0, size - x_f, -(1.0 + beta));
    size = beta * size - x_f * (1.0 + beta);
  }
  return sequence;
}

LeastSquaresFit fit_sequence(const Eigen::VectorXd& x, const Eigen::VectorXd& sigma, const Recursion& start,
                             bool with_offset) {
  const double size = x.cwiseAbs().maxCoeff();
  std::vector<Unknown> unknowns{
      {.name = "x_0", .start = side_of(x, 0) * (x[0] - start.offset), .scale = size},
      {.name = "beta", .start = start.beta, .scale = 1.0},
      {.name = "x_f", .start = start.x_f, .scale = size}};
  if (with_offset) unknowns.push_back({.name = "offset", .start = start.offset, .scale = size});
  return least_squares(unknowns,
                       [&](const Eigen::VectorXd& p, Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian) {
                         if (!(p[1] > 0.0)) return false;
                         const Sequence sequence = sequence_at(p, x);
                         residuals = (sequence.x - x).cwiseQuotient(sigma);
                         if (jacobian != nullptr)
                           *jacobian = sigma.cwiseInverse().asDiagonal() * sequence.by_p;
                         return true;
                       });
}

// F = k x_f, c = 2 zeta k / omega_n, m = k / omega_n^2
void add_of_stiffness(Identification& result, double k, double zeta, double omega, double x_f) {
  add_from(result, {.name = "mass", .unit = "kg", .long_name = "mass", .value = k / (omega * omega)},
           {{"natural_frequency", -2.0 * k / (omega * omega * omega)}});
  add_from(
      result,
      {.name = "damping", .unit = "N s m-1", .long_name = "viscous damping", .value = 2.0 * zeta * k / omega},
      {{"damping_ratio", 2.0 * k / omega}, {"natural_frequency", -2.0 * zeta * k / (omega * omega)}});
  add_from(result,
           {.name = "friction_force", .unit = "N", .long_name = "Coulomb friction force", .value = k * x_f},
           {{"friction_displacement", k}});
}

// k = m omega_n^2, c = 2 zeta m omega_n, F = k x_f
void add_of_mass(Identification& result, double m, double zeta, double omega, double x_f) {
  const double k = m * omega * omega;
  add_from(result, {.name = "stiffness", .unit = "N m-1", .long_name = "stiffness", .value = k},
           {{"natural_frequency", 2.0 * m * omega}});
  add_from(
      result,
      {.name = "damping", .unit = "N s m-1", .long_name = "viscous damping", .value = 2.0 * zeta * m * omega},
      {{"damping_ratio", 2.0 * m * omega}, {"natural_frequency", 2.0 * zeta * m}});
  add_from(result,
           {.name = "friction_force", .unit = "N", .long_name = "Coulomb friction force", .value = k * x_f},
           {{"friction_displacement", k}, {"natural_frequency", 2.0 * m * omega * x_f}});
}

void add_forces(Identification& result, const OneMass& known, double zeta, double omega, double x_f) {
  if (known.stiffness) add_of_stiffness(result, *known.stiffness, zeta, omega, x_f);
  if (known.mass) add_of_mass(result, *known.mass, zeta, omega, x_f);
}

std::string wrong(const OneMass& known, bool has_times) {
  if (known.mass && known.stiffness)
    return "mass and stiffness are both given, but the natural frequency is measured: give only one of them";
  if (!has_times && (known.mass || known.stiffness))
    return "forces need the natural frequency, but the extremes have no times";
  for (const auto& value : {known.mass, known.stiffness}) {
    if (value && !(std::isfinite(*value) && *value > 0.0))
      return std::string(known.mass ? "the mass" : "the stiffness") + " is " + number(*value) +
             ": it must be positive and finite";
  }
  return "";
}

// Values and covariance of the parameters of the extremes, before derived quantities.
void set_estimates(const LeastSquaresFit& fit, const Recursion& first, const Eigen::MatrixXd& by_x,
                   Identification& result) {
  result.estimates = {
      {.name = "damping_ratio",
       .unit = "1",
       .long_name = "viscous damping ratio",
       .value = ratio_of(fit.p[1])},
      {.name = "friction_displacement",
       .unit = "m",
       .long_name = "friction force over stiffness",
       .value = fit.p[2]},
      {.name = "damping_ratio_first",
       .unit = "1",
       .long_name = "viscous damping ratio by the regression of each extreme on the one before",
       .value = ratio_of(first.beta)},
      {.name = "friction_displacement_first",
       .unit = "m",
       .long_name = "friction force over stiffness by the regression of each extreme on the one before",
       .value = first.x_f}};
  if (fit.p.size() > 3)
    result.estimates.push_back(
        {.name = "offset", .unit = "m", .long_name = "reading of the sensor at rest", .value = fit.p[3]});
  result.covariance = by_x * by_x.transpose();
}

// Extremes of equal size fit any damping with the negative friction that compensates it.
void mark_undetermined(const LeastSquaresFit& fit, double size, Identification& result) {
  Eigen::VectorXd scales = Eigen::VectorXd::Constant(fit.p.size(), size);
  scales[1] = 1.0;
  const Eigen::MatrixXd tells = covariance(fit.jacobian, 1.0, scales);
  if (std::isfinite(tells(1, 1)) && std::isfinite(tells(2, 2))) return;
  for (Index i = 0; i < 4; ++i) {
    result.covariance.row(i).setConstant(kNone);
    result.covariance.col(i) = result.covariance.row(i).transpose();
  }
  for (Index i = 0; i < 4; ++i) result.covariance(i, i) = kInfinity;
  result.notes.emplace_back(
      "the extremes all have the same size: damping and friction cannot be distinguished");
}

// How the estimates change with the extremes, each by its standard error.
Eigen::MatrixXd slopes(const LeastSquaresFit& fit, const Eigen::VectorXd& x, const Eigen::VectorXd& sigma) {
  const bool with_offset = fit.p.size() > 3;
  const Eigen::MatrixXd by_x = algebra::pseudo_inverse(fit.jacobian);
  Eigen::MatrixXd all(with_offset ? 5 : 4, x.size());
  all.row(0) = ratio_slope(fit.p[1]) * by_x.row(1);
  all.row(1) = by_x.row(2);
  all.middleRows(2, 2) = regression_slopes(x, sigma, with_offset) * sigma.asDiagonal();
  if (with_offset) all.row(4) = by_x.row(3);
  return all;
}

}  // namespace

Identification free_decay(const DecayExtrema& extrema, const FreeDecayOptions& options) {
  const std::string why = first_of(
      {wrong(options.known, !extrema.time.empty()), unless_decaying(extrema, options.sensor_offset ? 4 : 3)});
  if (!why.empty()) return no_result(why);
  const Eigen::Map<const Eigen::VectorXd> x(extrema.displacement.data(),
                                            static_cast<Index>(extrema.displacement.size()));
  const Eigen::VectorXd sigma = displacement_sigma(extrema);
  const Recursion first = regression(x, sigma, options.sensor_offset);
  if (!(first.beta > 0.0))
    return no_result(
        "the extremes do not follow |x_{i+1}| = beta |x_i| - x_f (1 + beta): their regression gives beta = " +
        number(first.beta) + ", which must be positive");
  const LeastSquaresFit fit = fit_sequence(x, sigma, first, options.sensor_offset);
  if (!fit.converged) return no_result("the fit of the extremes did not converge: " + fit.reason);
  const bool known = !extrema.displacement_sigma.empty();
  const Scatter s = scatter(fit.sum_of_squares(), static_cast<double>(x.size() - fit.p.size()),
                            known ? extrema.degrees_of_freedom : 0.0);
  Identification result;
  set_estimates(fit, first, std::sqrt(s.variance) * slopes(fit, x, sigma), result);
  mark_undetermined(fit, x.cwiseAbs().maxCoeff(), result);
  result.degrees_of_freedom = s.degrees_of_freedom;
  result.iterations = fit.iterations;
  const double zeta = result.estimates[0].value;
  add_frequencies(extrema, zeta, result);
  if (!extrema.time.empty()) add_forces(result, options.known, zeta, result.estimates.back().value, fit.p[2]);
  result.records = {extrema_record(extrema, sequence_at(fit.p, x).x)};
  set_intervals(result);
  return result;
}

Identification free_decay(std::span<const double> time, std::span<const double> displacement,
                          const FreeDecayOptions& options) {
  const FoundExtrema found = find_extrema(time, displacement);
  if (!found.failure.empty()) return no_result(found.failure);
  Identification result = free_decay(found.extrema, options);
  result.notes.insert(result.notes.end(), found.notes.begin(), found.notes.end());
  return result;
}

}  // namespace frahm::identification
