#pragma once

#include <Eigen/Core>

#include "solvers/flow/constraints.hpp"
#include "solvers/flow/equations.hpp"

namespace frahm::periodic {

// The linear system that moves while one set of contacts sticks and the others slide:
//   q'' = Aq q + Av v + As s + Au u(t) + Af phi,   phi_j = sigma_j F_j of the contacts that slide, else 0
//   s'  = spring (D^T v + p^T y') - rate s,        spring = k, 0 of an internal force that is held
//   lambda_j = (Lq q + Lv v + Ls s + Lu u(t) + Lf phi)_j   of the stuck contacts (of an internal force: s)
// and its exact flow over one step,
//   z(1) = E z(0) + Eu u(0) + Ef phi,
// the exponential of the matrix augmented by the oscillators of the forcing (C. Van Loan, IEEE Trans. Autom.
// Control 23 (1978) 395): finite at resonance of an undamped mode and at critical damping alike.
template <int N, int H>
struct Configuration {
  using S = Sizes<N, H>;

  ContactMask stuck = 0;
  // Contacts without events: they count as sliding, but the stuck contacts hold them at rest, or they have no
  // force.
  ContactMask idle = 0;
  bool has_forcing = false;  // set_forcing was called since the forcing changed
  typename S::Square Aq, Av;
  typename S::VectorByInternal As;
  typename S::VectorByOscillators Au;
  typename S::VectorByContacts Af;
  typename S::ContactsByVector Lq, Lv;
  typename S::ContactsByInternal Ls;
  typename S::ContactsByOscillators Lu;
  typename S::ContactSquare Lf;
  typename S::Square P;         // velocities -> velocities that keep the stuck contacts stuck, M-orthogonal
  typename S::Internal spring;  // of each internal force k, or 0 while it is held
  typename S::InternalByOscillators internal_drive;  // spring p^T y'(t) [N a step]

  // The flow as Taylor series in the step fraction, z(s) = series_z(s) z(0) + series_u(s) u(0) + series_f(s)
  // phi.
  typename S::SeriesByState series_z;
  typename S::SeriesByOscillators series_u;
  typename S::SeriesByContacts series_f;
  // The same at s = 1.
  typename S::StateSquare E;
  typename S::StateByOscillators Eu;
  typename S::StateByContacts Ef;

  // Removes rounding from the velocities of the held contacts, M-orthogonally.
  void hold(const StepEquations<N, H>& equations, const typename S::Oscillators& u,
            typename S::State& z) const {
    if ((stuck & equations.holding) == 0) return;
    const Eigen::Index n = equations.masses();
    typename S::Contacts slip = equations.W.transpose() * z.segment(n, n);
    slip.noalias() += equations.support_velocity * u;
    z.segment(n, n).noalias() -= reaction_ * slip;
  }

  // These meet the constraint w_j^T q'' = -p_j^T y'' of the held contacts, with G = W^T M^-1 W over them:
  const typename S::ContactSquare& constraint() const { return constraint_; }  // G^+
  const typename S::VectorByContacts& reaction() const { return reaction_; }   // M^-1 W G^+

  // s' without the part of the support.
  template <class Velocities, class Forces>
  auto internal_rates(const StepEquations<N, H>& equations, const Velocities& v, const Forces& s) const {
    return spring.asDiagonal() * (equations.D.transpose() * v) - equations.internal_rate.asDiagonal() * s;
  }

  // Matrices that do not depend on the forcing.
  void set_system(const StepEquations<N, H>& equations, ContactMask stuck_contacts);
  // Matrices that depend on the forcing; to be called after set_system.
  void set_forcing(const StepEquations<N, H>& equations);

 private:
  ContactMask frictionless_ = 0;           // internal forces with limit zero, which are always zero
  ContactMask immobile_ = 0;               // contacts that count as sliding but are held by the stuck ones
  typename S::ContactSquare constraint_;   // zero rows and columns for sliding contacts
  typename S::VectorByContacts reaction_;  // accelerations per unit of relative acceleration
  void propagate_homogeneous(const StepEquations<N, H>& equations);

  // Columns of solutions, and of what drives them.
  template <int Columns, int MostColumns = Columns>
  struct Solutions {
    using Vectors =
        Eigen::Matrix<double, N, Columns, N == 1 ? Eigen::RowMajor : Eigen::ColMajor, N, MostColumns>;
    using Forces = Eigen::Matrix<double, S::kInternal, Columns, Eigen::ColMajor, S::kInternal, MostColumns>;
    Vectors q, v;
    Forces s;

    Solutions(const StepEquations<N, H>& eq, Eigen::Index columns)
        : q(eq.masses(), columns), v(eq.masses(), columns), s(eq.internal_forces(), columns) {
      q.setZero();
      v.setZero();
      s.setZero();
    }
  };

  // The Taylor series of solutions whose coefficients 0 are given: coefficient k + 1 is the derivative of
  // coefficient k over k + 1. drive_next(k, v', s') adds what drives the velocities and internal forces at k.
  template <class Columns, class Series, class DriveNext>
  void expand_series(const StepEquations<N, H>& equations, Columns x, Series& series,
                     const DriveNext& drive_next) const {
    const Eigen::Index n = equations.masses(), internal = equations.internal_forces();
    series.resize(equations.states() * kTerms, x.q.cols());
    typename Columns::Vectors next(n, x.q.cols());
    typename Columns::Forces s_next = x.s;
    for (int k = 0; k < kTerms; ++k) {
      for (Eigen::Index column = 0; column < x.q.cols(); ++column) {
        for (Eigen::Index i = 0; i < n; ++i) {
          series(i * kTerms + k, column) = x.q(i, column);
          series((n + i) * kTerms + k, column) = x.v(i, column);
        }
        for (Eigen::Index i = 0; i < internal; ++i) series((2 * n + i) * kTerms + k, column) = x.s(i, column);
      }
      next.noalias() = Aq * x.q + Av * x.v;
      if constexpr (S::kInternal != 0) {
        next += As * x.s;
        s_next = internal_rates(equations, x.v, x.s);
      }
      drive_next(k, next, s_next);
      const double share = 1.0 / (k + 1.0);
      x.q = x.v * share;
      x.v = next * share;
      x.s = s_next * share;
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

  // G_S^+ with G = W^T M^-1 W over the held contacts. Their directions may be linearly dependent; of the
  // forces that are then equivalent, those of least sum (lambda_j / F_j)^2 are taken.
  const ContactMask held = stuck & equations.holding;
  constraint_.setZero(m, m);
  if (count(held) == 1) {
    const Eigen::Index j = first(held);
    constraint_(j, j) = 1.0 / equations.compliance[j];
  } else if (held != 0) {
    typename S::Contacts weight(m);
    for (Eigen::Index j = 0; j < m; ++j) weight[j] = contains(held, j) ? equations.limit[j] : 0.0;
    constraint_ = weighted_pseudo_inverse(equations.W.transpose() * MW, weight);
  }

  reaction_ = MW * constraint_;
  P = S::Square::Identity(n, n) - reaction_ * equations.W.transpose();
  // A projector's trace is its rank, so one without a large entry is zero: every mass is held.
  if (P.cwiseAbs().maxCoeff() < 1e-12) P.setZero();
  immobile_ = frictionless_ = 0;
  for (Eigen::Index j = 0; held != 0 && j < m; ++j) {
    constexpr double kImmobile = 1e-10;  // of its compliance: rounding of what a loop takes away
    const double mobility = equations.W.col(j).dot(P * MW.col(j));
    const bool slides = contains(equations.holding & ~stuck, j);
    if (slides && mobility <= kImmobile * equations.compliance[j]) immobile_ |= bit(j);
  }
  // For a force on the masses: the acceleration that remains, and the force that the stuck contacts take; the
  // sign is that of the pull of the springs and dampers.
  const typename S::Square left = -(P * equations.M_inverse);
  const typename S::ContactsByVector taken = -reaction_.transpose();
  Aq.noalias() = left * equations.K;
  Av.noalias() = left * equations.C;
  Af.noalias() = left * equations.W;
  Lq.noalias() = taken * equations.K;
  Lv.noalias() = taken * equations.C;
  Lf.noalias() = taken * equations.W;
  if constexpr (S::kInternal != 0) {
    As.noalias() = left * equations.D;
    Ls.noalias() = taken * equations.D;
    spring = equations.internal_stiffness;
    for (Eigen::Index j = 0; j < m; ++j) {
      const Eigen::Index internal = equations.internal_of[static_cast<std::size_t>(j)];
      if (internal < 0) continue;
      Ls(j, internal) = 1.0;
      if (equations.limit[j] == 0.0) frictionless_ |= bit(j);
      if (!contains(stuck, j)) spring[internal] = 0.0;
    }
  }
  propagate_homogeneous(equations);
}

template <int N, int H>
void Configuration<N, H>::set_forcing(const StepEquations<N, H>& equations) {
  has_forcing = true;
  idle = frictionless_;
  for (Eigen::Index j = 0; immobile_ != 0 && j < equations.contacts(); ++j) {
    // Its velocity is (p_j - P_S^T G^+ W^T M^-1 w_j)^T y': none, unless a support moves it.
    const typename S::Contacts share = reaction_.transpose() * equations.W.col(j);
    typename S::OscillatorRow drag = equations.support_velocity.row(j);
    drag.noalias() -= share.transpose() * equations.support_velocity;
    const double size = equations.support_velocity.row(j).norm();
    if (contains(immobile_, j) && drag.norm() <= 1e-12 * size) idle |= bit(j);
  }
  const typename S::VectorByOscillators free = equations.M_inverse * equations.force;
  Au.noalias() = P * free;
  Lu.noalias() = reaction_.transpose() * equations.force;
  if constexpr (S::kInternal != 0) {
    internal_drive = equations.internal_drive;
    for (Eigen::Index i = 0; i < spring.size(); ++i) {
      if (spring[i] == 0.0) internal_drive.row(i).setZero();
    }
  }
  if ((stuck & equations.holding) != 0) {
    Au.noalias() -= reaction_ * equations.support_acceleration;
    Lu.noalias() += constraint_ * equations.support_acceleration;
  }

  // Column i starts from rest with oscillator i at 1. The forcing's own Taylor coefficients follow from its
  // rows.
  typename S::VectorByOscillators drive = Au, drive_rate;
  typename S::InternalByOscillators of_internal = internal_drive, of_internal_rate;
  drive_rate.resizeLike(drive);
  of_internal_rate.resizeLike(of_internal);
  const auto forcing = [&](int k, auto& v_next, auto& s_next) {
    const double share = 1.0 / (k + 1.0);
    v_next += drive;
    equations.differentiate(drive, drive_rate);
    drive = drive_rate * share;
    if constexpr (S::kInternal != 0) {
      s_next += of_internal;
      equations.differentiate(of_internal, of_internal_rate);
      of_internal = of_internal_rate * share;
    }
  };
  const Solutions<S::kOscillators> from_rest(equations, equations.oscillators());
  expand_series(equations, from_rest, series_u, forcing);
  sum_series(series_u, Eu);
}

template <int N, int H>
void Configuration<N, H>::propagate_homogeneous(const StepEquations<N, H>& equations) {
  const Eigen::Index n = equations.masses();
  Solutions<S::kState> units(equations, equations.states());
  units.q.leftCols(n).setIdentity();
  units.v.middleCols(n, n).setIdentity();
  if constexpr (S::kInternal != 0) units.s.rightCols(equations.internal_forces()).setIdentity();
  expand_series(equations, units, series_z, [](int, auto&, auto&) {});
  sum_series(series_z, E);

  // A unit friction force from rest, constant over the step.
  const Solutions<Eigen::Dynamic, S::kMaxContacts> from_rest(equations, equations.contacts());
  const auto constant_force = [&](int k, auto& v_next, auto&) {
    if (k == 0) v_next += Af;
  };
  expand_series(equations, from_rest, series_f, constant_force);
  sum_series(series_f, Ef);
}

}  // namespace frahm::periodic
