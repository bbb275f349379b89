#pragma once

#include <iosfwd>

#include "studies/reading/study.hpp"
#include "studies/tuning/tuning_result.hpp"

namespace frahm::studies {

// A tuning for readers: what was tuned, the optimum and what holds it, its peaks, limits and how sure it is.
void print_tuning(const Study& study, const TuningResult& result, std::ostream& out);

// What is to be tuned: the objective, its band and scenarios, and the limits, as a study states them.
void print_task(const Study& study, std::ostream& out);

}  // namespace frahm::studies
