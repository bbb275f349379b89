#pragma once

#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// Refuses values that are invalid in some record at the start of the fit, and gives each crank the even
// orders that it needs there. Other points within the bounds may be invalid: the fit avoids them.
void check_identification(Study& study);

}  // namespace frahm::studies
