#pragma once

#include "solvers/flow/configuration.hpp"
#include "solvers/flow/constraints.hpp"

// Bodies of Configuration: how it is made from the equations, for the files that instantiate Flow.
namespace frahm::periodic {

template <int N, int H>
void Configuration<N, H>::set_system(const StepEquations<N, H>& equations, ContactMask stuck_contacts,
                                     ContactMask beyond_bends) {
  stuck = stuck_contacts;
  beyond = beyond_bends;
  has_forcing = false;
  set_springs(equations);
  if (equations.is_large())
    set_held(equations);
  else
    set_tables(equations);
  find_immobile(equations);
}

// G^+ over the held contacts (m x m, zero for others). Their directions may be linearly dependent; of the
// forces that are then equivalent, those of least sum (lambda_j / F_j)^2 are taken.
template <int N, int H>
Eigen::MatrixXd Configuration<N, H>::inverse_mobility(const StepEquations<N, H>& equations,
                                                      ContactMask holding) const {
  Eigen::VectorXd weight(equations.contacts());
  for (Eigen::Index j = 0; j < weight.size(); ++j)
    weight[j] = contains(holding, j) ? equations.limit[j] : 0.0;
  return weighted_pseudo_inverse(equations.mobility, weight);
}

// A contact that slides has the mobility (G - G G^+ G)_jj.
template <int N, int H>
void Configuration<N, H>::find_immobile(const StepEquations<N, H>& equations) {
  immobile_ = 0;
  if ((stuck & equations.holding) == 0 || (equations.is_large() && !equations.has_loops)) return;
  for (Eigen::Index j = 0; j < equations.contacts(); ++j) {
    constexpr double kImmobile = 1e-10;  // of its compliance: rounding of what a loop takes away
    if (!contains(equations.holding & ~stuck, j)) continue;
    const auto column = equations.mobility.col(j);
    const double mobility = equations.compliance[j] - column.dot(forces_for(equations, column));
    if (mobility <= kImmobile * equations.compliance[j]) immobile_ |= bit(j);
  }
}

template <int N, int H>
void Configuration<N, H>::set_springs(const StepEquations<N, H>& equations) {
  frictionless_ = 0;
  if constexpr (S::kInternal != 0) {
    spring = equations.internal_stiffness;
    for (Eigen::Index j = 0; j < equations.contacts(); ++j) {
      const Eigen::Index internal = equations.internal_of[static_cast<std::size_t>(j)];
      if (internal < 0) continue;
      if (equations.limit[j] == 0.0) frictionless_ |= bit(j);
      if (!contains(stuck, j)) spring[internal] = 0.0;
    }
  }
}

// The row of a mass that the stuck contacts hold is rounding, by which the mass would creep under a force:
// far in the many steps of a long period.
template <class Square>
void stop_held_masses(Square& P) {
  constexpr double kRounding = 1e-12;
  for (Eigen::Index i = 0; i < P.rows(); ++i) {
    if (P.row(i).cwiseAbs().maxCoeff() < kRounding) P.row(i).setZero();
  }
}

template <int N, int H>
void Configuration<N, H>::set_tables(const StepEquations<N, H>& equations) {
  const Eigen::Index n = equations.masses(), m = equations.contacts();
  const ContactMask holding = stuck & equations.holding;
  tables.constraint.setZero(m, m);
  if (count(holding) == 1)
    tables.constraint(first(holding), first(holding)) = 1.0 / equations.compliance[first(holding)];
  else if (holding != 0)
    tables.constraint = inverse_mobility(equations, holding);
  tables.reaction = equations.MW * tables.constraint;

  typename S::Square& P = tables.P;
  P = S::Square::Identity(n, n) - tables.reaction * equations.W.transpose();
  stop_held_masses(P);
  // For a force on the masses: the acceleration that remains, and the force that the stuck contacts take; the
  // sign is that of the pull of the springs and dampers.
  const typename S::Square left = -(P * equations.M_inverse);
  const typename S::ContactsByVector taken = -tables.reaction.transpose();
  const typename S::Square K = equations.stiffness_beyond(beyond), C = equations.damping_beyond(beyond);
  tables.Aq.noalias() = left * K;
  tables.Av.noalias() = left * C;
  tables.Af.noalias() = left * equations.W;
  tables.Lq.noalias() = taken * K;
  tables.Lv.noalias() = taken * C;
  if constexpr (S::kInternal != 0) {
    tables.As.noalias() = left * equations.D;
    tables.Ls.noalias() = taken * equations.D;
    for (Eigen::Index j = 0; j < m; ++j) {
      const Eigen::Index internal = equations.internal_of[static_cast<std::size_t>(j)];
      if (internal >= 0) tables.Ls(j, internal) = 1.0;
    }
  }
  tables.propagate_homogeneous(equations, spring);
  if constexpr (!S::is_fixed) tables.set_guards(equations, stuck);
}

template <int N, int H>
void Configuration<N, H>::set_held(const StepEquations<N, H>& equations) {
  const ContactMask holding = stuck & equations.holding;
  held.list.clear();
  for (Eigen::Index j = 0; j < equations.contacts(); ++j) {
    if (contains(holding, j)) held.list.push_back(static_cast<int>(j));
  }
  if (equations.has_loops)
    held.force = rows_alone(inverse_mobility(equations, holding)(held.list, held.list));
  else
    held.force = rows_alone(inverse_of(equations.mobility(held.list, held.list)));
  held.spring = spring;
  held.beyond.clear();
  for (Eigen::Index j = 0; beyond != 0 && j < equations.bends.count(); ++j) {
    if (!contains(beyond, j)) continue;
    held.beyond.push_back({static_cast<int>(j), equations.bends.stiffness[j], equations.bends.damping[j]});
  }
  held.hold_all = false;
  held.hold_all = static_cast<Eigen::Index>(held.list.size()) >= equations.masses() &&
                  projector(equations).cwiseAbs().maxCoeff() < 1e-12;
}

template <int N, int H>
void Configuration<N, H>::set_forcing(const StepEquations<N, H>& equations) {
  has_forcing = true;
  idle = frictionless_;
  for (Eigen::Index j = 0; immobile_ != 0 && j < equations.contacts(); ++j) {
    // Its velocity is (p_j - P_S^T G^+ W^T M^-1 w_j)^T y': none, unless a support moves it.
    const typename S::Contacts share = forces_for(equations, equations.mobility.col(j));
    typename S::OscillatorRow drag = equations.support_velocity.row(j);
    drag.noalias() -= share.transpose() * equations.support_velocity;
    // For the terms: it may touch no support itself, between masses that one and the same support holds.
    const typename S::Contacts speed = equations.support_velocity.rowwise().norm();
    const double size = speed[j] + share.cwiseAbs().dot(speed);
    if (contains(immobile_, j) && drag.norm() <= 1e-12 * size) idle |= bit(j);
  }
  if constexpr (S::kInternal != 0) {
    internal_drive = equations.internal_drive;
    for (Eigen::Index i = 0; i < spring.size(); ++i) {
      if (spring[i] == 0.0) internal_drive.row(i).setZero();
    }
  }
  // lambda = G^+ (W^T M^-1 f + p^T y'') of the held contacts, and P M^-1 f - M^-1 W G^+ p^T y''
  const typename S::VectorByOscillators force = equations.force_pull_beyond(beyond);
  const typename S::ContactsByOscillators& support = equations.support_acceleration;
  const bool holds_some = (stuck & equations.holding) != 0;
  Lu.setZero(equations.contacts(), force.cols());
  Au = force;
  for (Eigen::Index k = 0; holds_some && k < force.cols(); ++k) {
    const typename S::Contacts relative = equations.W.transpose() * force.col(k) + support.col(k);
    Lu.col(k) = forces_for(equations, relative);
    if (equations.is_large()) {
      const typename S::Contacts moved = support.col(k);
      keep(equations.sparse, held, moved.data(), Au.col(k).data());
    } else {
      Au.col(k) = tables.P * force.col(k) - tables.reaction * support.col(k);
    }
  }
  if (equations.is_large()) return;
  tables.propagate_forcing(equations, spring, Au, internal_drive);
  if constexpr (!S::is_fixed) tables.drive_guards(equations, stuck, Lu);
}

}  // namespace frahm::periodic
