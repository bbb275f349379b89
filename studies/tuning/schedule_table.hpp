#pragma once

#include <optional>
#include <string>

#include "studies/tuning/stored_tuning.hpp"

namespace frahm::studies {

// The schedule as CSV for a controller: a row at each whole step of the band parameter and at both ends of
// the band; the excitation in rpm where the band is in another unit; each scheduled parameter; each
// [[column]] of the study and, if it has a range, whether it is within. step: in the unit of the band, > 0;
// absent: 1 rpm where the band parameter is the excitation's frequency, otherwise a round number that gives
// some 200 rows. Throws StudyError if nothing is scheduled, and for an invalid step.
std::string schedule_table(const StoredTuning& stored, std::optional<double> step);

}  // namespace frahm::studies
