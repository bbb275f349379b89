#pragma once

#include <vector>

#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/system/network_reading.hpp"
#include "studies/reading/text/study_source.hpp"

// Whether every mass is held.
namespace frahm::studies {

// Every mass must be held: by a chain of springs from ground or a node of prescribed motion; but in a motion
// from initial values masses may be free.
// masses: their positions in the study.
void check_masses_are_held(const StudyContext& context, const NetworkOfStudy& system,
                           const std::vector<Position>& masses, StudyKind kind);
// The same where levers hold them, whose factors are settled.
void check_combinations_are_held(const Study& study);

}  // namespace frahm::studies
