#pragma once

#include <Eigen/Core>

#include "solvers/flow/flow.hpp"
#include "solvers/mechanics/free_directions.hpp"

namespace frahm::periodic {

// Contacts that stick throughout may rest anywhere in an interval: a shift delta of their mean forces moves
// the whole orbit by E delta and leaves every velocity unchanged. All of these orbits are periodic, with
// multiplier +1. The flow does not change L^T z. Column j, for a contact with direction w:
//   held by friction           E = (-K^-1 w, 0, 0)     L = (-w, 0, 0)        L^T z = -w^T q
//   with an internal force s   E = (-K^-1 w, 0, e_s)   L = (-w, 0, e_s / k)  L^T z = s/k - w^T q
// L^T x = 2 (E, x) in the energy norm, so 1 - E (L^T E)^+ L^T removes these directions orthogonally.
// Along free directions R nothing balances mean forces but one another: delta = A beta, R^T W A = 0, of which
// E and L have a column each. Where contacts rest along R is free, as every place there is (closing.hpp).
struct RestDirections {
  Eigen::MatrixXd E, L;      // states x contacts, or x combinations
  Eigen::MatrixXd balanced;  // A, contacts x combinations; 0 x 0: any forces are
};

// Leaves those shifts that balance one another. along: R^T W of the contacts.
void keep_balanced(const Eigen::MatrixXd& along, RestDirections& rest);

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
  if (eq.has_free_masses)
    keep_balanced(mechanics::strained_along(eq.W(Eigen::all, list_of(contacts)), eq.free.R).transpose(),
                  rest);
  return rest;
}

// E (L^T E)^+ (states x contacts): the shift of the state per change of the constants L^T z. Times L^T from
// the right it is the projector onto the shifts (states x states).
Eigen::MatrixXd shift_per_kept(const RestDirections& rest);
Eigen::MatrixXd shift_projector(const RestDirections& rest);

}  // namespace frahm::periodic
