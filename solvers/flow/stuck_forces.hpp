#pragma once

// Flow: the forces of stuck contacts, and the guards of all. Included by flow.hpp.
#include "solvers/flow/flow.hpp"

namespace frahm::periodic {

// The parts of a state z = (q, v, s).
enum StatePart { displacements, velocities, internals };

// Calls each(part, i, weight) for the terms of -(W^T M^-1 (K q + C v + D s + bends))_contact, the relative
// acceleration of a contact under no friction, of a large system; all weights times `scale`.
template <int N, int H, class Each>
void for_each_pull(const StepEquations<N, H>& eq, const HeldContacts& held, int contact, double scale,
                   const Each& each) {
  const SparseSystem& system = eq.sparse;
  const auto add = [&](const SparseRows& rows, int row, double factor, StatePart part) {
    for_each_entry(rows, row, [&](int i, double value) { each(part, i, factor * value); });
  };
  add(system.contact_stiffness, contact, -scale, displacements);
  add(system.contact_damping, contact, -scale, velocities);
  add(system.contact_internal, contact, -scale, internals);
  for (const BeyondBend<double>& bend : held.beyond) {
    const double share = -scale * eq.bends.contact_pull(contact, bend.index);
    if (share == 0.0) continue;
    add(system.bend_directions, bend.index, share * bend.stiffness, displacements);
    add(system.bend_directions, bend.index, share * bend.damping, velocities);
  }
}

// The same for Lq q + Lv v + Ls s, the force of stuck contact j.
template <int N, int H, class Each>
void for_each_force_term(const StepEquations<N, H>& eq, const Configuration<N, H>& c, Eigen::Index j,
                         const Each& each) {
  if (!eq.holds(j))
    return each(internals, static_cast<int>(eq.internal_of[static_cast<std::size_t>(j)]), 1.0);
  const HeldContacts& held = c.held;
  const auto place = std::ranges::lower_bound(held.list, static_cast<int>(j)) - held.list.begin();
  for_each_entry(held.force, static_cast<int>(place), [&](int k, double force) {
    for_each_pull(eq, held, held.list[static_cast<std::size_t>(k)], force, each);
  });
}

template <int N, int H>
typename Sizes<N, H>::State Flow<N, H>::stuck_force_form(const Mode<N, H>& mode, Eigen::Index j) const {
  const StepEquations<N, H>& eq = equations_;
  const Configuration<N, H>& c = configuration(mode);
  const Eigen::Index n = eq.masses();
  typename S::State form = S::State::Zero(eq.states());
  if (eq.is_large()) {
    for_each_force_term(eq, c, j,
                        [&](StatePart part, int i, double weight) { form[part * n + i] += weight; });
    return form;
  }
  form.head(n) = c.tables.Lq.row(j).transpose();
  form.segment(n, n) = c.tables.Lv.row(j).transpose();
  if constexpr (S::kInternal != 0) form.tail(eq.internal_forces()) = c.tables.Ls.row(j).transpose();
  return form;
}

// lambda_j and its slope from the parts of the state and their rates.
template <int N, int H>
inline ValueAndSlope Flow<N, H>::stuck_force(const Instant<N, H>& at, const Mode<N, H>& mode,
                                             Eigen::Index j) const {
  const Eigen::Index n = equations_.masses();
  const Configuration<N, H>& c = configuration(mode);
  ValueAndSlope force{c.Lu.row(j).dot(at.u) + mode.stuck_force[j], c.Lu.row(j).dot(at.du)};
  if (equations_.is_large()) {
    const double* const value[] = {at.z.data(), at.z.data() + n, at.z.data() + 2 * n};
    const double* const rate[] = {at.z.data() + n, at.a.data(), at.ds.data()};
    for_each_force_term(equations_, c, j, [&](StatePart part, int i, double weight) {
      force.value += weight * value[part][i];
      force.slope += weight * rate[part][i];
    });
    return force;
  }
  const auto q = at.z.head(n), v = at.z.segment(n, n);
  force.value += c.tables.Lq.row(j).dot(q) + c.tables.Lv.row(j).dot(v);
  force.slope += c.tables.Lq.row(j).dot(v) + c.tables.Lv.row(j).dot(at.a);
  if constexpr (S::kInternal != 0) {
    force.value += c.tables.Ls.row(j).dot(at.z.tail(equations_.internal_forces()));
    force.slope += c.tables.Ls.row(j).dot(at.ds);
  }
  return force;
}

template <int N, int H>
Polynomial Flow<N, H>::stuck_force(const Expansion<N, H>& x, const Mode<N, H>& mode, Eigen::Index j) const {
  const Eigen::Index n = equations_.masses();
  const Configuration<N, H>& c = configuration(mode);
  Polynomial force = x.u * c.Lu.row(j).transpose();
  force[0] += mode.stuck_force[j];
  if (equations_.is_large()) {
    for_each_force_term(equations_, c, j, [&](StatePart part, int i, double weight) {
      force += weight * x.z.col(part * n + i);
    });
    return force;
  }
  force += x.displacement(c.tables.Lq.row(j).transpose());
  force += x.velocity(c.tables.Lv.row(j).transpose());
  if constexpr (S::kInternal != 0) force += x.internal_force(c.tables.Ls.row(j).transpose());
  return force;
}

template <int N, int H>
inline Polynomial Flow<N, H>::guard(const Instant<N, H>& at, const Mode<N, H>& mode, Eigen::Index j) const {
  const StepTables<N, H>& tables = configuration(mode).tables;
  const Eigen::Index first = kTerms * j;
  Polynomial guard = mode.guards.template segment<kTerms>(first);
  for (Eigen::Index i = 0; i < at.z.size(); ++i)
    guard += at.z[i] * tables.guard_z.col(i).template segment<kTerms>(first);
  for (Eigen::Index i = 0; i < at.u.size(); ++i)
    guard += at.u[i] * tables.guard_u.col(i).template segment<kTerms>(first);
  return guard;
}

}  // namespace frahm::periodic
