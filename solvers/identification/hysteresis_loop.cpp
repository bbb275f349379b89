#include "solvers/identification/hysteresis_loop.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solvers/algebra/no_value.hpp"
#include "solvers/identification/fourier_fit.hpp"
#include "solvers/identification/statement.hpp"

namespace frahm::identification {
namespace {

using Index = Eigen::Index;
using std::numbers::pi;

std::string wrong(const LoopTraces& traces) {
  const std::size_t n = traces.time.size();
  const std::string bad = first_of(
      {unless_equal("time, displacement and force", {n, traces.displacement.size(), traces.force.size()}),
       unless_finite("time", traces.time), unless_finite("displacement", traces.displacement),
       unless_finite("force", traces.force)});
  if (!bad.empty()) return bad;
  constexpr std::size_t kLeast = 8;
  if (n < kLeast) return "the loop has " + std::to_string(n) + " samples: at least 8 are needed";
  for (std::size_t i = 1; i < n; ++i) {
    if (!(traces.time[i] > traces.time[i - 1]))
      return "time " + std::to_string(i + 1) + " is " + number(traces.time[i]) + " s after " +
             number(traces.time[i - 1]) + " s: times must increase";
  }
  return "";
}

// Indices of the coefficients of displacement, then force, then omega.
struct Unknowns {
  const FourierFit &x, &F;
  Index size() const { return x.coefficients.size() + F.coefficients.size() + 1; }
  Index a(int n) const { return 2 * n - 1; }
  Index b(int n) const { return 2 * n; }
  Index p(int n) const { return x.coefficients.size() + 2 * n - 1; }
  Index q(int n) const { return x.coefficients.size() + 2 * n; }
  Index omega() const { return size() - 1; }

  Eigen::MatrixXd covariance(double omega_variance) const {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(size(), size());
    const Index first = x.coefficients.size(), second = F.coefficients.size();
    all.topLeftCorner(first, first) = x.covariance;
    all.block(first, first, second, second) = F.covariance;
    Eigen::VectorXd by_omega(size());
    by_omega << x.by_omega, F.by_omega, 1.0;
    return all + omega_variance * by_omega * by_omega.transpose();
  }
};

struct Quantity {
  double value;
  Eigen::VectorXd slope;  // by the unknowns
};

// W = oint F dx = pi sum_n n (p_n b_n - q_n a_n), F = sum p cos + q sin, x = sum a cos + b sin
Quantity energy_loss(const Unknowns& u) {
  Quantity W{0.0, Eigen::VectorXd::Zero(u.size())};
  for (int n = 1; n <= std::min(u.x.harmonics, u.F.harmonics); ++n) {
    W.value += pi * n * (u.F.a(n) * u.x.b(n) - u.F.b(n) * u.x.a(n));
    W.slope[u.a(n)] = -pi * n * u.F.b(n);
    W.slope[u.b(n)] = pi * n * u.F.a(n);
    W.slope[u.p(n)] = pi * n * u.x.b(n);
    W.slope[u.q(n)] = -pi * n * u.x.a(n);
  }
  return W;
}

// What a damper of 1 N s/m loses: oint v dx = pi omega sum_n n^2 (a_n^2 + b_n^2)
Quantity viscous_loss(const Unknowns& u) {
  Quantity V{0.0, Eigen::VectorXd::Zero(u.size())};
  for (int n = 1; n <= u.x.harmonics; ++n) {
    const double a = u.x.a(n), b = u.x.b(n), factor = pi * u.x.omega * n * n;
    V.value += factor * (a * a + b * b);
    V.slope[u.a(n)] = 2.0 * factor * a;
    V.slope[u.b(n)] = 2.0 * factor * b;
  }
  V.slope[u.omega()] = V.value / u.x.omega;
  return V;
}

// k = (p_1 a_1 + q_1 b_1) / (a_1^2 + b_1^2)
Quantity storage_stiffness(const Unknowns& u) {
  const double a = u.x.a(1), b = u.x.b(1), p = u.F.a(1), q = u.F.b(1), squared = a * a + b * b;
  Quantity k{(p * a + q * b) / squared, Eigen::VectorXd::Zero(u.size())};
  k.slope[u.a(1)] = (p - 2.0 * a * k.value) / squared;
  k.slope[u.b(1)] = (q - 2.0 * b * k.value) / squared;
  k.slope[u.p(1)] = a / squared;
  k.slope[u.q(1)] = b / squared;
  return k;
}

// The series of the displacement, and its derivatives by the phase.
double displacement_at(const FourierFit& x, double phase, int derivative) {
  double sum = derivative == 0 ? x.a(0) : 0.0;
  for (int n = 1; n <= x.harmonics; ++n) {
    const double turned = n * phase + 0.5 * pi * derivative;
    sum += std::pow(n, derivative) * (x.a(n) * std::cos(turned) + x.b(n) * std::sin(turned));
  }
  return sum;
}

// Phase of the largest value of sign x: the best of a fine grid, then Newton's steps.
double phase_of_extreme(const FourierFit& x, double sign) {
  const int places = 64 * x.harmonics;
  double best = 0.0;
  for (int i = 1; i < places; ++i) {
    const double phase = 2.0 * pi * i / places;
    if (sign * displacement_at(x, phase, 0) > sign * displacement_at(x, best, 0)) best = phase;
  }
  constexpr int kSteps = 8;
  for (int i = 0; i < kSteps; ++i) {
    const double bend = displacement_at(x, best, 2), step = displacement_at(x, best, 1) / bend;
    if (!(sign * bend < 0.0) || !(std::abs(step) < 2.0 * pi / places)) break;
    best -= step;
  }
  return best;
}

// X = (max - min) / 2, stationary in the phases of both.
Quantity amplitude(const Unknowns& u) {
  const double top = phase_of_extreme(u.x, 1.0), bottom = phase_of_extreme(u.x, -1.0);
  Quantity X{0.5 * (displacement_at(u.x, top, 0) - displacement_at(u.x, bottom, 0)),
             Eigen::VectorXd::Zero(u.size())};
  for (int n = 1; n <= u.x.harmonics; ++n) {
    X.slope[u.a(n)] = 0.5 * (std::cos(n * top) - std::cos(n * bottom));
    X.slope[u.b(n)] = 0.5 * (std::sin(n * top) - std::sin(n * bottom));
  }
  return X;
}

FittedRecord record_of(const LoopTraces& traces, const FourierFit& x, const FourierFit& F) {
  FittedRecord record{.name = "loop", .over = "time", .over_unit = "s", .at = traces.time, .series = {}};
  record.series = {{"displacement", "m", traces.displacement, {x.fitted.begin(), x.fitted.end()}},
                   {"force", "N", traces.force, {F.fitted.begin(), F.fitted.end()}}};
  record.nrmse = nrmse(record.series);
  return record;
}

void set_estimates(const Unknowns& u, double omega_variance, Identification& result) {
  const Quantity W = energy_loss(u), X = amplitude(u), k = storage_stiffness(u), V = viscous_loss(u);
  result.estimates = {
      {.name = "energy_loss", .unit = "J", .long_name = "energy lost in a cycle", .value = W.value},
      {.name = "amplitude", .unit = "m", .long_name = "half the stroke", .value = X.value},
      {.name = "storage_stiffness", .unit = "N m-1", .long_name = "stiffness in phase", .value = k.value},
      {.name = "equivalent_damping",
       .unit = "N s m-1",
       .long_name = "viscous damping with the same loss",
       .value = W.value / V.value},
      {.name = "frequency",
       .unit = "rad s-1",
       .long_name = "frequency of the vibration",
       .value = u.x.omega}};
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(5, u.size());
  slopes.row(0) = W.slope;
  slopes.row(1) = X.slope;
  slopes.row(2) = k.slope;
  slopes.row(3) = (W.slope - W.value / V.value * V.slope) / V.value;
  slopes(4, u.omega()) = 1.0;
  result.covariance = slopes * u.covariance(omega_variance) * slopes.transpose();
  // eta = W / (2 pi U), U = k X^2 / 2;  F = W / (4 X)
  const double eta = W.value / (pi * k.value * X.value * X.value), friction = W.value / (4.0 * X.value);
  add_from(result, {.name = "loss_factor", .unit = "1", .long_name = "loss factor", .value = eta},
           {{"energy_loss", 1.0 / (pi * k.value * X.value * X.value)},
            {"storage_stiffness", -eta / k.value},
            {"amplitude", -2.0 * eta / X.value}});
  add_from(result,
           {.name = "equivalent_friction",
            .unit = "N",
            .long_name = "Coulomb friction force with the same loss",
            .value = friction},
           {{"energy_loss", 0.25 / X.value}, {"amplitude", -friction / X.value}});
}

// A stiffness that may be zero cannot be a divisor. Intervals must be there.
void check_loss(double force, Identification& result) {
  constexpr double kRounding = 1e-9;
  const auto find = [&](const char* name) {
    return std::find_if(result.estimates.begin(), result.estimates.end(),
                        [&](const Estimate& estimate) { return estimate.name == name; });
  };
  const auto k = find("storage_stiffness"), X = find("amplitude"), W = find("energy_loss");
  if (W->value < 0.0 && !(W->high > 0.0))
    result.notes.push_back(
        "the loop runs the other way: does the force have the sign of a force that opposes the motion?");
  const bool none = std::abs(k->value) * X->value <= kRounding * force;
  if (!none && !(k->low <= 0.0 && k->high >= 0.0)) return;
  const Index loss = find("loss_factor") - result.estimates.begin();
  result.covariance.row(loss).setConstant(kNone);
  result.covariance.col(loss).setConstant(kNone);
  result.covariance(loss, loss) = kInfinity;
  result.notes.push_back("the storage stiffness may be zero: the loss factor is not determined");
  set_intervals(result);
}

}  // namespace

Identification hysteresis_loop(const LoopTraces& traces) {
  if (const std::string why = wrong(traces); !why.empty()) return no_result(why);
  const auto n = static_cast<Index>(traces.time.size());
  const double middle = 0.5 * (traces.time.front() + traces.time.back()),
               duration = traces.time.back() - traces.time.front();
  const Eigen::VectorXd time = Eigen::Map<const Eigen::VectorXd>(traces.time.data(), n).array() - middle;
  const Eigen::Map<const Eigen::VectorXd> displacement(traces.displacement.data(), n),
      force(traces.force.data(), n);
  if (displacement.maxCoeff() == displacement.minCoeff())
    return no_result("the displacement does not change");
  const double start = crossing_frequency(time, displacement);
  if (start == 0.0)
    return no_result(
        "the displacement does not pass its middle upwards twice, so the frequency cannot be found: a record "
        "of at least two periods is needed");
  const double spacing = duration / static_cast<double>(n - 1);
  constexpr double kLeastPeriods = 1.0, kMostOmega = pi / 2.0;  // four samples a period
  if (start * (duration + spacing) < 2.0 * pi * kLeastPeriods * (1.0 - 1e-6) || start * spacing > kMostOmega)
    return no_result("the record of " + number(duration) + " s and " + std::to_string(n) + " samples has " +
                     number(start * duration / (2.0 * pi)) + " periods of " + number(start) +
                     " rad/s: it needs at least one, with four samples in each");
  const FourierFit x = fourier_fit_from(time, displacement, start);
  const FourierFit F = fourier_fit(time, force, x.omega);
  Identification result;
  result.degrees_of_freedom = std::min(x.degrees_of_freedom, F.degrees_of_freedom);
  set_estimates({x, F}, x.omega_variance, result);
  result.records = {record_of(traces, x, F)};
  set_intervals(result);
  check_loss(force.cwiseAbs().maxCoeff(), result);
  return result;
}

}  // namespace frahm::identification
