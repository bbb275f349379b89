#pragma once

// Flow: one step of a motion. Included by flow.hpp; inline, as every step of every orbit comes through here.
#include "solvers/flow/flow.hpp"

namespace frahm::periodic {

template <int N, int H>
inline void Flow<N, H>::instant_at(const typename S::State& z, double phase, const Mode<N, H>& mode,
                                   Instant<N, H>& at) const {
  const StepEquations<N, H>& eq = equations_;
  at.z = z;
  at.u.resize(eq.oscillators());
  eq.oscillators_at(phase, orders_, at.u);
  eq.oscillator_rates(at.u, at.du);
  accelerate(mode, at);
}

// q'' = -P M^-1 (K q + C v + D s + W phi) + Au u;  s' = spring (D^T v + p^T y') - rate s
template <int N, int H>
inline void Flow<N, H>::accelerate(const Mode<N, H>& mode, Instant<N, H>& at) const {
  const Eigen::Index n = equations_.masses();
  const Configuration<N, H>& configuration = configurations_[mode.configuration];
  const auto q = at.z.head(n), v = at.z.segment(n, n);
  const auto s = at.z.tail(equations_.internal_forces());
  configuration.pull(equations_, q, v, s, at.a);
  at.a.noalias() += configuration.Au * at.u;
  at.a += mode.acceleration;
  if constexpr (S::kInternal != 0) {
    at.ds = configuration.internal_rates(equations_, v, s);
    at.ds += configuration.internal_drive * at.u;
  }
}

// Stuck contacts are held again after each step: what rounding leaves of their velocity would otherwise move
// them on for the rest of the period, which has 10^4 steps and more where the excitation is slow.
template <int N, int H>
inline bool Flow<N, H>::step(const Instant<N, H>& from, const Mode<N, H>& mode, Instant<N, H>& to,
                             Expansion<N, H>& x) const {
  const bool is_large = equations_.is_large();
  if (is_large) {
    expand(from, mode, x);
    to.z = x.z.colwise().sum().transpose();
  } else {
    const StepTables<N, H>& tables = configurations_[mode.configuration].tables;
    to.z.noalias() = tables.E * from.z;
    to.z.noalias() += tables.Eu * from.u;
    to.z += mode.step;
  }
  turn_oscillators(from, to);
  configurations_[mode.configuration].hold(equations_, to.u, to.z);
  accelerate(mode, to);
  return is_large;
}

// u and u' one step later.
template <int N, int H>
inline void Flow<N, H>::turn_oscillators(const Instant<N, H>& from, Instant<N, H>& to) const {
  const StepEquations<N, H>& eq = equations_;
  to.u.resize(eq.oscillators());
  to.du.resize(eq.oscillators());
  to.u[0] = 1.0;
  to.du[0] = 0.0;
  for (Eigen::Index k = 0; k < eq.phase_rate.size(); ++k) {
    const double c = rotation_[2 * static_cast<std::size_t>(k)],
                 s = rotation_[2 * static_cast<std::size_t>(k) + 1];
    const double u_cos = from.u[1 + 2 * k], u_sin = from.u[2 + 2 * k];
    to.u[1 + 2 * k] = c * u_cos - s * u_sin;
    to.u[2 + 2 * k] = s * u_cos + c * u_sin;
    to.du[1 + 2 * k] = -eq.phase_rate[k] * to.u[2 + 2 * k];
    to.du[2 + 2 * k] = eq.phase_rate[k] * to.u[1 + 2 * k];
  }
  if constexpr (!S::is_fixed) {
    if (eq.first_recorded() == eq.oscillators()) return;
    eq.move_records(1.0, from.u.tail(eq.oscillators() - eq.first_recorded()), to.u);
    eq.oscillator_rates(to.u, to.du);
  }
}

template <int N, int H>
inline void Flow<N, H>::expand(const Instant<N, H>& at, const Mode<N, H>& mode, Expansion<N, H>& x) const {
  const StepEquations<N, H>& eq = equations_;
  expand_oscillators(at, x);
  x.z.resize(kTerms, eq.states());
  if (eq.is_large()) return expand_by_recurrence(at, mode, x);
  const StepTables<N, H>& tables = configurations_[mode.configuration].tables;
  Eigen::Map<typename S::Series> series(x.z.data(), x.z.size());
  series.noalias() = tables.series_z * at.z;
  series.noalias() += tables.series_u * at.u;
  series += mode.series;
}

template <int N, int H>
inline void Flow<N, H>::expand_oscillators(const Instant<N, H>& at, Expansion<N, H>& x) const {
  const StepEquations<N, H>& eq = equations_;
  x.u.resize(kTerms, eq.oscillators());
  x.u.col(0).setZero();
  x.u(0, 0) = 1.0;
  for (Eigen::Index k = 0; k < eq.phase_rate.size(); ++k) {
    const double u_cos = at.u[1 + 2 * k], u_sin = at.u[2 + 2 * k];
    const Polynomial& c = rotation_series_[2 * static_cast<std::size_t>(k)];
    const Polynomial& s = rotation_series_[2 * static_cast<std::size_t>(k) + 1];
    x.u.col(1 + 2 * k) = u_cos * c - u_sin * s;
    x.u.col(2 + 2 * k) = u_sin * c + u_cos * s;
  }
  if constexpr (!S::is_fixed) {
    // r + r' s + r'' s^2/2 + ... of each number
    for (Eigen::Index k = 0; k < eq.recorded_rate.size(); ++k) {
      auto series = x.u.col(eq.first_recorded() + k);
      series.setZero();
      double share = 1.0;
      for (Eigen::Index j = 0; share != 0.0; ++j) {
        series[j] = share * at.u[eq.first_recorded() + k + j];
        share *= eq.recorded_rate[k + j] / (static_cast<double>(j) + 1.0);
      }
    }
  }
}

template <int N, int H>
inline ValueAndSlope Flow<N, H>::sliding_speed(const Instant<N, H>& at, Eigen::Index j) const {
  const Eigen::Index n = equations_.masses();
  const auto support = equations_.support_velocity.row(j);
  ValueAndSlope speed{support.dot(at.u), support.dot(at.du)};
  if (equations_.is_large()) {
    for_each_entry(equations_.sparse.directions, static_cast<int>(j), [&](int i, double w) {
      speed.value += w * at.z[n + i];
      speed.slope += w * at.a[i];
    });
    return speed;
  }
  const auto w = equations_.W.col(j);
  speed.value += w.dot(at.z.segment(n, n));
  speed.slope += w.dot(at.a);
  return speed;
}

}  // namespace frahm::periodic
