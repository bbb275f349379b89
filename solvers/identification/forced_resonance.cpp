#include "solvers/identification/forced_resonance.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "solvers/algebra/shortest_solution.hpp"
#include "solvers/identification/least_squares.hpp"
#include "solvers/identification/linear_fit.hpp"
#include "solvers/identification/statement.hpp"
#include "solvers/orbits/closed_forms.hpp"

namespace frahm::identification {
namespace {

using Index = Eigen::Index;
using std::numbers::pi;

// Den Hartog's G and H at r = 1 and their derivatives by zeta in (0, 1), s = sqrt(1 - zeta^2):
//   Dn = cosh(pi zeta) + cos(pi s),  G = [sinh(pi zeta) - (zeta/s) sin(pi s)] / Dn,  H = sin(pi s) / (s Dn)
struct AtResonance {
  double G, H, G_slope, H_slope;
};
AtResonance at_resonance(double zeta) {
  const double s = std::sqrt((1.0 - zeta) * (1.0 + zeta)), less = zeta * zeta / (1.0 + s);  // 1 - s
  const double half_sinh = std::sinh(0.5 * pi * zeta), half_sine = std::sin(0.5 * pi * less);
  // Both terms of Dn are near one, of different sign: cosh a + cos(pi - b) = 2 sinh^2(a/2) + 2 sin^2(b/2)
  const double Dn = 2.0 * (half_sinh * half_sinh + half_sine * half_sine);
  const double sine = std::sin(pi * less), cosine = -std::cos(pi * less);  // of pi s
  const double sinh = std::sinh(pi * zeta), cosh = std::cosh(pi * zeta);
  const double Dn_slope = pi * sinh + pi * sine * zeta / s;
  const double G = (sinh - zeta / s * sine) / Dn, H = sine / (s * Dn);
  const double by_G = pi * cosh - sine / (s * s * s) + pi * zeta * zeta / (s * s) * cosine;
  const double by_H = -pi * zeta * cosine / (s * s) + zeta * sine / (s * s * s);
  return {G, H, (by_G - G * Dn_slope) / Dn, (by_H - H * Dn_slope) / Dn};
}

// The hyperbola's slope: 2 zeta, to a support 2 zeta / sqrt(1 + 4 zeta^2).
struct Slope {
  double value, by_zeta;
};
Slope slope_of(double zeta, ResponseTo shaken_by) {
  if (shaken_by == ResponseTo::force) return {2.0 * zeta, 2.0};
  const double g = std::sqrt(1.0 + 4.0 * zeta * zeta);
  return {2.0 * zeta / g, 2.0 / (g * g * g)};
}
struct Ratio {
  double value, by_slope;
};
Ratio ratio_of(double slope, ResponseTo shaken_by) {
  if (shaken_by == ResponseTo::force) return {0.5 * slope, 0.5};
  const double root = std::sqrt((1.0 - slope) * (1.0 + slope));
  return {0.5 * slope / root, 0.5 / (root * root * root)};
}

// Y = slope sqrt((X + G x_f)^2 + (H x_f)^2), p = (zeta, x_f)
bool hyperbola(const Eigen::VectorXd& X, const Eigen::VectorXd& p, ResponseTo shaken_by, Eigen::VectorXd& Y,
               Eigen::MatrixXd* by_p) {
  const double zeta = p[0], x_f = p[1];
  if (!(zeta > 0.0 && zeta < 1.0)) return false;
  const AtResonance at = at_resonance(zeta);
  const Slope slope = slope_of(zeta, shaken_by);
  const Eigen::ArrayXd along = X.array() + at.G * x_f;
  const Eigen::ArrayXd root = (along.square() + at.H * at.H * x_f * x_f).sqrt();
  Y = slope.value * root;
  if (by_p == nullptr) return true;
  by_p->resize(X.size(), 2);
  by_p->col(0) =
      slope.by_zeta * root + slope.value * (along * at.G_slope * x_f + at.H * at.H_slope * x_f * x_f) / root;
  by_p->col(1) = slope.value * (along * at.G + at.H * at.H * x_f) / root;
  return true;
}

std::string wrong(const ResonancePairs& pairs) {
  const std::string bad = first_of(
      {unless_equal("response and excitation", {pairs.response.size(), pairs.excitation.size()}),
       unless_positive("response", pairs.response), unless_positive("excitation", pairs.excitation)});
  if (!bad.empty()) return bad;
  const auto [least, most] = std::minmax_element(pairs.response.begin(), pairs.response.end());
  if (pairs.response.size() < 2 || *least == *most)
    return "at least two pairs of different response are needed";
  return "";
}

std::string unless_above_support(double slope, ResponseTo shaken_by) {
  if (shaken_by != ResponseTo::support || slope < 1.0) return "";
  return "a slope is " + number(slope) + ": a support moves by less than the mass it shakes at resonance";
}

std::string unless_underdamped(double slope, ResponseTo shaken_by) {
  if (std::string why = unless_above_support(slope, shaken_by); !why.empty()) return why;
  const double zeta = ratio_of(slope, shaken_by).value;
  if (zeta < 1.0) return "";
  return "a slope of " + number(slope) + " is that of a damping ratio of " + number(zeta) +
         ": it must be below 1";
}

// "" if the line rises by more than rounding, otherwise a sentence.
std::string unless_rising(const Eigen::VectorXd& X, const Eigen::VectorXd& Y, double slope,
                          ResponseTo shaken_by) {
  constexpr double kRounding = 1e-9;
  if (!(slope * (X.maxCoeff() - X.minCoeff()) > kRounding * Y.maxCoeff()))
    return "the excitation does not rise with the response: the slope of the line is " + number(slope);
  return unless_underdamped(slope, shaken_by);
}

std::string wrong(const ResonanceLines& lines, ResponseTo shaken_by) {
  const std::string bad =
      first_of({unless_equal("slope and intercept", {lines.slope.size(), lines.intercept.size()}),
                unless_positive("slope", lines.slope), unless_finite("intercept", lines.intercept)});
  if (!bad.empty()) return bad;
  if (lines.slope.empty()) return "there are no lines";
  return unless_above_support(*std::max_element(lines.slope.begin(), lines.slope.end()), shaken_by);
}

std::string wrong(const OneMass& known) {
  for (const auto& value : {known.mass, known.stiffness}) {
    if (value && !(std::isfinite(*value) && *value > 0.0))
      return "mass and stiffness must be positive and finite, but one is " + number(*value);
  }
  return "";
}

// c = 2 zeta sqrt(k m), F = k x_f
void add_forces(Identification& result, const OneMass& known, const std::string& suffix) {
  const auto value_of = [&](const std::string& name) {
    return std::find_if(result.estimates.begin(), result.estimates.end(),
                        [&](const Estimate& estimate) { return estimate.name == name; })
        ->value;
  };
  const std::string ratio = "damping_ratio" + suffix, displacement = "friction_displacement" + suffix;
  const std::string how = suffix.empty() ? "" : ", by the line";
  if (known.mass && known.stiffness) {
    const double impedance = std::sqrt(*known.stiffness * *known.mass);
    add_from(result,
             {.name = "damping" + suffix,
              .unit = "N s m-1",
              .long_name = "viscous damping" + how,
              .value = 2.0 * value_of(ratio) * impedance},
             {{ratio.c_str(), 2.0 * impedance}});
  }
  if (known.stiffness)
    add_from(result,
             {.name = "friction_force" + suffix,
              .unit = "N",
              .long_name = "Coulomb friction force" + how,
              .value = *known.stiffness * value_of(displacement)},
             {{displacement.c_str(), *known.stiffness}});
}

// zeta = slope / 2, x_f = intercept / (2 zeta G), G = sinh(pi zeta) / (cosh(pi zeta) - 1) = coth(pi zeta / 2)
void add_line(Identification& result, double slope, double intercept) {
  const double zeta = 0.5 * slope, tanh = std::tanh(0.5 * pi * zeta), x_f = intercept * tanh / slope;
  const double by_slope = 0.25 * pi * (1.0 - tanh * tanh) * intercept / slope - x_f / slope;
  add_from(result,
           {.name = "damping_ratio_line",
            .unit = "1",
            .long_name = "viscous damping ratio, by the line",
            .value = zeta},
           {{"slope", 0.5}});
  add_from(result,
           {.name = "friction_displacement_line",
            .unit = "m",
            .long_name = "friction force over stiffness, by the line",
            .value = x_f},
           {{"slope", by_slope}, {"intercept", tanh / slope}});
}

std::vector<Estimate> line_estimates(double slope, double intercept) {
  return {{.name = "slope", .unit = "1", .long_name = "slope of excitation over response", .value = slope},
          {.name = "intercept",
           .unit = "m",
           .long_name = "excitation where the line meets no response",
           .value = intercept}};
}
Estimate ratio_estimate(double zeta) {
  return {.name = "damping_ratio", .unit = "1", .long_name = "viscous damping ratio", .value = zeta};
}
Estimate displacement_estimate(double x_f) {
  return {.name = "friction_displacement",
          .unit = "m",
          .long_name = "friction force over stiffness",
          .value = x_f};
}

LeastSquaresFit fit_hyperbola(const Eigen::VectorXd& X, const Eigen::VectorXd& Y, ResponseTo shaken_by,
                              double slope, double intercept) {
  constexpr double kMost = 0.9;  // of zeta, to start from
  const double steep = shaken_by == ResponseTo::force ? slope : std::min(slope, kMost);
  const double zeta = std::min(ratio_of(steep, shaken_by).value, kMost);
  const double x_f = intercept / (slope * at_resonance(zeta).G);
  return least_squares(
      {{.name = "zeta", .start = zeta, .scale = zeta}, {.name = "x_f", .start = x_f, .scale = X.maxCoeff()}},
      [&](const Eigen::VectorXd& p, Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian) {
        if (!hyperbola(X, p, shaken_by, residuals, jacobian)) return false;
        residuals -= Y;
        return true;
      });
}

// If the friction is too large for the excitation, the mass stops in each half cycle, and neither form holds.
void note_stops(const Eigen::VectorXd& Y, double zeta, double x_f, ResponseTo shaken_by,
                Identification& result) {
  const double critical = periodic::critical_friction(1.0, zeta);
  const double g = shaken_by == ResponseTo::support ? std::sqrt(1.0 + 4.0 * zeta * zeta) : 1.0;
  const Index stopping = (x_f > critical * g * Y.array()).count();
  if (stopping > 0)
    result.notes.push_back(
        std::to_string(stopping) + " of " + std::to_string(Y.size()) +
        " pairs belong to a motion that stops in each half cycle, for which the formulas do not hold");
}

// The line takes the responses as exact. R^2 = 1 - |y - yhat|^2 / |y - mean y|^2
void note_scatter(const Eigen::VectorXd& Y, const LinearFit& line, Identification& result) {
  constexpr double kLeast = 0.95;
  const double explained = 1.0 - line.residuals.squaredNorm() / (Y.array() - Y.mean()).matrix().squaredNorm();
  if (explained >= kLeast) return;
  result.notes.push_back("the pairs scatter about the line with R^2 = " + number(explained) +
                         ": if the scatter comes from the response, slope and damping are too small, and "
                         "their intervals too narrow");
}

FittedRecord record_of(const ResonancePairs& pairs, const Eigen::VectorXd& fitted) {
  FittedRecord record{
      .name = "resonance", .over = "response", .over_unit = "m", .at = pairs.response, .series = {}};
  record.series = {{"excitation", "m", pairs.excitation, {fitted.begin(), fitted.end()}}};
  record.nrmse = nrmse(record.series);
  return record;
}

}  // namespace

Identification forced_resonance(const ResonancePairs& pairs, ResponseTo shaken_by, const OneMass& known) {
  if (const std::string why = first_of({wrong(pairs), wrong(known)}); !why.empty()) return no_result(why);
  const auto n = static_cast<Index>(pairs.response.size());
  const Eigen::VectorXd X = Eigen::Map<const Eigen::VectorXd>(pairs.response.data(), n);
  const Eigen::VectorXd Y = Eigen::Map<const Eigen::VectorXd>(pairs.excitation.data(), n);
  Eigen::MatrixXd A(n, 2);
  A << X, Eigen::VectorXd::Ones(n);
  const LinearFit line = linear_fit(A, Y, Eigen::VectorXd::Ones(n));
  if (const std::string why = unless_rising(X, Y, line.p[0], shaken_by); !why.empty()) return no_result(why);
  const LeastSquaresFit fit = fit_hyperbola(X, Y, shaken_by, line.p[0], line.p[1]);
  if (!fit.converged) return no_result("the fit of the hyperbola did not converge: " + fit.reason);
  const double line_variance = scatter(line.chi_squared, line.degrees_of_freedom, 0.0).variance;
  const Scatter s = scatter(fit.sum_of_squares(), static_cast<double>(n - 2), 0.0);
  Eigen::MatrixXd by_Y(4, n);
  by_Y.topRows(2) = std::sqrt(line_variance) * line.influence;
  by_Y.bottomRows(2) = std::sqrt(s.variance) * algebra::pseudo_inverse(fit.jacobian);
  Identification result;
  result.estimates = line_estimates(line.p[0], line.p[1]);
  result.estimates.push_back(ratio_estimate(fit.p[0]));
  result.estimates.push_back(displacement_estimate(fit.p[1]));
  result.covariance = by_Y * by_Y.transpose();
  result.degrees_of_freedom = s.degrees_of_freedom;
  result.iterations = fit.iterations;
  add_line(result, line.p[0], line.p[1]);
  add_forces(result, known, "");
  add_forces(result, known, "_line");
  note_scatter(Y, line, result);
  note_stops(Y, fit.p[0], fit.p[1], shaken_by, result);
  result.records = {record_of(pairs, fit.residuals + Y)};
  set_intervals(result);
  return result;
}

Identification forced_resonance(const ResonanceLines& lines, ResponseTo shaken_by, const OneMass& known) {
  if (const std::string why = first_of({wrong(lines, shaken_by), wrong(known)}); !why.empty())
    return no_result(why);
  const auto n = static_cast<Index>(lines.slope.size());
  Eigen::MatrixXd drawn(n, 2);
  drawn << Eigen::Map<const Eigen::VectorXd>(lines.slope.data(), n),
      Eigen::Map<const Eigen::VectorXd>(lines.intercept.data(), n);
  const Eigen::RowVector2d mean = drawn.colwise().mean();
  const Eigen::MatrixXd off = drawn.rowwise() - mean;
  const double each = scatter(1.0, static_cast<double>(n - 1), 0.0).variance / static_cast<double>(n);
  const double slope = mean[0], intercept = mean[1];
  if (const std::string why = unless_underdamped(slope, shaken_by); !why.empty()) return no_result(why);
  const Ratio zeta = ratio_of(slope, shaken_by);
  const AtResonance at = at_resonance(zeta.value);
  const double x_f = intercept / (slope * at.G);  // of the asymptote Y = slope (X + G x_f)
  Identification result;
  result.estimates = line_estimates(slope, intercept);
  result.covariance = each * off.transpose() * off;
  result.degrees_of_freedom = static_cast<double>(n - 1);
  add_from(result, ratio_estimate(zeta.value), {{"slope", zeta.by_slope}});
  add_from(result, displacement_estimate(x_f),
           {{"slope", -x_f / slope - x_f * at.G_slope * zeta.by_slope / at.G},
            {"intercept", 1.0 / (slope * at.G)}});
  add_line(result, slope, intercept);
  add_forces(result, known, "");
  add_forces(result, known, "_line");
  set_intervals(result);
  return result;
}

}  // namespace frahm::identification
