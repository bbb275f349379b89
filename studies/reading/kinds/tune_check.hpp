#pragma once

#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// Refuses values that are invalid at a corner of the bounds, of the scenarios and of the band, and gives each
// crank the even orders that it needs there.
void check_tuning(Study& study);

}  // namespace frahm::studies
