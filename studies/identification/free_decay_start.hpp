#pragma once

#include "solvers/identification/grey_box.hpp"
#include "studies/reading/study.hpp"

// The grey box of one mass started by Liang and Feeny.
namespace frahm::studies {

// Damping ratio, friction and natural frequency from the first free record with a displacement.
identification::Identification first_estimates(const Study& study);

// Moves the starts of the task's parameters to where the mass on its spring has these, as nearly as the
// parameters can: what they do not determine stays as the study states it.
void set_start(const Study& study, const identification::Identification& first,
               identification::GreyBoxTask& task);

}  // namespace frahm::studies
