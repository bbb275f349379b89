#pragma once

#include "solvers/tuning/records/record_task.hpp"
#include "solvers/tuning/task.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// The solver's task for a study of kind "tune". Its functions may be called from several threads at once.
// study: must outlive the task.
tuning::Task tuning_task(const Study& study);
// The same for a tuning over records.
tuning::RecordTask record_task(const Study& study);

}  // namespace frahm::studies
