#include "solvers/branches/coexisting_branches.hpp"

#include <algorithm>
#include <memory>

#include "solvers/branches/branch_start.hpp"
#include "solvers/branches/followed_branch.hpp"

namespace frahm::periodic {
namespace {

using FollowedBranches = std::vector<std::unique_ptr<FollowedBranch>>;

// Whether the branches have as many stable orbits at a place as are known to be there.
bool are_all(const FollowedBranches& branches, const SearchedPlace& place) {
  if (!place.stable) return false;
  int count = 0;
  for (const auto& branch : branches) {
    const std::optional<int> stable = branch->stable_at(place.parameter);
    if (!stable) return false;
    count += *stable;
  }
  return count >= *place.stable;
}

}  // namespace

std::vector<Branch> follow_branches(const mechanics::Network& network,
                                    const std::vector<Quantity>& quantities, const ValuesAlong& values,
                                    const BranchWanted& wanted, const OrbitsWanted& searched,
                                    std::span<const SearchedPlace> places, const BranchProgress& progress) {
  BranchMap map(network, values, wanted.low, wanted.high);
  FollowedBranches branches;
  const auto is_known = [&](double parameter, const AnyOrbit& orbit) {
    return std::ranges::any_of(branches,
                               [&](const auto& branch) { return branch->passes(parameter, orbit); });
  };
  for (const SearchedPlace& place : places) {
    if (are_all(branches, place)) continue;
    for (const AnyOrbit& orbit : find_stable(map, place.parameter, searched)) {
      if (is_known(place.parameter, orbit)) continue;
      auto branch = std::make_unique<FollowedBranch>(network, quantities, values, wanted);
      branch->map().set(place.parameter);
      branch->follow(orbit, is_known, progress);
      if (branch->branch().reason.empty()) branches.push_back(std::move(branch));
    }
  }
  std::vector<Branch> found;
  for (const auto& branch : branches) found.push_back(std::move(branch->branch()));
  return found;
}

}  // namespace frahm::periodic
