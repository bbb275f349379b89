#pragma once

#include <algorithm>
#include <iterator>
#include <vector>

#include "solvers/branches/branch.hpp"
#include "tests/known_answers/single_mass.hpp"

namespace frahm::periodic::one_mass {

inline mechanics::Network mass_before_a_stop() {
  return driven_mass({elastic_stops({1.0})});
}
inline mechanics::Network held_mass() {
  return driven_mass({static_friction()});
}

inline std::vector<SpecialPoint> of_kind(const Branch& branch, SpecialKind kind) {
  std::vector<SpecialPoint> found;
  std::ranges::copy_if(branch.special, std::back_inserter(found),
                       [kind](const SpecialPoint& each) { return each.kind == kind; });
  return found;
}

}  // namespace frahm::periodic::one_mass
