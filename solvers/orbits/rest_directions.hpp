#pragma once

#include <Eigen/Core>

#include "solvers/flow/flow.hpp"

namespace frahm::periodic {

// Contacts that stick throughout may rest anywhere in an interval: a shift of their mean forces by delta
// moves the whole orbit by E delta and leaves every velocity as it is, so that all of these orbits are
// periodic, with multiplier +1. What the flow keeps for ever is L^T z. Column j, of a contact with direction
// w:
//   held by friction           E = (-K^-1 w, 0, 0)     L = (-w, 0, 0)        L^T z = -w^T q
//   with an internal force s   E = (-K^-1 w, 0, e_s)   L = (-w, 0, e_s / k)  L^T z = s/k - w^T q
// L^T x is 2 (E, x) of the energy norm, so that 1 - E (L^T E)^+ L^T takes them out orthogonally in it.
struct RestDirections {
  Eigen::MatrixXd E, L;  // states x contacts
};

template <int N, int H>
RestDirections rest_directions(const StepEquations<N, H>& eq, ContactMask contacts) {
  const Eigen::Index n = eq.masses();
  RestDirections rest;
  rest.E.setZero(eq.states(), count(contacts));
  rest.L.setZero(eq.states(), count(contacts));
  Eigen::Index column = 0;
  for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
    if (!contains(contacts, j)) continue;
    rest.E.col(column).head(n) = -(eq.K_inverse * eq.W.col(j));
    rest.L.col(column).head(n) = -eq.W.col(j);
    if (!eq.holds(j)) {
      const Eigen::Index internal = eq.internal_of[static_cast<std::size_t>(j)];
      rest.E(2 * n + internal, column) = 1.0;
      rest.L(2 * n + internal, column) = 1.0 / eq.internal_stiffness[internal];
    }
    ++column;
  }
  return rest;
}

// E (L^T E)^+ (states x contacts), the shift for a change of what is kept, L^T z; with L^T behind it the
// projector onto the shifts (states x states).
Eigen::MatrixXd shift_per_kept(const RestDirections& rest);
Eigen::MatrixXd shift_projector(const RestDirections& rest);

}  // namespace frahm::periodic
