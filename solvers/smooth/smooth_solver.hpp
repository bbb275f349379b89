#pragma once

#include <memory>
#include <vector>

#include "solvers/exact/response.hpp"
#include "solvers/orbits/orbits_wanted.hpp"
#include "solvers/quantities/quantity.hpp"

// Periodic responses under smooth laws (mechanics/smooth_laws.hpp): friction by arctan or by a curve over the
// speed, springs with a cubic part.
namespace frahm::smooth {

// A solver for a network all of whose contacts are smooth. Where its laws are monotone it starts from the
// orbit of the exact law, or the linear response, and shoots on the sensitivities of CVODES; otherwise it
// searches the orbits that are wanted. Throws mechanics::MechanicsError for a network that cannot move, or
// that has contacts, stops or tables that are followed exactly.
std::unique_ptr<periodic::ResponseSolver> make_solver(const mechanics::Network& network,
                                                      const std::vector<periodic::Quantity>& quantities,
                                                      const periodic::OrbitsWanted& wanted);

}  // namespace frahm::smooth
