#pragma once

#include <memory>
#include <vector>

#include "solvers/exact/response.hpp"
#include "solvers/orbits/orbits_wanted.hpp"
#include "solvers/quantities/quantity.hpp"

namespace frahm::periodic {

// A solver of the exact friction law, regardless of the elements' law; with sizes known at compile time where
// one is compiled for this network. Throws mechanics::MechanicsError for a network that cannot move.
std::unique_ptr<ResponseSolver> make_exact_solver(const mechanics::Network& network,
                                                  const std::vector<Quantity>& quantities,
                                                  Path path = Path::general,
                                                  const OrbitsWanted& wanted = {});

}  // namespace frahm::periodic
