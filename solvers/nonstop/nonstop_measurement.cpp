// What follows from what the kernel told of a point: its measurements, error bound and quantities.
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "solvers/algebra/no_value.hpp"
#include "solvers/nonstop/nonstop_solver.hpp"
#include "solvers/orbits/orbit.hpp"
#include "solvers/orbits/phase.hpp"
#include "solvers/quantities/quantity_values.hpp"

namespace frahm::periodic::nonstop {

bool NonstopSolver::quantities(int lane, std::span<double> out) {
  measure(lane);
  if (request_.needs.input && !value::is_balanced(measured_)) return false;
  tell_values(request_, measured_, out);
  return true;
}

// sqrt(1/2 sum_k f_k^H K^-1 f_k), the constant included.
double NonstopSolver::static_norm(const mechanics::LinearSystem& system) const {
  double sum = system.constant_force.dot(K_inverse_ * system.constant_force);
  for (Eigen::Index k = 0; k < system.force.cols(); ++k) {
    for (Eigen::Index i = 0; i < K_inverse_.rows(); ++i) {
      for (Eigen::Index j = 0; j < K_inverse_.cols(); ++j) {
        sum += K_inverse_(i, j) * (system.force(i, k).real() * system.force(j, k).real() +
                                   system.force(i, k).imag() * system.force(j, k).imag());
      }
    }
  }
  return std::sqrt(0.5 * sum);
}

// From what the kernel told to what all quantities follow from.
void NonstopSolver::measure(int lane) {
  const mechanics::LinearSystem& system = systems_[size(lane)];
  Measured& m = measured_;
  m.system = &system;
  m.period = 2.0 * std::numbers::pi / system.omega;
  m.half_period = shape_.half_period;
  m.status = value_in_lane(pack_.margin, 0, lane) < kGrazing ? Status::grazing : Status::ok;
  m.newton_iterations = static_cast<int>(value_in_lane(pack_.newton_iterations, 0, lane));
  m.events = 0;
  m.extremes.resize(request_.traces.size());
  for (std::size_t t = 0; t < m.extremes.size(); ++t) {
    Extremes& x = m.extremes[t];
    x.most = value_in_lane(pack_.most, t, lane);
    x.least = value_in_lane(pack_.least, t, lane);
    if (!shape_.asks_phases) continue;
    x.most_phase = whole_turns_removed(value_in_lane(pack_.most_at, t, lane));
    x.least_phase = whole_turns_removed(shape_.half_period ? x.most_phase + std::numbers::pi
                                                           : value_in_lane(pack_.least_at, t, lane));
  }
  m.histories.resize(size(shape_.contacts));
  for (std::size_t j = 0; j < m.histories.size(); ++j) {
    m.histories[j] = {};
    m.histories[j].reversals = static_cast<int>(value_in_lane(pack_.contact_reversals, j, lane));
    m.events += m.histories[j].reversals;
    if (const double slides = value_in_lane(pack_.slides, 0, lane); slides < 1.0) {
      m.histories[j].stops = m.histories[j].reversals;  // one at each, or none where nothing moves
      m.histories[j].stuck_fraction = 1.0 - slides;
      m.events += m.histories[j].stops;  // with a release each
    }
    m.histories[j].sliding_distance = value_in_lane(pack_.slid, j, lane);
  }
  if (shape_.is_judged) {
    m.static_norm = static_norm(system);
    m.state_norm = value_in_lane(pack_.state_norm, 0, lane);
    m.residual = value_in_lane(pack_.residual, 0, lane) / std::max(m.state_norm, m.static_norm);
    m.floquet_radius = value_in_lane(pack_.multiplier, 0, lane);
    m.error_bound = error_bound(lane);
  }
  if (request_.needs.integrals) {
    const Eigen::Index first = m.oscillators();
    const auto oscillators = static_cast<Eigen::Index>(1 + 2 * system.orders.size());
    const Eigen::Index rows =
        first + oscillators + static_cast<Eigen::Index>(assembly_.network().signals.size());
    m.gram.setZero(rows, rows);
    for (std::size_t p = 0; p < entries_.size(); ++p) {
      const double integral = value_in_lane(pack_.integral, p, lane);
      m.gram(entries_[p].row, entries_[p].column) = m.gram(entries_[p].column, entries_[p].row) = integral;
    }
    for (Eigen::Index k = 0; k < oscillators; ++k)
      m.gram(first + k, first + k) = k == 0 ? m.period : 0.5 * m.period;
    set_motion(system);
  }
  m.input = m.input_size = 0.0;
  for (std::size_t p = 0; p < powers_.size(); ++p) {
    m.input += value_in_lane(pack_.work, p, lane);
    m.input_size += value_in_lane(pack_.work_size, p, lane);
  }
  if (!request_.needs.energies) return;
  value::add_up_friction(m);
  m.structural_loss = 0.0;
  for (std::size_t p = entries_.size(); p < products_.size(); ++p)
    m.structural_loss += value_in_lane(pack_.integral, p, lane);
  value::add_up_losses(m);
}

// Motion and velocity of the prescribed nodes as rows on the oscillators: Re(Y e^{i n phase}).
void NonstopSolver::set_motion(const mechanics::LinearSystem& system) {
  const auto oscillators = static_cast<Eigen::Index>(1 + 2 * system.orders.size());
  measured_.motion.setZero(system.constant_motion.size(), oscillators);
  measured_.motion_velocity.setZero(system.constant_motion.size(), oscillators);
  for (Eigen::Index p = 0; p < system.constant_motion.size(); ++p) {
    measured_.motion(p, 0) = system.constant_motion[p];
    for (std::size_t k = 0; k < system.orders.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      const std::complex<double> Y = system.motion(p, column);
      const std::complex<double> V = std::complex<double>(0.0, system.orders[k] * system.omega) * Y;
      measured_.motion(p, 1 + 2 * column) = Y.real();
      measured_.motion(p, 2 + 2 * column) = -Y.imag();
      measured_.motion_velocity(p, 1 + 2 * column) = V.real();
      measured_.motion_velocity(p, 2 + 2 * column) = -V.imag();
    }
  }
}

// As the certificate of any orbit (orbits/certificate.hpp): ||z - z*||_E <= (||r||_E + rounding) / (1 - L),
// |x_n| <= sqrt(2 (K^-1)_nn) ||z||_E. Rounding grows with the number of radians of the fastest mode and by
// way of the modes.
double NonstopSolver::error_bound(int lane) const {
  const mechanics::LinearSystem& system = systems_[size(lane)];
  const double contraction = value_in_lane(pack_.contraction, 0, lane),
               margin = value_in_lane(pack_.margin, 0, lane);
  const double scale = std::max(value_in_lane(pack_.state_norm, 0, lane), measured_.static_norm);
  const double friction = system.limit.dot(friction_norm_);
  const double radians = fastest_rate_ * measured_.period;
  const double operations = modes_.condition * modes_.condition * (16.0 + 2.0 * radians) +
                            16.0 * value_in_lane(pack_.reversals, 0, lane);
  const double rounding = std::numeric_limits<double>::epsilon() * operations *
                          (scale + friction + value_in_lane(pack_.parts, 0, lane));
  const double ball = (value_in_lane(pack_.residual, 0, lane) + rounding) / (1.0 - contraction);
  const bool holds = contraction < 1.0 && ball < 0.1 * margin * scale;
  return holds ? ball * displacement_of_energy_ : kNone;
}

}  // namespace frahm::periodic::nonstop
