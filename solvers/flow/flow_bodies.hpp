#pragma once

#include <algorithm>
#include <cmath>

#include "solvers/flow/configuration_setup.hpp"
#include "solvers/flow/flow.hpp"
#include "solvers/flow/flow_setup.hpp"

// Bodies of Flow, for the files that instantiate it (flow_1_1.cpp and so on).
namespace frahm::periodic {

// Configurations are kept for the next frequency as long as they take little memory: with many contacts each
// orbit meets new ones.
template <int N, int H>
void Flow<N, H>::bound_tables() {
  const Eigen::Index most_doubles = (equations_.is_large() ? 16 : 64) << 17;  // 16 or 64 MB
  const Eigen::Index states = equations_.states(), oscillators = equations_.oscillators(),
                     contacts = equations_.contacts();
  const Eigen::Index of_each = equations_.is_large()
                                   ? (states + contacts) * oscillators + 2 * contacts * contacts
                                   : kTerms * states * (states + oscillators + contacts);
  if (static_cast<Eigen::Index>(configuration_keys_.size()) * of_each > most_doubles)
    configuration_keys_.clear();
}

// The entry of a table for a new key.
template <class Key, class Entry>
Entry& new_entry(const Key& key, std::vector<Key>& keys, std::vector<Entry>& entries) {
  if (entries.size() == keys.size()) entries.emplace_back();
  keys.push_back(key);
  return entries[keys.size() - 1];
}

template <int N, int H>
std::size_t Flow<N, H>::configuration_index(ContactMask stuck, ContactMask beyond) {
  const ConfigurationKey key{stuck, beyond};
  const auto found = std::ranges::find(configuration_keys_, key);
  const auto index = static_cast<std::size_t>(found - configuration_keys_.begin());
  if (found == configuration_keys_.end())
    new_entry(key, configuration_keys_, configurations_).set_system(equations_, stuck, beyond);
  if (!configurations_[index].has_forcing) configurations_[index].set_forcing(equations_);
  return index;
}

template <int N, int H>
std::size_t Flow<N, H>::mode_index(ContactMask stuck, ContactMask positive, ContactMask beyond) {
  const ModeKey key{stuck, positive & ~stuck, beyond};
  const auto found = std::ranges::find(mode_keys_, key);
  if (found != mode_keys_.end()) return static_cast<std::size_t>(found - mode_keys_.begin());
  Mode<N, H>& mode = new_entry(key, mode_keys_, modes_);
  mode.stuck = stuck;
  mode.positive = key.positive;
  mode.beyond = beyond;
  mode.configuration = configuration_index(stuck, beyond);
  const Configuration<N, H>& configuration = configurations_[mode.configuration];
  mode.friction.resize(equations_.contacts());
  for (Eigen::Index j = 0; j < equations_.contacts(); ++j) {
    const bool slides = equations_.holds(j) && !contains(stuck, j);
    const bool idle = contains(configuration.idle, j);  // at rest, where the static limit holds
    mode.friction[j] = slides ? mode.sign(j) * (idle ? equations_.static_limit : equations_.limit)[j] : 0.0;
  }
  mode.acceleration = configuration.pull_of_friction(equations_, mode.friction);
  mode.stuck_force = configuration.stuck_force_of_friction(equations_, mode.friction);
  if (!equations_.is_large()) {
    mode.step.noalias() = configuration.tables.Ef.lazyProduct(mode.friction);
    mode.series.noalias() = configuration.tables.series_f.lazyProduct(mode.friction);
    if constexpr (!S::is_fixed) {
      mode.guards.noalias() = configuration.tables.guard_f.lazyProduct(mode.friction);
      for (Eigen::Index j = 0; j < equations_.contacts(); ++j) mode.guards[kTerms * j] += mode.stuck_force[j];
    }
  }
  return mode_keys_.size() - 1;
}

// Coefficient k + 1 of the series is the derivative of coefficient k over k + 1.
template <int N, int H>
void Flow<N, H>::expand_by_recurrence(const Instant<N, H>& at, const Mode<N, H>& mode,
                                      Expansion<N, H>& x) const {
  const StepEquations<N, H>& eq = equations_;
  const Configuration<N, H>& c = configurations_[mode.configuration];
  const Eigen::Index n = eq.masses(), internal = eq.internal_forces();
  typename S::Vector a(n);
  typename S::Internal ds(internal);
  typename S::State z = at.z;
  for (int k = 0;; ++k) {
    x.z.row(k) = z.transpose();
    if (k + 1 == kTerms) break;
    pull(eq.sparse, c.held, z.data(), z.data() + n, z.data() + 2 * n, a.data(), ds.data());
    for (Eigen::Index j = 0; j < eq.oscillators(); ++j) {
      if (const double u = x.u(k, j); u != 0.0) a += u * c.Au.col(j);  // of a record few are not zero
    }
    if (k == 0) a += mode.acceleration;
    const double share = 1.0 / (k + 1.0);
    z.head(n) = z.segment(n, n) * share;
    z.segment(n, n) = a * share;
    if constexpr (S::kInternal != 0) {
      ds.noalias() += c.internal_drive * x.u.row(k).transpose();
      z.tail(internal) = ds * share;
    }
  }
}

template <int N, int H>
void Flow<N, H>::move_tangent(const Mode<N, H>& mode, double steps, typename S::StateSquare& tangent) const {
  const Configuration<N, H>& configuration = configurations_[mode.configuration];
  if (steps == 1.0)
    tangent = (configuration.tables.E * tangent).eval();
  else
    configuration.tables.move_by_fraction(steps, tangent);
}

template <int N, int H>
std::vector<const HeldContacts*> Flow<N, H>::held_along(const TangentPath& path) const {
  const auto held_in = [this](std::size_t index) { return &configuration(mode(index)).held; };
  std::vector<const HeldContacts*> held{held_in(path.first_mode)};
  for (const TangentPath::Stretch& stretch : path.stretches) held.push_back(held_in(stretch.mode));
  return held;
}

template <int N, int H>
void Flow<N, H>::tangent_along(const TangentPath& path, Precision precision,
                               typename S::StateSquare& tangent) const {
  if constexpr (!S::is_fixed) {
    tangent.setIdentity(equations_.states(), equations_.states());
    if (precision == Precision::rough)
      follow_roughly(path, equations_.sparse_rough, held_along(path), tangent);
    else
      follow(path, equations_.sparse, held_along(path), tangent);
  }
}

template <int N, int H>
typename Sizes<N, H>::State Flow<N, H>::state_within(const Segment<N, H>& segment, double section,
                                                     double elapsed) const {
  const Mode<N, H>& mode = modes_[segment.mode];
  Instant<N, H> at, next;
  instant_at(segment.z, section + segment.start * fundamental_rate_, mode, at);
  Expansion<N, H> x;
  for (; elapsed >= 1.0; elapsed -= 1.0) {
    step(at, mode, next, x);
    at = next;
  }
  expand(at, mode, x);
  typename S::State z;
  evaluate(x, elapsed, z);
  return z;
}

template <int N, int H>
double Flow<N, H>::energy_scale(const typename S::State& z, double phase) const {
  const StepEquations<N, H>& eq = equations_;
  if (eq.has_free_masses) return std::hypot(energy_scale_beside(z, phase), std::sqrt(bent_energy(z, phase)));
  return energy_scale_beside(z, phase);
}

// The energy [J] of what is bent beyond its place and stiffens, which holds masses that are free otherwise.
template <int N, int H>
double Flow<N, H>::bent_energy(const typename S::State& z, double phase) const {
  const StepBends<N, H>& bends = equations_.bends;
  typename S::Oscillators u(equations_.oscillators());
  equations_.oscillators_at(phase, orders_, u);
  double energy = 0.0;
  for (Eigen::Index j = 0; j < bends.count(); ++j) {
    if (contains(bends.of_velocity, j) || bends.stiffness[j] <= 0.0) continue;
    const double past =
        bends.B.col(j).dot(z.head(equations_.masses())) + bends.motion.row(j).dot(u) - bends.place[j];
    if (past > 0.0) energy += 0.5 * bends.stiffness[j] * past * past;
  }
  return energy;
}

template <int N, int H>
double Flow<N, H>::energy_scale_beside(const typename S::State& z, double phase) const {
  const StepEquations<N, H>& eq = equations_;
  if (eq.quasi_static.cols() == 0) return energy_scale(z);
  typename S::Oscillators u(eq.oscillators());
  eq.oscillators_at(phase, orders_, u);
  typename S::State beside = z;
  beside.head(eq.masses()) -= eq.quasi_static * u;
  beside.segment(eq.masses(), eq.masses()) -= eq.quasi_static_velocity * u;
  return energy_scale(beside);
}

template <int N, int H>
typename Sizes<N, H>::State Flow<N, H>::brought_to_rest(const typename S::State& z, double phase,
                                                        ContactMask contacts) {
  typename S::State held = z;
  typename S::Oscillators u(equations_.oscillators());
  equations_.oscillators_at(phase, orders_, u);
  configurations_[configuration_index(contacts, 0)].hold(equations_, u, held);
  return held;
}

}  // namespace frahm::periodic
