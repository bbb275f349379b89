#pragma once

#include "solvers/events/walk.hpp"

// Bodies of Walk: how small changes of the state move with it, as a tangent that is followed or as a path
// that is recorded.
namespace frahm::periodic {

// The tangent that keeps the stuck contacts stuck.
template <int N, int H>
void Walk<N, H>::begin_tangent(Passage<N, H>& passage) const {
  if (passage.has_path) {
    passage.path = {.first_mode = w_.mode, .stopped = stopped_at_start()};
    return;
  }
  if (!passage.has_tangent) return;
  const StepEquations<N, H>& eq = flow_.equations();
  const Eigen::Index n = eq.masses();
  passage.tangent.setIdentity(eq.states(), eq.states());
  passage.tangent.block(n, n, n, n) = flow_.configuration(flow_.mode(w_.mode)).projector(eq);
  if constexpr (S::kInternal != 0) {
    for (const int i : stopped_at_start()) passage.tangent(2 * n + i, 2 * n + i) = 0.0;
  }
}

// The internal forces that stay at their limit.
template <int N, int H>
std::vector<int> Walk<N, H>::stopped_at_start() const {
  const StepEquations<N, H>& eq = flow_.equations();
  std::vector<int> stopped;
  for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
    if (!eq.holds(j) && !contains(flow_.mode(w_.mode).stuck, j))
      stopped.push_back(static_cast<int>(eq.internal_of[static_cast<std::size_t>(j)]));
  }
  return stopped;
}

// The tangent moves with the homogeneous flow: that of a small system step by step; the path of a large one
// has a stretch up to each event.
template <int N, int H>
void Walk<N, H>::move_tangent(double steps, Passage<N, H>& passage) {
  if (passage.has_path)
    w_.behind += steps;
  else if (passage.has_tangent)
    flow_.move_tangent(flow_.mode(w_.mode), steps, passage.tangent);
}

template <int N, int H>
void Walk<N, H>::end_stretch(Passage<N, H>& passage) {
  if (passage.has_path) passage.path.stretches.push_back({.mode = w_.mode, .steps = w_.behind});
  w_.behind = 0.0;
}

// Small changes across an event, by w_.jumps. An internal force that lets go stays at its limit: s' falls
// from g' to 0, so that ds+ = ds- + (0 - g') ds-/g' = 0.
template <int N, int H>
void Walk<N, H>::saltate(ContactMask released, Passage<N, H>& passage) {
  const StepEquations<N, H>& eq = flow_.equations();
  const Eigen::Index n = eq.masses();
  std::vector<int> stopped;
  for (Eigen::Index j = 0; (released & ~eq.holding) != 0 && j < eq.contacts(); ++j) {
    if (contains(released & ~eq.holding, j))
      stopped.push_back(static_cast<int>(eq.internal_of[static_cast<std::size_t>(j)]));
  }
  if (passage.has_path) {
    TangentPath::Stretch& stretch = passage.path.stretches.back();
    for (const auto& jump : w_.jumps) stretch.jumps.push_back({jump.contact, jump.change, jump.by});
    stretch.stopped = stopped;
  } else {
    Eigen::Matrix<double, N, S::kState> correction;
    correction.setZero(n, eq.states());
    for (const auto& jump : w_.jumps) {
      if (jump.contact >= 0)
        correction +=
            jump.change * (eq.W.col(jump.contact).transpose() * passage.tangent.middleRows(n, n)).eval();
      else
        correction += jump.change * (jump.by.transpose() * passage.tangent).eval();
    }
    passage.tangent.middleRows(n, n) += correction;
    for (const int i : stopped) passage.tangent.row(2 * n + i).setZero();
  }
  w_.jumps.clear();
}

// Contacts that begin to stick at an event take up what is left of their velocities, M-orthogonally:
//   dv+ = dv - M^-1 W G^+ W^T dv
// What a single arrival adds is that already. Where several come together, or where one event of an instant
// catches what another one has set sliding, it is left to do.
template <int N, int H>
void Walk<N, H>::catch_contacts(ContactMask arrived, const Mode<N, H>& mode_before, Passage<N, H>& passage) {
  const StepEquations<N, H>& eq = flow_.equations();
  const ContactMask stuck = flow_.mode(w_.mode).stuck & eq.holding, caught = stuck & ~mode_before.stuck;
  if (caught == 0 || (caught == (arrived & eq.holding) && count(caught) == 1)) return;
  const typename S::VectorByContacts reaction = flow_.configuration(flow_.mode(w_.mode)).reaction(eq);
  end_stretch(passage);  // the jumps before are done
  for (ContactMask left = stuck; left != 0; left &= left - 1)
    w_.jumps.push_back(
        {.contact = static_cast<int>(first(left)), .change = -reaction.col(first(left)), .by = {}});
  saltate(0, passage);
}

}  // namespace frahm::periodic
