#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "solvers/algebra/null_space.hpp"
#include "solvers/algebra/solve.hpp"
#include "solvers/flow/flow.hpp"
#include "solvers/mechanics/free_directions.hpp"

// Bodies of Flow: the equations of a system and of its forcing, with time counted in steps.
namespace frahm::periodic {

// How each contact's law acts on the flow.
template <int N, int H>
void set_laws(const mechanics::LinearSystem& system, StepEquations<N, H>& eq) {
  eq.holding = 0;
  eq.internal_of = system.contact_internal;
  for (std::size_t j = 0; j < system.law.size(); ++j) {
    if (system.law[j]->holds_velocity) eq.holding |= bit(static_cast<Eigen::Index>(j));
  }
}

template <int N, int H>
void set_bends(const mechanics::Bends& bends, StepEquations<N, H>& eq) {
  StepBends<N, H>& its = eq.bends;
  its.B = bends.W;
  its.MB = eq.M_inverse * its.B;
  its.stiffness = bends.stiffness;
  its.damping = bends.damping / eq.step;
  its.place = bends.place;
  its.of_velocity = its.pulling = its.jumping = 0;
  for (Eigen::Index j = 0; j < its.count(); ++j) {
    const laws::Bend& law = *bends.law[static_cast<std::size_t>(j)];
    if (law.of_velocity) {
      its.of_velocity |= bit(j);
      its.place[j] *= eq.step;
    } else if (its.damping[j] != 0.0) {
      its.jumping |= bit(j);
    }
    if (law.pulls || its.damping[j] == 0.0) its.pulling |= bit(j);
  }
}

// p^T y of the bends and its rates.
template <int N, int H>
void set_bend_motion(const mechanics::Bends& bends, StepEquations<N, H>& eq) {
  eq.bends.motion.noalias() = bends.W_support.transpose() * eq.motion;
  eq.bends.motion_velocity.noalias() = bends.W_support.transpose() * eq.motion_velocity;
  eq.bends.motion_acceleration.noalias() = bends.W_support.transpose() * eq.motion_acceleration;
}

// Whether stuck contacts can hold a further contact at rest: their directions are linearly dependent.
template <int N, int H>
bool holds_in_loops(const StepEquations<N, H>& eq) {
  Eigen::MatrixXd held(eq.masses(), count(eq.holding));
  Eigen::Index column = 0;
  for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
    if (eq.holds(j)) held.col(column++) = eq.W.col(j);
  }
  return column > 1 && algebra::null_space(held).cols() > 0;
}

template <int N, int H>
void Flow<N, H>::set_system(const mechanics::LinearSystem& system) {
  if (system.contacts() > kMostContacts)
    throw mechanics::MechanicsError(std::to_string(system.contacts()) +
                                    " contacts of the exact law: at most " + std::to_string(kMostContacts) +
                                    " can be followed");
  if (system.bends.count() > kMostContacts)
    throw mechanics::MechanicsError(std::to_string(system.bends.count()) +
                                    " stops and points of tables: at most " + std::to_string(kMostContacts) +
                                    " can be followed");
  fastest_rate_ = periodic::fastest_rate(system);
  if (!std::isfinite(fastest_rate_))
    throw mechanics::MechanicsError(
        "masses, stiffness and damping differ so much in size that the fastest motion has no finite rate");
  matrices_changed_ = true;
}

template <int N, int H>
void set_free(const mechanics::LinearSystem& system, StepEquations<N, H>& eq) {
  StepFree& free = eq.free;
  free.R = system.free_directions;
  if (!free.any()) return;
  free.along = free.R.transpose() * system.M;
  free.resisted = system.resisted;
  free.bent = mechanics::strained_along(eq.bends.B, free.R);
  for (Eigen::Index j = 0; j < free.bent.rows(); ++j) {
    if (contains(eq.bends.of_velocity, j)) free.bent.row(j).setZero();
  }
}

template <int N, int H>
void Flow<N, H>::scale_matrices(const mechanics::LinearSystem& system) {
  StepEquations<N, H>& eq = equations_;
  const double h = eq.step;
  eq.M = system.M / (h * h);
  eq.C = system.C / h;
  eq.K = system.K;
  eq.M_inverse = eq.M.inverse();
  eq.has_free_masses = system.free_directions.cols() > 0;
  eq.M_root = algebra::upper_root(eq.M);
  if (eq.has_free_masses) {
    eq.K_inverse = mechanics::held_compliance(system, 1.0 / h);
    // K + M R R^T M/h^2
    const Eigen::MatrixXd along = system.free_directions.transpose() * system.M / h;
    eq.K_root = algebra::upper_root(typename S::Square(eq.K + along.transpose() * along));
  } else {
    eq.K_inverse = eq.K.inverse();
    eq.K_root = algebra::upper_root(eq.K);
  }
  eq.M_root_inverse = eq.M_root.inverse();
  eq.K_root_inverse = eq.K_root.inverse();
  eq.W = system.W;
  eq.limit = system.limit;
  eq.static_limit = system.static_limit;
  eq.monotone = system.monotone;
  set_laws(system, eq);
  set_bends(system.bends, eq);
  eq.has_loops = holds_in_loops(eq);
  eq.D = system.D;
  eq.internal_stiffness = system.internal_stiffness;
  eq.internal_rate = h * system.internal_rate;
  eq.joints.B = system.joints.B;
  eq.joints.X = system.joints.X;
  set_free(system, eq);
  eq.MW = eq.M_inverse * eq.W;
  eq.mobility = eq.W.transpose() * eq.MW;
  eq.compliance = eq.mobility.diagonal();
  if constexpr (!S::is_fixed) {
    if (eq.is_large()) {
      eq.sparse = sparse_system(eq.M_inverse, eq.K, eq.C, eq.D, eq.W, eq.internal_rate);
      eq.bends.contact_pull = eq.W.transpose() * eq.bends.MB;
      eq.sparse.bend_directions = rows_alone(eq.bends.B.transpose());
      eq.sparse.bend_pull = rows_alone(eq.bends.MB.transpose());
      eq.sparse_rough = in_single_precision(eq.sparse);
    }
  }
  configuration_keys_.clear();
}

// r' = rate r_next with each number counted in its own size.
template <int N, int H>
void set_record_sizes(const Eigen::VectorXd& size, StepEquations<N, H>& eq) {
  eq.recorded_size = (size.array() > 0.0).select(size, 1.0);
  eq.recorded_rate.setZero(size.size());
  for (Eigen::Index k = 0; k + 1 < size.size(); ++k) {
    if (mechanics::has_derivative(k)) eq.recorded_rate[k] = eq.step * size[k + 1] / eq.recorded_size[k];
  }
  eq.recorded_at.resize(0);
}

// Loads P and supports y of joints:  x = ... + B_support y + A P,  s' = ... + k load_drive^T P'.
template <int N, int H>
void set_loads_of_joints(const mechanics::Joints& joints, StepEquations<N, H>& eq) {
  StepJoints& its = eq.joints;
  on_oscillators(joints.constant_load, joints.load, joints.recorded_load, eq.recorded_size, its.load);
  Eigen::MatrixXd load_rate(its.load.rows(), its.load.cols());
  eq.differentiate(its.load, load_rate);
  its.offset = joints.A * its.load + joints.B_support * eq.motion;
  its.offset_velocity = joints.A * load_rate + joints.B_support * eq.motion_velocity;
  its.offset_acceleration.resizeLike(its.offset);
  eq.differentiate(its.offset_velocity, its.offset_acceleration);
  eq.internal_drive += eq.internal_stiffness.asDiagonal() * (joints.load_drive.transpose() * load_rate);
  its.drive_rate.resizeLike(eq.internal_drive);
  eq.differentiate(eq.internal_drive, its.drive_rate);
}

// K q_s = what the supports' recorded displacements exert.
template <int N, int H>
void set_quasi_static(const mechanics::LinearSystem& system, StepEquations<N, H>& eq) {
  const Eigen::Index m = eq.contacts();
  const bool has_records = !Sizes<N, H>::is_fixed && eq.recorded_size.size() > 0 && eq.motion.rows() > 0;
  eq.quasi_static.setZero(eq.masses(), has_records ? eq.oscillators() : 0);
  eq.quasi_static_velocity.setZero(eq.masses(), eq.quasi_static.cols());
  eq.support_speed.resize(m);
  for (Eigen::Index j = 0; j < m; ++j) eq.support_speed[j] = eq.support_velocity.row(j).norm();
  if (!has_records) return;
  for (Eigen::Index k = 0; k < eq.recorded_size.size(); k += mechanics::kRecordNumbers) {
    if (system.recorded_motion.col(k).isZero(0.0)) continue;
    const Eigen::Index column = eq.first_recorded() + k;
    eq.quasi_static.col(column) = eq.K_inverse * eq.force.col(column);
  }
  eq.differentiate(eq.quasi_static, eq.quasi_static_velocity);
  for (Eigen::Index j = 0; j < m; ++j)
    eq.support_speed[j] =
        (eq.support_velocity.row(j) + eq.W.col(j).transpose() * eq.quasi_static_velocity).norm();
}

// 1/2 sum_k f_k^H K^-1 f_k of the forcing's amplitudes [J], of what drives the motion next to q_s:
//   f - M q_s'' - C q_s' - K q_s
template <int N, int H>
double static_energy(const StepEquations<N, H>& eq) {
  const auto energy_of = [&](const auto& force) {
    double energy = 0.0;
    for (Eigen::Index i = 0; i < force.cols(); ++i)
      energy += 0.5 * force.col(i).dot(eq.K_inverse * force.col(i));
    return energy;
  };
  if (eq.quasi_static.cols() == 0) return energy_of(eq.force);
  Eigen::MatrixXd acceleration(eq.masses(), eq.oscillators());
  eq.differentiate(eq.quasi_static_velocity, acceleration);
  return energy_of(Eigen::MatrixXd(eq.force - eq.M * acceleration - eq.C * eq.quasi_static_velocity -
                                   eq.K * eq.quasi_static));
}

// What moving supports can give by the contacts that rub on them: 1/2 F^2 w^T K^-1 w by its force, and no
// more than 1/2 |p^T Y|^2 / (w^T K^-1 w) where it is dragged along by Y, next to q_s; a belt drags on for
// ever.
template <int N, int H>
double dragged_energy(const StepEquations<N, H>& eq, const mechanics::LinearSystem& system) {
  double energy = 0.0;
  for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
    if (eq.support_velocity.row(j).isZero(0.0)) continue;
    const double give = eq.W.col(j).dot(eq.K_inverse * eq.W.col(j));
    Eigen::RowVectorXd by = system.W_support.col(j).transpose() * eq.motion;
    if (eq.quasi_static.cols() > 0) by += eq.W.col(j).transpose() * eq.quasi_static;
    const double dragged = by.squaredNorm();
    const double by_force = 0.5 * eq.static_limit[j] * eq.static_limit[j] * give;
    const bool on_belt = eq.support_velocity(j, 0) != 0.0;
    energy += on_belt || give == 0.0 ? by_force : std::min(by_force, 0.5 * dragged / give);
  }
  return energy;
}

template <int N, int H>
void Flow<N, H>::set_forcing(const mechanics::LinearSystem& system) {
  StepEquations<N, H>& eq = equations_;
  orders_ = system.orders;  // those over a multiple of the period are others
  const double h = step_within(system.recorded_interval, step_length(fastest_rate_, system.omega,
                                                                     orders_.empty() ? 1 : orders_.back()));
  if (matrices_changed_ || h != eq.step) {
    eq.step = h;
    scale_matrices(system);
    matrices_changed_ = false;
  }
  set_oscillation(system.omega);
  set_record_sizes(system.recorded_size, eq);
  on_oscillators(system.constant_force, system.force, system.recorded_force, eq.recorded_size, eq.force);
  eq.force_pull = eq.M_inverse * eq.force;
  // R^T M v, whose rate is R^T f
  if (eq.free.any()) eq.free.driven = h * h * eq.integrated(eq.free.R.transpose() * eq.force);
  on_oscillators(system.constant_applied_force, system.applied_force, system.recorded_applied_force,
                 eq.recorded_size, eq.applied_force);
  on_oscillators(system.constant_motion, system.motion, system.recorded_motion, eq.recorded_size, eq.motion);
  eq.motion_velocity.resizeLike(eq.motion);
  eq.motion_acceleration.resizeLike(eq.motion);
  eq.differentiate(eq.motion, eq.motion_velocity);
  eq.differentiate(eq.motion_velocity, eq.motion_acceleration);
  eq.motion_velocity.col(0) += h * system.belt_velocity;
  eq.support_velocity.noalias() = system.W_support.transpose() * eq.motion_velocity;
  moving_support_ = !eq.support_velocity.isZero(0.0);
  eq.support_acceleration.noalias() = system.W_support.transpose() * eq.motion_acceleration;
  set_bend_motion(system.bends, eq);
  eq.internal_drive.noalias() =
      eq.internal_stiffness.asDiagonal() * (system.D_support.transpose() * eq.motion_velocity);
  if (system.joints.any()) set_loads_of_joints(system.joints, eq);

  set_quasi_static(system, eq);
  static_norm_ = std::sqrt(static_energy(eq) + dragged_energy(eq, system));

  reckon_work();
  bound_tables();
  for (Configuration<N, H>& configuration : configurations_) configuration.has_forcing = false;
  mode_keys_.clear();
}

// Measured on systems of 1 to 300 masses with up to 64 contacts, 64 bends and 200 orders.
template <int N, int H>
void Flow<N, H>::reckon_work() {
  const StepEquations<N, H>& eq = equations_;
  const auto states = static_cast<double>(eq.states()), oscillators = static_cast<double>(eq.oscillators());
  const auto contacts = static_cast<double>(eq.contacts()), bends = static_cast<double>(eq.bends.count());
  const double of_motion = eq.is_large() ? 35e-9 * states + 2e-9 * states * oscillators  // its Taylor series
                                         : 20e-9 * (states + oscillators);               // a table
  step_work_ = of_motion + 15e-9 * (contacts + bends);
  event_work_ = 1e-6 + 2e-6 * contacts + 160e-9 * bends;
}

template <int N, int H>
void Flow<N, H>::set_recorded(const Eigen::VectorXd& numbers, double phase) {
  equations_.recorded_phase = phase;
  equations_.recorded_at = numbers.cwiseQuotient(equations_.recorded_size);
}

// The oscillators of the forcing over a step, cos and sin of order_k omega h, and their Taylor polynomials.
template <int N, int H>
void Flow<N, H>::set_oscillation(double omega) {
  const auto harmonics = static_cast<Eigen::Index>(orders_.size());
  fundamental_rate_ = omega * equations_.step;
  equations_.period = 2.0 * M_PI / fundamental_rate_;
  equations_.phase_rate.resize(harmonics);
  rotation_.resize(2 * orders_.size());
  rotation_series_.resize(2 * orders_.size());
  for (Eigen::Index k = 0; k < harmonics; ++k) {
    const double rate = orders_[static_cast<std::size_t>(k)] * fundamental_rate_;
    equations_.phase_rate[k] = rate;
    const auto entry = 2 * static_cast<std::size_t>(k);
    rotation_[entry] = std::cos(rate);
    rotation_[entry + 1] = std::sin(rate);
    double term = 1.0;  // rate^i / i!, with the signs of cos: + 0 - 0, of sin: 0 + 0 -
    for (int i = 0; i < kTerms; term *= rate / ++i) {
      const double signed_term = i % 4 < 2 ? term : -term;
      rotation_series_[entry][i] = i % 2 == 0 ? signed_term : 0.0;
      rotation_series_[entry + 1][i] = i % 2 == 1 ? signed_term : 0.0;
    }
  }
}

}  // namespace frahm::periodic
