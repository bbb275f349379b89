#include "solvers/quantities/quantity_values.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/coordinates.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/quantities/fundamental_response.hpp"

namespace frahm::periodic::value {
namespace {

bool has_no_reference(const Measured& m) {
  return m.half_period && m.system->reference_order % 2 == 0;
}

// X_n of a mass or signal by its row in the Gram matrix.
std::complex<double> reference_component(const Measured& m, Eigen::Index row) {
  if (has_no_reference(m)) return 0.0;
  const Eigen::Index first = m.oscillators() + 1 + 2 * reference_column(*m.system);
  return {2.0 / m.period * m.gram(row, first), -2.0 / m.period * m.gram(row, first + 1)};
}

// The larger of what is put in, without regard to its sign, and what is dissipated.
double energy_of_period(const Measured& m) {
  return std::max(m.input_size, m.dissipated);
}

// Integral of c v^2, of s^2 / c in a damper through which a force s runs, and friction's.
double loss(const Measured& m, std::size_t element) {
  const mechanics::ElementCoefficients& law = m.system->coefficients[element];
  double energy = m.friction_loss[element];
  if (law.damping != 0.0) energy += law.damping * square_of_velocity(m, m.assembly->incidences()[element]);
  if (law.internal_damping > 0.0) {
    const Eigen::Index row = 2 * m.masses() + law.internal;
    energy += m.gram(row, row) / law.internal_damping;
  }
  return energy;
}

mechanics::Incidence coordinate_of(const Measured& m, const Asked& asked) {
  return mechanics::coordinate_incidence(m.assembly->network(), asked.quantity.index);
}

const ContactHistory& history(const Measured& m, const Asked& asked) {
  return m.histories[m.assembly->shares()[asked.quantity.index].contact];
}

}  // namespace

double integral(const mechanics::Incidence& at, const Eigen::MatrixXd& gram, const Eigen::MatrixXd& motion,
                Eigen::Index oscillators, Eigen::Index k) {
  const auto column = gram.col(oscillators + k);
  double sum = at.w.dot(column.head(at.w.size()));
  for (Eigen::Index s = 0; s < at.p.size(); ++s) {
    if (at.p[s] != 0.0) sum += at.p[s] * motion.row(s).dot(column.segment(oscillators, motion.cols()));
  }
  return sum;
}

double joint_integral(const mechanics::Incidence& at, const JointRows& joints, const Eigen::MatrixXd& gram,
                      Eigen::Index column) {
  return at.j.dot(joints.displacement * gram.col(column).head(joints.displacement.cols()));
}

Eigen::VectorXd velocity_row(const Measured& m, const mechanics::Incidence& at,
                             const Eigen::MatrixXd& motion_velocity, const JointRows& joints) {
  const Eigen::Index n = m.masses(), first = m.oscillators();
  Eigen::VectorXd f = Eigen::VectorXd::Zero(m.gram.rows());
  f.segment(n, n) = at.w;
  f.segment(first, motion_velocity.cols()) = motion_velocity.transpose() * at.p;
  f.head(joints.velocity.cols()) += joints.velocity.transpose() * at.j;
  return f;
}

std::complex<double> reference_component(const Measured& m, const mechanics::Incidence& at) {
  if (has_no_reference(m)) return 0.0;
  const Eigen::Index cosine = 1 + 2 * reference_column(*m.system);
  const auto of = [&](Eigen::Index k) {
    const double sum = integral(at, m.gram, m.motion, m.oscillators(), k);
    return at.has_joint() ? sum + joint_integral(at, m.joints, m.gram, m.oscillators() + k) : sum;
  };
  return {2.0 / m.period * of(cosine), -2.0 / m.period * of(cosine + 1)};
}

// Coordinates of different units are compared as sqrt(m_i) x_i: a node may stand still, by symmetry or for
// want of any connection, while others move.
bool is_rounding(const Measured& m, const Asked& asked, std::complex<double> component) {
  constexpr double kRounding = 1e-12;
  const Eigen::VectorXd& w = m.trace(asked).at.w;
  const Eigen::ArrayXd mass = m.system->M.diagonal().array();
  const double moving = (mass * m.gram.diagonal().head(w.size()).array() / m.period).sqrt().maxCoeff();
  const double at_node = (w.array().abs() / mass.sqrt()).maxCoeff() * moving;
  return std::abs(component) <= kRounding * std::max(at_node, m.extremes[asked.trace].magnitude());
}

double square_of_velocity(const Measured& m, const mechanics::Incidence& at) {
  if (at.has_joint()) {
    const Eigen::VectorXd f = velocity_row(m, at, m.motion_velocity, m.joints);
    return f.dot(m.gram * f);
  }
  const Eigen::Index n = m.masses(), first = m.oscillators(), count = m.motion_velocity.cols();
  double sum = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (at.w[i] != 0.0) sum += at.w[i] * at.w.dot(m.gram.col(n + i).segment(n, n));
  }
  for (Eigen::Index s = 0; s < at.p.size(); ++s) {
    if (at.p[s] == 0.0) continue;
    for (Eigen::Index k = 0; k < count; ++k) {
      const auto column = m.gram.col(first + k);
      double with_k = 2.0 * at.w.dot(column.segment(n, n));
      for (Eigen::Index r = 0; r < at.p.size(); ++r) {
        if (at.p[r] != 0.0) with_k += at.p[r] * m.motion_velocity.row(r).dot(column.segment(first, count));
      }
      sum += at.p[s] * m.motion_velocity(s, k) * with_k;
    }
  }
  return sum;
}

void tell_together(const mechanics::Network& network, std::vector<double>& of_elements) {
  for (std::size_t e = 0; e < of_elements.size(); ++e) {
    if (network.elements[e].parts == 0)
      of_elements[mechanics::reported_by(network, e)] += std::exchange(of_elements[e], 0.0);
  }
}

void add_up_friction(Measured& m) {
  m.friction_loss.assign(m.system->coefficients.size(), 0.0);
  for (std::size_t e = 0; e < m.friction_loss.size(); ++e) {
    const double force = m.system->coefficients[e].friction;
    if (force != 0.0)
      m.friction_loss[e] = force * m.histories[m.assembly->shares()[e].contact].sliding_distance;
  }
}

void add_up_losses(Measured& m) {
  m.loss.resize(m.system->coefficients.size());
  m.dissipated = m.structural_loss;
  for (std::size_t e = 0; e < m.loss.size(); ++e) m.loss[e] = loss(m, e);
  for (std::size_t j = 0; j < m.bend_loss.size(); ++j) m.loss[m.system->bends.element[j]] += m.bend_loss[j];
  tell_together(m.assembly->network(), m.loss);
  for (const double of_element : m.loss) m.dissipated += of_element;
}

Eigen::MatrixXd velocity_rows(const Measured& m, const Eigen::MatrixXd& motion_velocity) {
  const Eigen::Index n = m.masses(), p = motion_velocity.rows();
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(n + 1 + p, m.gram.cols());
  F.block(0, n, n, n).setIdentity();
  if (p > 0) F.block(n + 1, m.oscillators(), p, motion_velocity.cols()) = motion_velocity;
  return F;
}

// The integral of v^T S v.
double structural_loss(const Measured& m) {
  const Eigen::MatrixXd& S = m.system->structural_damping;
  if (S.size() == 0) return 0.0;
  const Eigen::MatrixXd F = velocity_rows(m, m.motion_velocity);
  return S.cwiseProduct(F * m.gram * F.transpose()).sum();
}

double least_dissipation(const Measured& m) {
  return 1e-26 * m.static_norm * m.static_norm;
}

double amplitude(const Measured& m, const Asked& asked) {
  return 0.5 * (m.extremes[asked.trace].most - m.extremes[asked.trace].least);
}

double peak(const Measured& m, const Asked& asked) {
  return m.extremes[asked.trace].peak(asked.quantity.side);
}

double peak_phase(const Measured& m, const Asked& asked) {
  const double phase = m.extremes[asked.trace].most_phase;
  return std::isnan(phase) ? 0.0 : phase;  // 0: at rest all the time
}

double mean(const Measured& m, const Asked& asked) {
  return m.half_period ? 0.0 : m.gram(m.row_of(asked), m.oscillators()) / m.period;
}

double drift(const Measured& m, const Asked& asked) {
  return m.drift.size() > 0 ? coordinate_of(m, asked).w.dot(m.drift) : 0.0;
}

double mean_velocity(const Measured& m, const Asked& asked) {
  return drift(m, asked) * m.multiple / m.period;
}

double rms(const Measured& m, const Asked& asked) {
  const Eigen::Index row = m.row_of(asked);
  return std::sqrt(m.gram(row, row) / m.period);
}

// x_n = |X_n| cos(n omega t - phase); NaN where there is none.
double phase(const Measured& m, const Asked& asked) {
  const std::complex<double> component = value::reference_component(m, m.trace(asked).at);
  return is_rounding(m, asked, component) ? kNone : -std::arg(component);
}

double harmonic(const Measured& m, const Asked& asked) {
  return std::abs(reference_component(m, m.row_of(asked)));
}

double magnification(const Measured& m, const Asked& asked) {
  return ratio(harmonic(m, asked), static_displacement(*m.system, coordinate_of(m, asked)));
}

double transmissibility(const Measured& m, const Asked& asked) {
  return ratio(harmonic(m, asked), support_amplitude(*m.system));
}

double energy(const Measured& m, const Asked& asked) {
  return m.loss[asked.quantity.index];
}

double energy_share(const Measured& m, const Asked& asked) {
  return m.dissipated > least_dissipation(m) ? energy(m, asked) / m.dissipated : 0.0;
}

double damping_energy(const Measured& m, const Asked&) {
  return m.structural_loss;
}

double damping_energy_share(const Measured& m, const Asked&) {
  return m.dissipated > least_dissipation(m) ? m.structural_loss / m.dissipated : 0.0;
}

double stops(const Measured& m, const Asked& asked) {
  return history(m, asked).stops;
}

double reversals(const Measured& m, const Asked& asked) {
  return history(m, asked).reversals;
}

double stuck_fraction(const Measured& m, const Asked& asked) {
  return history(m, asked).stuck_fraction;
}

double regime(const Measured& m, const Asked& asked) {
  const double force = m.system->coefficients[asked.quantity.index].static_friction;
  return static_cast<double>(regime_of(force, history(m, asked)));
}

double slipping(const Measured& m, const Asked& asked) {
  const std::size_t first = asked.quantity.index;
  int count = 0;
  for (std::size_t e = first; e < first + m.assembly->network().elements[first].parts; ++e) {
    const double force = m.system->coefficients[e].static_friction;
    if (regime_of(force, m.histories[m.assembly->shares()[e].contact]) != Regime::stuck) ++count;
  }
  return count;
}

double status(const Measured& m, const Asked&) {
  return static_cast<double>(m.status);
}

double coexisting(const Measured& m, const Asked&) {
  return m.coexisting;
}

double period_multiple(const Measured& m, const Asked&) {
  return m.multiple;
}

double unsettled(const Measured& m, const Asked&) {
  return m.unsettled;
}

double continuum(const Measured& m, const Asked&) {
  return m.free_sliders;
}

double floquet_radius(const Measured& m, const Asked&) {
  return m.floquet_radius;
}

double energy_input(const Measured& m, const Asked&) {
  return m.input;
}

// If nothing moves, both are rounding of the forcing's energy; if nothing that moves is strained, both are
// the closure error of the orbit's own energy.
double energy_balance(const Measured& m, const Asked&) {
  const double size = energy_of_period(m);
  const double closing = 1e-13 + 100.0 * m.residual;
  const double rounding =
      std::max(1e-11 * m.static_norm * m.static_norm, closing * m.state_norm * m.state_norm);
  return size > rounding ? std::abs(m.input - m.dissipated) / size : 0.0;
}

// The work of a force is rounded to a part of the work it would do on the whole displacement, however little
// of it the mass moves.
bool is_balanced(double missing, double energies, double energy) {
  constexpr double kBalanced = 1e-9;
  constexpr double kWorkRounding = 1e-14;
  return missing <= kBalanced * energies + kWorkRounding * energy * energy;
}

bool is_balanced(const Measured& m) {
  const double energies = energy_of_period(m);
  return is_balanced(energy_balance(m, {}) * energies, energies, std::max(m.static_norm, m.state_norm));
}

double force_transmissibility(const Measured& m, const Asked&) {
  Eigen::VectorXcd X(m.masses());
  for (Eigen::Index i = 0; i < X.size(); ++i) X[i] = reference_component(m, i);
  return periodic::force_transmissibility(*m.system, X);
}

double residual(const Measured& m, const Asked&) {
  return m.residual;
}

double error_bound(const Measured& m, const Asked&) {
  return m.error_bound;
}

double newton_iterations(const Measured& m, const Asked&) {
  return m.newton_iterations;
}

double events(const Measured& m, const Asked&) {
  return m.events;
}

double natural_frequency(const Measured& m, const Asked& asked) {
  return m.natural_frequency[asked.quantity.index];
}

double modal_damping(const Measured& m, const Asked& asked) {
  return m.modal_damping[asked.quantity.index];
}

}  // namespace frahm::periodic::value
