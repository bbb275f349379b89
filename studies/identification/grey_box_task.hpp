#pragma once

#include "solvers/identification/grey_box.hpp"
#include "studies/reading/study_file.hpp"

namespace frahm::studies {

// The fit that a study of the method grey_box describes. study: must outlive it.
identification::GreyBoxTask grey_box_task(const StudyFile& study);

// The measurements of a record.
identification::TimeRecord time_record(const StudyFile& study, const RecordChoice& record);

}  // namespace frahm::studies
