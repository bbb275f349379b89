#pragma once

#include <iosfwd>

#include "solvers/mechanics/modes.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// What `frahm check` prints of the records that drive a transient: samples, peaks, ends, the baseline of
// accelerations and velocities; warnings where it drifts, or where samples are coarse next to the modes. Of
// an axis of records one line each, the first twelve.
void print_records(const Study& study, const periodic::LinearModes& modes, std::ostream& out);

}  // namespace frahm::studies
