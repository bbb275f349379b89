#pragma once

#include "solvers/identification/grey_box.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// The fit that a study of the method grey_box describes. study: must outlive it.
identification::GreyBoxTask grey_box_task(const Study& study);

// The measurements of a record.
identification::TimeRecord time_record(const Study& study, const RecordChoice& record);

}  // namespace frahm::studies
