#pragma once

#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// About the seconds that a point of a map of motions takes one core: the steps of the fastest motion at the
// first point, times what a step was measured to take. A function of the study alone, by which its tiles are
// sized.
double predicted_motion_seconds(const Study& study);

}  // namespace frahm::studies
