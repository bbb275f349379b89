#pragma once

#include <optional>
#include <vector>

#include "solvers/branches/corrector.hpp"

namespace frahm::periodic {

// A special place between two of a branch.
struct SpecialPlace {
  SpecialKind kind = SpecialKind::fold;
  BranchPlace place;
  std::optional<std::size_t> element{};  // of grazing and corner
  double residual = 0.0;
  bool is_solved = true;  // false: the places beside are too far apart, or on two branches
};

// The special places from one place of a branch to the next, in their order: where dp/ds changes its sign,
// where the number of unstable multipliers changes, and where events begin or end. Each is solved on the
// curve, at planes across the chord of the two.
std::vector<SpecialPlace> special_places(BranchMap& map, const BranchPlace& from, const BranchPlace& to);

// How far an event (BranchMap::events) is from just happening: the width given, of the bracket that holds it,
// or the distance of a bend's guard from zero at an extreme, relative, if that is less.
double residual_of_grazing(BranchMap& map, const BranchPlace& place, double width, std::size_t event);

}  // namespace frahm::periodic
