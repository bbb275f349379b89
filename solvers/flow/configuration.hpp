#pragma once

#include <Eigen/Core>

#include "solvers/flow/equations.hpp"
#include "solvers/flow/step_tables.hpp"

namespace frahm::periodic {

// The linear system that moves while one set of contacts sticks and the others slide. With G = W^T M^-1 W
// over the held contacts and P = 1 - M^-1 W G^+ W^T:
//   q'' = -P M^-1 (K q + C v + D s + W phi) + Au u(t),   phi_j = sigma_j F_j of the contacts that slide,
//   otherwise 0 s'  = spring (D^T v + p^T y') - rate s,              spring = k, 0 of an internal force that
//   is held lambda_j = (Lq q + Lv v + Ls s + Lu u(t) + Lf phi)_j of the stuck contacts (of an internal force:
//   s)
// K, C and the forcing are those beyond a set of bends (StepBends).
// Small systems have tables of all this (StepTables); large ones, which meet thousands of sets in a period,
// only the inverse of G over the held contacts (HeldContacts), from which the rest follows where it is asked.
template <int N, int H>
struct Configuration {
  using S = Sizes<N, H>;

  ContactMask stuck = 0;
  ContactMask beyond = 0;  // bends
  // Contacts without events: they count as sliding, but the stuck contacts hold them at rest, or they have no
  // force.
  ContactMask idle = 0;
  bool has_forcing = false;  // set_forcing was called since the forcing changed
  typename S::VectorByOscillators Au;
  typename S::ContactsByOscillators Lu;
  typename S::Internal spring;                       // of each internal force k, or 0 while it is held
  typename S::InternalByOscillators internal_drive;  // spring p^T y'(t) [N a step]
  StepTables<N, H> tables;                           // of a small system
  HeldContacts held;                                 // of a large system

  // Removes rounding from the velocities of the held contacts, M-orthogonally.
  void hold(const StepEquations<N, H>& equations, const typename S::Oscillators& u,
            typename S::State& z) const;

  // These meet the constraint w_j^T q'' = -p_j^T y'' of the held contacts; zero for contacts that slide.
  typename S::ContactSquare constraint(const StepEquations<N, H>& equations) const;   // G^+
  typename S::VectorByContacts reaction(const StepEquations<N, H>& equations) const;  // M^-1 W G^+
  // G^+ c, the forces that give the held contacts the relative accelerations c (m).
  template <class Accelerations>
  typename S::Contacts forces_for(const StepEquations<N, H>& equations, const Accelerations& c) const {
    if (equations.is_large()) return forces_of(held, c);
    return tables.constraint * c;
  }

  // P
  typename S::Square projector(const StepEquations<N, H>& equations) const;
  // Whether no mass can move: P = 0.
  bool holds_all(const StepEquations<N, H>& equations) const {
    return equations.is_large() ? held.hold_all : tables.P.isZero(0.0);
  }
  // -P M^-1 (K q + C v + D s)
  template <class Displacements, class Velocities, class Forces>
  void pull(const StepEquations<N, H>& equations, const Displacements& q, const Velocities& v,
            const Forces& s, typename S::Vector& a) const;
  // The same as a matrix over the state, n x states.
  Eigen::Matrix<double, N, S::kState> pull_by_state(const StepEquations<N, H>& equations) const;
  // Its form of w^T q'' over the state.
  typename S::State pull_form(const StepEquations<N, H>& equations, const typename S::Vector& w) const;
  // Accelerations due to the friction forces phi: -P M^-1 W phi.
  typename S::Vector pull_of_friction(const StepEquations<N, H>& equations,
                                      const typename S::Contacts& friction) const;
  // Lf phi = -G^+ W^T M^-1 W phi
  typename S::Contacts stuck_force_of_friction(const StepEquations<N, H>& equations,
                                               const typename S::Contacts& friction) const {
    return -forces_for(equations, (equations.mobility * friction).eval());
  }
  // s' without the part of the support.
  template <class Velocities, class Forces>
  auto internal_rates(const StepEquations<N, H>& equations, const Velocities& v, const Forces& s) const {
    return spring.asDiagonal() * (equations.D.transpose() * v) - equations.internal_rate.asDiagonal() * s;
  }

  // Matrices that do not depend on the forcing.
  void set_system(const StepEquations<N, H>& equations, ContactMask stuck_contacts, ContactMask beyond_bends);
  // Matrices that depend on the forcing; to be called after set_system.
  void set_forcing(const StepEquations<N, H>& equations);

 private:
  Eigen::MatrixXd inverse_mobility(const StepEquations<N, H>& equations, ContactMask holding) const;
  void find_immobile(const StepEquations<N, H>& equations);
  void set_springs(const StepEquations<N, H>& equations);
  void set_tables(const StepEquations<N, H>& equations);
  void set_held(const StepEquations<N, H>& equations);

  ContactMask frictionless_ = 0;  // internal forces with limit zero, which are always zero
  ContactMask immobile_ = 0;      // contacts that count as sliding but are held by the stuck ones
};

template <int N, int H>
void Configuration<N, H>::hold(const StepEquations<N, H>& equations, const typename S::Oscillators& u,
                               typename S::State& z) const {
  if ((stuck & equations.holding) == 0) return;
  const Eigen::Index n = equations.masses();
  const typename S::Contacts support = equations.support_velocity * u;
  if (equations.is_large()) return keep(equations.sparse, held, support.data(), z.data() + n);
  const typename S::Contacts slip = equations.W.transpose() * z.segment(n, n) + support;
  z.segment(n, n).noalias() -= tables.reaction * slip;
}

template <int N, int H>
typename Sizes<N, H>::ContactSquare Configuration<N, H>::constraint(
    const StepEquations<N, H>& equations) const {
  if (!equations.is_large()) return tables.constraint;
  const Eigen::Index m = equations.contacts();
  typename S::ContactSquare all = S::ContactSquare::Zero(m, m);
  for (std::size_t i = 0; i < held.list.size(); ++i) {
    for_each_entry(held.force, static_cast<int>(i), [&](int k, double value) {
      all(held.list[i], held.list[static_cast<std::size_t>(k)]) = value;
    });
  }
  return all;
}

template <int N, int H>
typename Sizes<N, H>::VectorByContacts Configuration<N, H>::reaction(
    const StepEquations<N, H>& equations) const {
  if (!equations.is_large()) return tables.reaction;
  return equations.MW * constraint(equations);
}

template <int N, int H>
typename Sizes<N, H>::Square Configuration<N, H>::projector(const StepEquations<N, H>& equations) const {
  if (!equations.is_large()) return tables.P;
  const Eigen::Index n = equations.masses();
  if (held.hold_all) return S::Square::Zero(n, n);
  return S::Square::Identity(n, n) - reaction(equations) * equations.W.transpose();
}

template <int N, int H>
template <class Displacements, class Velocities, class Forces>
void Configuration<N, H>::pull(const StepEquations<N, H>& equations, const Displacements& q,
                               const Velocities& v, const Forces& s, typename S::Vector& a) const {
  a.resize(equations.masses());
  if (equations.is_large()) {
    Eigen::VectorXd ds(equations.internal_forces());
    return periodic::pull(equations.sparse, held, q.data(), v.data(), s.data(), a.data(), ds.data());
  }
  a.noalias() = tables.Aq * q;
  a.noalias() += tables.Av * v;
  if constexpr (S::kInternal != 0) a.noalias() += tables.As * s;
}

template <int N, int H>
Eigen::Matrix<double, N, Sizes<N, H>::kState> Configuration<N, H>::pull_by_state(
    const StepEquations<N, H>& equations) const {
  const Eigen::Index n = equations.masses(), internal = equations.internal_forces();
  Eigen::Matrix<double, N, S::kState> A(n, equations.states());
  if (equations.is_large()) {
    const typename S::Square left = -(projector(equations) * equations.M_inverse);
    A.leftCols(n).noalias() = left * equations.stiffness_beyond(beyond);
    A.middleCols(n, n).noalias() = left * equations.damping_beyond(beyond);
    A.rightCols(internal).noalias() = left * equations.D;
    return A;
  }
  A.leftCols(n) = tables.Aq;
  A.middleCols(n, n) = tables.Av;
  if constexpr (S::kInternal != 0) A.rightCols(internal) = tables.As;
  return A;
}

template <int N, int H>
typename Sizes<N, H>::State Configuration<N, H>::pull_form(const StepEquations<N, H>& equations,
                                                           const typename S::Vector& w) const {
  const Eigen::Index n = equations.masses(), internal = equations.internal_forces();
  typename S::State form(equations.states());
  if (equations.is_large()) {
    // -w^T P M^-1 (K, C, D)
    typename S::Vector left = equations.W * forces_for(equations, (equations.MW.transpose() * w).eval()) - w;
    if (held.hold_all) left.setZero();
    left = (equations.M_inverse * left).eval();
    form.head(n).noalias() = equations.K * left;
    form.segment(n, n).noalias() = equations.C * left;
    for (const BeyondBend<double>& bend : held.beyond) {
      const auto b = equations.bends.B.col(bend.index);
      form.head(n) += (bend.stiffness * b.dot(left)) * b;
      form.segment(n, n) += (bend.damping * b.dot(left)) * b;
    }
    form.tail(internal).noalias() = equations.D.transpose() * left;
    return form;
  }
  form.head(n) = tables.Aq.transpose() * w;
  form.segment(n, n) = tables.Av.transpose() * w;
  if constexpr (S::kInternal != 0) form.tail(internal) = tables.As.transpose() * w;
  return form;
}

template <int N, int H>
typename Sizes<N, H>::Vector Configuration<N, H>::pull_of_friction(
    const StepEquations<N, H>& equations, const typename S::Contacts& friction) const {
  typename S::Vector a(equations.masses());
  if (!equations.is_large()) {
    a.noalias() = tables.Af.lazyProduct(friction);
  } else {
    a.noalias() = -(equations.MW * friction);
    keep(equations.sparse, held, nullptr, a.data());
  }
  return a;
}

}  // namespace frahm::periodic
