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
  at.du.resize(eq.oscillators());
  eq.oscillators_at(phase, orders_, at.u);
  at.du[0] = 0.0;
  for (Eigen::Index k = 0; k < eq.phase_rate.size(); ++k) {
    at.du[1 + 2 * k] = -eq.phase_rate[k] * at.u[2 + 2 * k];
    at.du[2 + 2 * k] = eq.phase_rate[k] * at.u[1 + 2 * k];
  }
  accelerate(mode, at);
}

// q'' = Aq q + Av v + As s + Au u + Af phi;  s' = spring (D^T v + p^T y') - rate s
template <int N, int H>
inline void Flow<N, H>::accelerate(const Mode<N, H>& mode, Instant<N, H>& at) const {
  const Eigen::Index n = equations_.masses();
  const Configuration<N, H>& configuration = configurations_[mode.configuration];
  at.a.noalias() = configuration.Aq * at.z.head(n) + configuration.Av * at.z.segment(n, n);
  at.a.noalias() += configuration.Au * at.u;
  at.a += mode.acceleration;
  if constexpr (S::kInternal != 0) {
    const auto s = at.z.tail(equations_.internal_forces());
    at.a += configuration.As * s;
    at.ds = configuration.internal_rates(equations_, at.z.segment(n, n), s);
    at.ds += configuration.internal_drive * at.u;
  }
}

template <int N, int H>
inline void Flow<N, H>::step(const Instant<N, H>& from, const Mode<N, H>& mode, Instant<N, H>& to) const {
  const StepEquations<N, H>& eq = equations_;
  const Configuration<N, H>& configuration = configurations_[mode.configuration];
  to.z.noalias() = configuration.E * from.z;
  to.z.noalias() += configuration.Eu * from.u;
  to.z += mode.step;
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
  accelerate(mode, to);
}

template <int N, int H>
inline void Flow<N, H>::expand(const Instant<N, H>& at, const Mode<N, H>& mode, Expansion<N, H>& x) const {
  const StepEquations<N, H>& eq = equations_;
  const Configuration<N, H>& configuration = configurations_[mode.configuration];
  x.z.resize(kTerms, eq.states());
  Eigen::Map<typename S::Series> series(x.z.data(), x.z.size());
  series.noalias() = configuration.series_z * at.z;
  series.noalias() += configuration.series_u * at.u;
  series += mode.series;
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
}

template <int N, int H>
inline ValueAndSlope Flow<N, H>::sliding_speed(const Instant<N, H>& at, Eigen::Index j) const {
  const Eigen::Index n = equations_.masses();
  const auto w = equations_.W.col(j);
  const auto support = equations_.support_velocity.row(j);
  return {w.dot(at.z.segment(n, n)) + support.dot(at.u), w.dot(at.a) + support.dot(at.du)};
}

template <int N, int H>
inline ValueAndSlope Flow<N, H>::stuck_force(const Instant<N, H>& at, const Mode<N, H>& mode,
                                             Eigen::Index j) const {
  const Eigen::Index n = equations_.masses();
  const Configuration<N, H>& c = configurations_[mode.configuration];
  ValueAndSlope force{c.Lq.row(j).dot(at.z.head(n)) + c.Lv.row(j).dot(at.z.segment(n, n)) +
                          c.Lu.row(j).dot(at.u) + mode.stuck_force[j],
                      c.Lq.row(j).dot(at.z.segment(n, n)) + c.Lv.row(j).dot(at.a) + c.Lu.row(j).dot(at.du)};
  if constexpr (S::kInternal != 0) {
    force.value += c.Ls.row(j).dot(at.z.tail(equations_.internal_forces()));
    force.slope += c.Ls.row(j).dot(at.ds);
  }
  return force;
}

}  // namespace frahm::periodic
