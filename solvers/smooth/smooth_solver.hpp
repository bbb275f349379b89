#pragma once

#include <memory>
#include <vector>

#include "solvers/exact/response.hpp"
#include "solvers/quantities/quantity.hpp"

// Periodic responses under the arctan law, F (2/pi) arctan(slope v), which smooths Coulomb's.
namespace frahm::smooth {

// Whether some Coulomb element of the network follows the arctan law.
bool is_smooth(const mechanics::Network& network);

// A solver for a network whose Coulomb elements all follow the arctan law. It starts from the orbit of the
// exact law and shoots on the sensitivities of CVODES. Throws mechanics::MechanicsError for a network that
// cannot move or that mixes the laws.
std::unique_ptr<periodic::ResponseSolver> make_solver(const mechanics::Network& network,
                                                      std::vector<periodic::Quantity> quantities);

}  // namespace frahm::smooth
