#pragma once

#include "solvers/identification/identification.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// The result of a method that needs no model of the system: all but grey_box. If nothing can be found, its
// `failure` says why.
identification::Identification identify_in_closed_form(const Study& study);

}  // namespace frahm::studies
