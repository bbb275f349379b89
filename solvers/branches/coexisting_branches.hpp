#pragma once

#include <optional>
#include <span>
#include <vector>

#include "solvers/branches/branch.hpp"
#include "solvers/orbits/orbits_wanted.hpp"

namespace frahm::periodic {

// A value of the parameter at which stable orbits are searched.
struct SearchedPlace {
  double parameter = 0.0;  // within the range
  // How many stable orbits are known to be there: none is searched where the branches followed so far have as
  // many. Nothing where that is not known.
  std::optional<int> stable = std::nullopt;
};

// The branches of all stable orbits that are found at these places, each branch once, in the order in which
// they are found. wanted: its start and multiple are not used. searched: as in orbits_wanted.hpp; of a system
// of one response nothing is searched. Places where values break a rule are left out.
// Throws mechanics::MechanicsError for a network that cannot move.
std::vector<Branch> follow_branches(const mechanics::Network& network,
                                    const std::vector<Quantity>& quantities, const ValuesAlong& values,
                                    const BranchWanted& wanted, const OrbitsWanted& searched,
                                    std::span<const SearchedPlace> places,
                                    const BranchProgress& progress = {});

}  // namespace frahm::periodic
