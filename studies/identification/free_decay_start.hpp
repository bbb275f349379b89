#pragma once

#include "solvers/identification/grey_box.hpp"
#include "studies/reading/study/study.hpp"

// The grey box of one mass started by Liang and Feeny.
namespace frahm::studies {

// Damping ratio, friction and natural frequency from the first free record with a displacement.
identification::Identification first_estimates(const Study& study);

// Sets the starting parameters of the task so that the mass on its spring has these estimates, as nearly as
// possible; parameters that they do not determine keep the study's values.
void set_start(const Study& study, const identification::Identification& first,
               identification::GreyBoxTask& task);

}  // namespace frahm::studies
