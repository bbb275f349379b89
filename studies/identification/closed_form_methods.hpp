#pragma once

#include "solvers/identification/identification.hpp"
#include "studies/reading/study.hpp"

namespace frahm::studies {

// The answer of a method that needs no model of the system: all but grey_box. What cannot be found is its
// failure.
identification::Identification identify_in_closed_form(const Study& study);

}  // namespace frahm::studies
