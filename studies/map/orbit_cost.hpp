#pragma once

#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// About the seconds that a point of the study's map takes one core, by its number of masses and contacts and
// the laws it meets: a function of the study alone, by which its tiles are sized. Within a factor of some
// four of what was measured from 1 to 60 masses.
double predicted_orbit_seconds(const Study& study);

}  // namespace frahm::studies
