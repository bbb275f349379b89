#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "solvers/periodic/constraints.hpp"
#include "solvers/periodic/step_equations.hpp"

namespace frahm::periodic {

using ContactMask = std::uint64_t;  // bit j: contact j
inline bool contains(ContactMask mask, Eigen::Index contact) {
  return (mask >> contact) & 1U;
}
inline ContactMask bit(Eigen::Index contact) {
  return ContactMask{1} << contact;
}

// The linear system that moves while one set of contacts sticks and the others slide:
//   q'' = Aq q + Av v + Au u(t) + Af phi,      phi_j = sigma_j F_j of the sliding contacts, 0 of the stuck
//   lambda_j = (Lq q + Lv v + Lu u(t) + Lf phi)_j  of the stuck contacts
// and its exact flow over one step,
//   z(1) = E z(0) + Eu u(0) + Ef phi,
// the exponential of the matrix augmented by the oscillators of the forcing (C. Van Loan, IEEE Trans. Autom.
// Control 23 (1978) 395): finite at resonance of an undamped mode and at critical damping alike.
template <int N, int H>
struct Configuration {
  using S = Sizes<N, H>;

  ContactMask stuck = 0;
  bool has_forcing = false;  // set_forcing was called since the forcing changed
  typename S::Square Aq, Av;
  typename S::VectorByOscillators Au;
  typename S::VectorByContacts Af;
  typename S::ContactsByVector Lq, Lv;
  typename S::ContactsByOscillators Lu;
  typename S::ContactSquare Lf;
  typename S::Square P;  // velocities -> velocities that keep the stuck contacts stuck, M-orthogonal

  // The flow as Taylor series in the step fraction, z(s) = series_z(s) z(0) + series_u(s) u(0) + series_f(s)
  // phi.
  typename S::SeriesByState series_z;
  typename S::SeriesByOscillators series_u;
  typename S::SeriesByContacts series_f;
  // The same at s = 1.
  typename S::StateSquare E;
  typename S::StateByOscillators Eu;
  typename S::StateByContacts Ef;

  // Takes the last rounding out of the stuck contacts' relative velocities, M-orthogonally.
  void hold(const StepEquations<N, H>& equations, const typename S::Oscillators& u,
            typename S::State& z) const {
    if (stuck == 0) return;
    const Eigen::Index n = equations.masses();
    z.tail(n) -= reaction_ * (equations.W.transpose() * z.tail(n) + equations.support_velocity * u);
  }

  // Matrices that do not depend on the forcing.
  void set_system(const StepEquations<N, H>& equations, ContactMask stuck_contacts);
  // Those that do; after set_system.
  void set_forcing(const StepEquations<N, H>& equations);

 private:
  // Velocities and forces after the stuck contacts' constraint w_j^T q'' = -p_j^T y'' has been met.
  typename S::ContactSquare constraint_;   // G_S^+, zero rows and columns for sliding contacts
  typename S::VectorByContacts reaction_;  // M^-1 W G_S^+ : accelerations per unit of relative acceleration
  void propagate_homogeneous(const StepEquations<N, H>& equations);

  // Coefficient k of displacements q and velocities v, each column a solution.
  template <class Columns, class Series>
  static void store(const Columns& q, const Columns& v, int k, Series& series) {
    const Eigen::Index n = q.rows();
    for (Eigen::Index column = 0; column < q.cols(); ++column) {
      for (Eigen::Index i = 0; i < n; ++i) {
        series(i * kTerms + k, column) = q(i, column);
        series((n + i) * kTerms + k, column) = v(i, column);
      }
    }
  }
  template <class Series, class Sums>
  static void sum_series(const Series& series, Sums& sums) {
    const Eigen::Index components = series.rows() / kTerms;
    sums.resize(components, series.cols());
    for (Eigen::Index column = 0; column < series.cols(); ++column) {
      for (Eigen::Index i = 0; i < components; ++i) {
        sums(i, column) = series.col(column).template segment<kTerms>(i * kTerms).sum();
      }
    }
  }
};

template <int N, int H>
void Configuration<N, H>::set_system(const StepEquations<N, H>& equations, ContactMask stuck_contacts) {
  stuck = stuck_contacts;
  const Eigen::Index n = equations.masses(), m = equations.contacts();
  const typename S::VectorByContacts MW = equations.M_inverse * equations.W;

  // G_S^+ with G = W^T M^-1 W over the stuck contacts. Stuck directions may depend on one another; of the
  // forces that then serve equally, those of least sum (lambda_j / F_j)^2 are meant.
  constraint_.setZero(m, m);
  const Eigen::Index stuck_count = __builtin_popcountll(stuck);
  if (stuck_count == 1) {
    const Eigen::Index j = __builtin_ctzll(stuck);
    constraint_(j, j) = 1.0 / equations.compliance[j];
  } else if (stuck_count > 1) {
    typename S::Contacts weight(m);
    for (Eigen::Index j = 0; j < m; ++j) weight[j] = contains(stuck, j) ? equations.limit[j] : 0.0;
    constraint_ = weighted_pseudo_inverse(equations.W.transpose() * MW, weight);
  }

  reaction_ = MW * constraint_;
  P = S::Square::Identity(n, n) - reaction_ * equations.W.transpose();
  Aq.noalias() = -(P * equations.M_inverse) * equations.K;
  Av.noalias() = -(P * equations.M_inverse) * equations.C;
  Af = -(P * MW);
  const typename S::ContactsByVector per_force =
      (equations.M_inverse * equations.W * constraint_).transpose();
  Lq = -(per_force * equations.K);
  Lv = -(per_force * equations.C);
  Lf = -(per_force * equations.W);
  propagate_homogeneous(equations);
}

template <int N, int H>
void Configuration<N, H>::set_forcing(const StepEquations<N, H>& equations) {
  const Eigen::Index n = equations.masses(), oscillators = equations.oscillators();
  has_forcing = true;
  Au.noalias() = P * (equations.M_inverse * equations.force);
  Lu.noalias() = (equations.M_inverse * equations.W * constraint_).transpose() * equations.force;
  if (stuck != 0) {
    Au.noalias() -= reaction_ * equations.support_acceleration;
    Lu.noalias() += constraint_ * equations.support_acceleration;
  }

  // Column i starts from rest with oscillator i at 1. The forcing's own Taylor coefficients follow from its
  // rows.
  typename S::VectorByOscillators q = S::VectorByOscillators::Zero(n, oscillators), v = q, drive = Au, next;
  series_u.resize(2 * n * kTerms, oscillators);
  for (int k = 0; k < kTerms; ++k) {
    store(q, v, k, series_u);
    next.noalias() = Aq * q + Av * v;
    next += drive;
    const double share = 1.0 / (k + 1.0);
    q = v * share;
    v = next * share;
    equations.differentiate(drive, next);
    drive = next * share;
  }
  sum_series(series_u, Eu);
}

template <int N, int H>
void Configuration<N, H>::propagate_homogeneous(const StepEquations<N, H>& equations) {
  const Eigen::Index n = equations.masses(), m = equations.contacts();
  using Columns = Eigen::Matrix<double, N, S::kState>;
  Columns q = Columns::Zero(n, 2 * n), v = q, next;
  q.leftCols(n).setIdentity();
  v.rightCols(n).setIdentity();
  series_z.resize(2 * n * kTerms, 2 * n);
  for (int k = 0; k < kTerms; ++k) {
    store(q, v, k, series_z);
    next.noalias() = Aq * q + Av * v;
    q = v * (1.0 / (k + 1.0));
    v = next * (1.0 / (k + 1.0));
  }
  sum_series(series_z, E);

  // A unit friction force from rest, constant over the step.
  typename S::VectorByContacts fq = S::VectorByContacts::Zero(n, m), fv = fq, f_next = Af;
  series_f.resize(2 * n * kTerms, m);
  for (int k = 0; k < kTerms; ++k) {
    store(fq, fv, k, series_f);
    fq = fv * (1.0 / (k + 1.0));
    fv = f_next * (1.0 / (k + 1.0));
    f_next = Aq * fq + Av * fv;
  }
  sum_series(series_f, Ef);
}

}  // namespace frahm::periodic
