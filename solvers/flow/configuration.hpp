#pragma once

#include <Eigen/Core>

#include "solvers/flow/constraints.hpp"
#include "solvers/flow/equations.hpp"
#include "solvers/flow/step_tables.hpp"

namespace frahm::periodic {

// The linear system that moves while one set of contacts sticks and the others slide. With G = W^T M^-1 W
// over the held contacts and P = 1 - M^-1 W G^+ W^T:
//   q'' = -P M^-1 (K q + C v + D s + W phi) + Au u(t),   phi_j = sigma_j F_j of the contacts that slide, else
//   0 s'  = spring (D^T v + p^T y') - rate s,              spring = k, 0 of an internal force that is held
//   lambda_j = (Lq q + Lv v + Ls s + Lu u(t) + Lf phi)_j of the stuck contacts (of an internal force: s)
// K, C and the forcing are those beyond a set of bends (StepBends).
// Small systems have tables of its flow over a step (StepTables), large ones only the held contacts.
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
  typename S::ContactsByVector Lq, Lv;
  typename S::ContactsByInternal Ls;
  typename S::ContactsByOscillators Lu;
  typename S::Internal spring;                       // of each internal force k, or 0 while it is held
  typename S::InternalByOscillators internal_drive;  // spring p^T y'(t) [N a step]
  StepTables<N, H> tables;                           // of a small system
  HeldContacts held;                                 // of a large system

  // Removes rounding from the velocities of the held contacts, M-orthogonally.
  void hold(const StepEquations<N, H>& equations, const typename S::Oscillators& u,
            typename S::State& z) const {
    if ((stuck & equations.holding) == 0) return;
    const Eigen::Index n = equations.masses();
    typename S::Contacts slip = equations.W.transpose() * z.segment(n, n);
    slip.noalias() += equations.support_velocity * u;
    z.segment(n, n).noalias() -= reaction_ * slip;
  }

  // These meet the constraint w_j^T q'' = -p_j^T y'' of the held contacts:
  const typename S::ContactSquare& constraint() const { return constraint_; }  // G^+
  const typename S::VectorByContacts& reaction() const { return reaction_; }   // M^-1 W G^+

  // P
  typename S::Square projector(const StepEquations<N, H>& equations) const;
  // Whether no mass can move: P = 0.
  bool holds_all(const StepEquations<N, H>& equations) const {
    return equations.is_large() ? held.hold_all : tables.P.isZero(0.0);
  }
  // -P M^-1 (K q + C v + D s)
  template <class Displacements, class Velocities, class Forces>
  typename S::Vector pull(const StepEquations<N, H>& equations, const Displacements& q, const Velocities& v,
                          const Forces& s) const;
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
    typename S::Contacts force(friction.size());
    force.noalias() = -(constraint_ * (equations.mobility * friction));
    return force;
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
  void set_constraint(const StepEquations<N, H>& equations);
  void set_springs(const StepEquations<N, H>& equations);
  void set_tables(const StepEquations<N, H>& equations);
  void set_held(const StepEquations<N, H>& equations);

  ContactMask frictionless_ = 0;           // internal forces with limit zero, which are always zero
  ContactMask immobile_ = 0;               // contacts that count as sliding but are held by the stuck ones
  typename S::ContactSquare constraint_;   // zero rows and columns for sliding contacts
  typename S::VectorByContacts reaction_;  // accelerations per unit of relative acceleration
};

template <int N, int H>
typename Sizes<N, H>::Square Configuration<N, H>::projector(const StepEquations<N, H>& equations) const {
  if (!equations.is_large()) return tables.P;
  const Eigen::Index n = equations.masses();
  if (held.hold_all) return S::Square::Zero(n, n);
  return S::Square::Identity(n, n) - reaction_ * equations.W.transpose();
}

template <int N, int H>
template <class Displacements, class Velocities, class Forces>
typename Sizes<N, H>::Vector Configuration<N, H>::pull(const StepEquations<N, H>& equations,
                                                       const Displacements& q, const Velocities& v,
                                                       const Forces& s) const {
  typename S::Vector a(equations.masses());
  if (equations.is_large()) {
    Eigen::VectorXd ds(equations.internal_forces());
    periodic::pull(equations.sparse, held, q.data(), v.data(), s.data(), a.data(), ds.data());
    return a;
  }
  a.noalias() = tables.Aq * q + tables.Av * v;
  if constexpr (S::kInternal != 0) a += tables.As * s;
  return a;
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
    typename S::Vector left = equations.W * (reaction_.transpose() * w) - w;
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
    keep(equations.sparse, held, a.data());
  }
  return a;
}

template <int N, int H>
void Configuration<N, H>::set_system(const StepEquations<N, H>& equations, ContactMask stuck_contacts,
                                     ContactMask beyond_bends) {
  stuck = stuck_contacts;
  beyond = beyond_bends;
  has_forcing = false;
  set_constraint(equations);
  set_springs(equations);
  if (equations.is_large())
    set_held(equations);
  else
    set_tables(equations);
}

// G^+ over the held contacts, and what it holds.
template <int N, int H>
void Configuration<N, H>::set_constraint(const StepEquations<N, H>& equations) {
  const Eigen::Index m = equations.contacts();
  // Their directions may be linearly dependent; of the forces that are then equivalent, those of least sum
  // (lambda_j / F_j)^2 are taken.
  const ContactMask holding = stuck & equations.holding;
  constraint_.setZero(m, m);
  if (count(holding) == 1) {
    const Eigen::Index j = first(holding);
    constraint_(j, j) = 1.0 / equations.compliance[j];
  } else if (holding != 0 && equations.is_large() && !equations.has_loops) {
    set_inverse(equations.mobility, holding, constraint_);
  } else if (holding != 0) {
    typename S::Contacts weight(m);
    for (Eigen::Index j = 0; j < m; ++j) weight[j] = contains(holding, j) ? equations.limit[j] : 0.0;
    constraint_ = weighted_pseudo_inverse(equations.mobility, weight);
  }
  reaction_ = equations.MW * constraint_;

  // A contact that slides has the mobility (G - G G^+ G)_jj.
  immobile_ = 0;
  if (holding == 0 || (equations.is_large() && !equations.has_loops)) return;
  for (Eigen::Index j = 0; j < m; ++j) {
    constexpr double kImmobile = 1e-10;  // of its compliance: rounding of what a loop takes away
    if (!contains(equations.holding & ~stuck, j)) continue;
    const auto row = equations.mobility.row(j);
    const double mobility = equations.compliance[j] - row.dot(constraint_ * row.transpose());
    if (mobility <= kImmobile * equations.compliance[j]) immobile_ |= bit(j);
  }
}

template <int N, int H>
void Configuration<N, H>::set_springs(const StepEquations<N, H>& equations) {
  frictionless_ = 0;
  if constexpr (S::kInternal != 0) {
    spring = equations.internal_stiffness;
    Ls.noalias() = -(reaction_.transpose() * equations.D);
    for (Eigen::Index j = 0; j < equations.contacts(); ++j) {
      const Eigen::Index internal = equations.internal_of[static_cast<std::size_t>(j)];
      if (internal < 0) continue;
      Ls(j, internal) = 1.0;
      if (equations.limit[j] == 0.0) frictionless_ |= bit(j);
      if (!contains(stuck, j)) spring[internal] = 0.0;
    }
  }
}

template <int N, int H>
void Configuration<N, H>::set_tables(const StepEquations<N, H>& equations) {
  const Eigen::Index n = equations.masses();
  typename S::Square& P = tables.P;
  P = S::Square::Identity(n, n) - reaction_ * equations.W.transpose();
  // A projector's trace is its rank, so one without a large entry is zero: every mass is held.
  if (P.cwiseAbs().maxCoeff() < 1e-12) P.setZero();
  // For a force on the masses: the acceleration that remains, and the force that the stuck contacts take; the
  // sign is that of the pull of the springs and dampers.
  const typename S::Square left = -(P * equations.M_inverse);
  const typename S::ContactsByVector taken = -reaction_.transpose();
  const typename S::Square K = equations.stiffness_beyond(beyond), C = equations.damping_beyond(beyond);
  tables.Aq.noalias() = left * K;
  tables.Av.noalias() = left * C;
  tables.Af.noalias() = left * equations.W;
  if constexpr (S::kInternal != 0) tables.As.noalias() = left * equations.D;
  Lq.noalias() = taken * K;
  Lv.noalias() = taken * C;
  tables.propagate_homogeneous(equations, spring);
}

template <int N, int H>
void Configuration<N, H>::set_held(const StepEquations<N, H>& equations) {
  const Eigen::Index n = equations.masses(), m = equations.contacts();
  held.list.clear();
  for (Eigen::Index j = 0; j < m; ++j) {
    if (contains(stuck & equations.holding, j)) held.list.push_back(static_cast<int>(j));
  }
  held.force = rows_alone(constraint_(held.list, held.list));
  held.spring = spring;
  held.beyond.clear();
  for (Eigen::Index j = 0; beyond != 0 && j < equations.bends.count(); ++j) {
    if (!contains(beyond, j)) continue;
    held.beyond.push_back({static_cast<int>(j), equations.bends.stiffness[j], equations.bends.damping[j]});
  }
  held.hold_all =
      static_cast<Eigen::Index>(held.list.size()) >= n && projector(equations).cwiseAbs().maxCoeff() < 1e-12;
  Lq.setZero(m, n);
  Lv.setZero(m, n);
  for (const int j : held.list) {
    for (const int i : held.list) {
      equations.sparse.pull_by_displacement.add_row(i, -constraint_(j, i), Lq.row(j).data());
      equations.sparse.pull_by_velocity.add_row(i, -constraint_(j, i), Lv.row(j).data());
    }
    for (const BeyondBend<double>& bend : held.beyond) {
      const auto b = equations.bends.B.col(bend.index);
      const double share = -reaction_.col(j).dot(b);
      Lq.row(j) += (share * bend.stiffness) * b.transpose();
      Lv.row(j) += (share * bend.damping) * b.transpose();
    }
  }
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
  const typename S::VectorByOscillators force = equations.force_beyond(beyond);
  Au.noalias() = equations.M_inverse * force;
  if (equations.is_large()) {
    for (Eigen::Index k = 0; k < Au.cols(); ++k) keep(equations.sparse, held, Au.col(k).data());
  } else {
    Au = (tables.P * Au).eval();
  }
  Lu.noalias() = reaction_.transpose() * force;
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
  if (!equations.is_large()) tables.propagate_forcing(equations, spring, Au, internal_drive);
}

}  // namespace frahm::periodic
