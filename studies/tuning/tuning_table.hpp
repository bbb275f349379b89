#pragma once

#include <iosfwd>

#include "studies/reading/study/study.hpp"
#include "studies/tuning/tuning_result.hpp"

namespace frahm::studies {

// Prints a tuning: task, design, objective and certificate, trade-off, peaks, limits, detuning, effort.
void print_tuning(const Study& study, const TuningResult& result, std::ostream& out);

// Prints the task of a study: the objective, its band and scenarios, and the limits.
void print_task(const Study& study, std::ostream& out);

}  // namespace frahm::studies
