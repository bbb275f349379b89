#include "solvers/quantities/quantity_derivatives.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/coordinates.hpp"
#include "solvers/quantities/fundamental_response.hpp"
#include "solvers/quantities/quantity_values.hpp"

namespace frahm::periodic::derivative_of {
namespace {

constexpr const char* kNoComponent = "there is no component at the reference order";

Derivative none(const char* reason) {
  return {.why_none = reason};
}

// The candidates that are, or tie for, an extreme must agree; otherwise the extreme has a kink.
Derivative extreme(const Measured& m, D by, std::size_t trace, Side side) {
  constexpr double kAgree = 1e-7;          // of derivatives that are one but for rounding
  if (m.half_period) side = Side::either;  // both sides are alike
  const Extremes& found = m.extremes[trace];
  double state_change = 0.0;  // of the orbit at the extremes
  double smallest = kInfinity, largest = -smallest;
  const auto include = [&](double value) {
    smallest = std::min(smallest, value);
    largest = std::max(largest, value);
  };
  for (std::size_t i = 0; i < m.candidates[trace].size(); ++i) {
    const Candidate& candidate = m.candidates[trace][i];
    const bool at_most = is_most(candidate, found, side), at_least = is_least(candidate, found, side);
    if (!at_most && !at_least) continue;
    const CandidateDerivative& its = by.candidates[trace][i];
    state_change = std::max(state_change, its.state);
    if (at_most) include(its.value);
    if (at_least) include(-its.value);
  }
  // Where the extreme itself is stationary in the parameter its derivative is rounding of the state's.
  const double size = std::max({std::abs(largest), std::abs(smallest), found.magnitude() * state_change});
  if (largest - smallest > kAgree * size) return none("two extremes tie: it has a kink here");
  return {0.5 * (largest + smallest)};
}

struct Component {
  std::complex<double> value, by;
};

// X_n = 2/T integral of x (cos - i sin):  dX = 2/T d(integral) - X dT/T
Component component(const Measured& m, D d, const mechanics::Incidence& at) {
  Component X{value::reference_component(m, at), 0.0};
  if (m.half_period && m.system->reference_order % 2 == 0) return X;
  const Eigen::Index first = m.oscillators(), cosine = 1 + 2 * reference_column(*m.system);
  const auto changed = [&](Eigen::Index k) {
    double sum = value::integral(at, d.gram, m.motion, first, k);
    const auto column = m.gram.col(first + k).segment(first, m.motion.cols());
    for (Eigen::Index s = 0; s < at.p.size(); ++s) {
      if (at.p[s] != 0.0) sum += at.p[s] * d.motion.row(s).dot(column);
    }
    if (at.has_joint()) {
      sum += value::joint_integral(at, m.joints, d.gram, first + k) +
             value::joint_integral(at, d.joints, m.gram, first + k);
    }
    return 2.0 / m.period * sum;
  };
  X.by = std::complex<double>(changed(cosine), -changed(cosine + 1)) - d.log_period * X.value;
  return X;
}

// |X| / below
Derivative harmonic_over(const Measured& m, D d, const Asked& asked, double below, double below_by) {
  const auto [X, X_by] = component(m, d, m.trace(asked).at);
  if (value::is_rounding(m, asked, X)) return none(kNoComponent);
  if (!(below > 0.0)) return none("it has no value");
  return {(modulus_derivative(X, X_by) - std::abs(X) / below * below_by) / below};
}

// d of the integral of (w^T v + p^T y')^2
double square_of_velocity(const Measured& m, D d, const mechanics::Incidence& at) {
  const Eigen::Index n = m.masses(), first = m.oscillators();
  if (at.has_joint()) {
    const Eigen::VectorXd row = value::velocity_row(m, at, m.motion_velocity, m.joints);
    Eigen::VectorXd row_by = value::velocity_row(m, at, d.motion_velocity, d.joints);
    row_by.segment(n, n) -= at.w;  // which does not change
    return row.dot(d.gram * row) + 2.0 * row_by.dot(m.gram * row);
  }
  Eigen::VectorXd f = Eigen::VectorXd::Zero(m.gram.rows()), f_by = f;
  f.segment(n, n) = at.w;
  if (at.p.size() > 0) {
    f.segment(first, m.motion.cols()) = m.motion_velocity.transpose() * at.p;
    f_by.segment(first, m.motion.cols()) = d.motion_velocity.transpose() * at.p;
  }
  return f.dot(d.gram * f) + 2.0 * f_by.dot(m.gram * f);
}

// For the integrals of c v^2 and s^2 / c, and of friction times the distance slid.
double loss(const Measured& m, D d, std::size_t e) {
  const mechanics::ElementCoefficients &law = m.system->coefficients[e], &law_by = d.system->coefficients[e];
  double by = 0.0;
  if (law_by.damping != 0.0) by += law_by.damping * value::square_of_velocity(m, m.assembly->incidences()[e]);
  if (law.damping != 0.0) by += law.damping * square_of_velocity(m, d, m.assembly->incidences()[e]);
  if (law.internal_damping > 0.0) {
    const Eigen::Index row = 2 * m.masses() + law.internal;
    const double lost = m.gram(row, row) / law.internal_damping;
    by += (d.gram(row, row) - lost * law_by.internal_damping) / law.internal_damping;
  }
  if (law.friction != 0.0 || law_by.friction != 0.0) {
    const std::size_t contact = m.assembly->shares()[e].contact;
    by += law_by.friction * m.histories[contact].sliding_distance +
          law.friction * d.contacts[contact].sliding_distance;
  }
  return by;
}

// d of the integral of v^T S v with v = F y:  tr(dS F G F^T + S F dG F^T + 2 S dF G F^T)
double structural_loss(const Measured& m, D d) {
  const Eigen::MatrixXd &S = m.system->structural_damping, &S_by = d.system->structural_damping;
  if (S.size() == 0) return 0.0;
  const Eigen::MatrixXd F = value::velocity_rows(m, m.motion_velocity);
  const double by =
      S_by.cwiseProduct(F * m.gram * F.transpose()).sum() + S.cwiseProduct(F * d.gram * F.transpose()).sum();
  if (m.motion_velocity.rows() == 0) return by;
  Eigen::MatrixXd F_by = value::velocity_rows(m, d.motion_velocity);
  F_by.topRows(m.masses()).setZero();
  return by + 2.0 * S.cwiseProduct(F_by * m.gram * F.transpose()).sum();
}

Derivative of_mode(double by) {
  return std::isnan(by) ? none("two modes have the same frequency") : Derivative{by};
}

}  // namespace

void add_up_losses(const Measured& m, MeasuredDerivative& d) {
  d.loss.resize(m.loss.size());
  d.structural_loss = structural_loss(m, d);
  d.dissipated = d.structural_loss;
  for (std::size_t e = 0; e < d.loss.size(); ++e) d.loss[e] = loss(m, d, e);
  for (std::size_t j = 0; j < d.bend_loss.size(); ++j) d.loss[m.system->bends.element[j]] += d.bend_loss[j];
  value::tell_together(m.assembly->network(), d.loss);
  for (const double of_element : d.loss) d.dissipated += of_element;
}

// (most - least) / 2
Derivative amplitude(const Measured& m, D d, const Asked& asked) {
  const Derivative most = extreme(m, d, asked.trace, Side::most);
  const Derivative least = extreme(m, d, asked.trace, Side::least);
  if (*most.why_none != '\0') return most;
  if (*least.why_none != '\0') return least;
  return {0.5 * (most.value + least.value)};
}

Derivative peak(const Measured& m, D d, const Asked& asked) {
  return extreme(m, d, asked.trace, asked.quantity.side);
}

Derivative peak_phase(const Measured& m, D d, const Asked& asked) {
  const Extremes& found = m.extremes[asked.trace];
  const double most = m.half_period ? found.magnitude() : found.most;
  const CandidateDerivative* at_peak = nullptr;
  for (std::size_t i = 0; i < m.candidates[asked.trace].size(); ++i) {
    const Candidate& candidate = m.candidates[asked.trace][i];
    const double value = m.half_period ? std::abs(candidate.value) : candidate.value;
    if (!candidate.reached || value < most - kTiedExtremes * std::abs(most)) continue;
    if (at_peak != nullptr) return none("two extremes tie: it has a jump here");
    at_peak = &d.candidates[asked.trace][i];
  }
  if (at_peak == nullptr) return none("the largest value is approached but never reached");
  return {at_peak->angle};
}

// G/T:  d = (dG - G dT/T) / T
Derivative mean(const Measured& m, D d, const Asked& asked) {
  if (m.half_period) return {0.0};
  const Eigen::Index row = m.row_of(asked), one = m.oscillators();
  return {(d.gram(row, one) - d.log_period * m.gram(row, one)) / m.period};
}

Derivative drift(const Measured& m, D d, const Asked& asked) {
  const Eigen::VectorXd& w = mechanics::coordinate_incidence(m.assembly->network(), asked.quantity.index).w;
  return {d.drift.size() > 0 ? w.dot(d.drift) : 0.0};
}

// d multiple/T:  d' = (dd - d dT/T) multiple/T
Derivative mean_velocity(const Measured& m, D d, const Asked& asked) {
  const double change = drift(m, d, asked).value - d.log_period * value::drift(m, asked);
  return {change * m.multiple / m.period};
}

// sqrt(G/T):  d = (dG - G dT/T) / (2 T rms)
Derivative rms(const Measured& m, D d, const Asked& asked) {
  const Eigen::Index row = m.row_of(asked);
  const double square = m.gram(row, row);
  if (!(square > 0.0)) return none("nothing moves");
  return {(d.gram(row, row) - d.log_period * square) / (2.0 * std::sqrt(square * m.period))};
}

// The phase lag is -arg X:  d = -Im(conj(X) dX) / |X|^2
Derivative phase(const Measured& m, D d, const Asked& asked) {
  const auto [X, X_by] = component(m, d, m.trace(asked).at);
  if (value::is_rounding(m, asked, X)) return none(kNoComponent);
  return {-(std::conj(X) * X_by).imag() / std::norm(X)};
}

Derivative harmonic(const Measured& m, D d, const Asked& asked) {
  return harmonic_over(m, d, asked, 1.0, 0.0);
}

Derivative magnification(const Measured& m, D d, const Asked& asked) {
  const mechanics::Incidence& at = m.trace(asked).at;
  const double below = static_displacement(*m.system, at);
  const double below_by = below > 0.0 ? static_displacement_derivative(*m.system, *d.system, at) : 0.0;
  return harmonic_over(m, d, asked, below, below_by);
}

Derivative transmissibility(const Measured& m, D d, const Asked& asked) {
  const double below = support_amplitude(*m.system);
  const double below_by = below > 0.0 ? support_amplitude_derivative(*m.system, *d.system) : 0.0;
  return harmonic_over(m, d, asked, below, below_by);
}

Derivative energy(const Measured&, D d, const Asked& asked) {
  return {d.loss[asked.quantity.index]};
}

Derivative energy_share(const Measured& m, D d, const Asked& asked) {
  if (!(m.dissipated > value::least_dissipation(m))) return none("nothing is dissipated");
  const std::size_t e = asked.quantity.index;
  return {(d.loss[e] - m.loss[e] / m.dissipated * d.dissipated) / m.dissipated};
}

Derivative damping_energy(const Measured&, D d, const Asked&) {
  return {d.structural_loss};
}

Derivative damping_energy_share(const Measured& m, D d, const Asked&) {
  if (!(m.dissipated > value::least_dissipation(m))) return none("nothing is dissipated");
  return {(d.structural_loss - m.structural_loss / m.dissipated * d.dissipated) / m.dissipated};
}

Derivative stuck_fraction(const Measured& m, D d, const Asked& asked) {
  return {d.contacts[m.assembly->shares()[asked.quantity.index].contact].stuck_fraction};
}

// Work in = energy lost, for every orbit.
Derivative energy_input(const Measured&, D d, const Asked&) {
  return {d.dissipated};
}

Derivative force_transmissibility(const Measured& m, D d, const Asked&) {
  Eigen::VectorXcd X(m.masses()), X_by(m.masses());
  for (Eigen::Index mass = 0; mass < X.size(); ++mass) {
    const mechanics::Incidence at =
        mechanics::coordinate_incidence(m.assembly->network(), static_cast<std::size_t>(mass));
    const Component its = component(m, d, at);
    X[mass] = its.value;
    X_by[mass] = its.by;
  }
  const double by = force_transmissibility_derivative(*m.system, *d.system, X, X_by);
  return std::isnan(by) ? none("no force is applied at the reference order") : Derivative{by};
}

Derivative natural_frequency(const Measured&, D d, const Asked& asked) {
  return of_mode(d.natural_frequency[asked.quantity.index]);
}

Derivative modal_damping(const Measured&, D d, const Asked& asked) {
  return of_mode(d.modal_damping[asked.quantity.index]);
}

}  // namespace frahm::periodic::derivative_of
