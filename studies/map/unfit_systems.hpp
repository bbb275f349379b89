#pragma once

#include <cstdint>
#include <string>

#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// The values of the axes at which a map has no system at all, whatever drives it: a mass of zero that no
// inerter holds, a motion that no spring holds.
struct UnfitSystems {
  std::uint64_t tried = 0,
                unfit = 0;       // systems, each for many points of the map where their frequency changes
  bool tried_all = true;         // of those there are
  std::string first_at, reason;  // of the first unfit one: as --at takes it

  bool are_all() const { return tried_all && tried > 0 && unfit == tried; }
};

// Tries the systems of a map for half a second at most.
UnfitSystems unfit_systems(const Study& study);

// Throws StudyError for a map of which no point has a system. The first that has one ends the search.
void refuse_unfit_map(const Study& study);

}  // namespace frahm::studies
