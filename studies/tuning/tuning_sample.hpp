#pragma once

#include <cstdint>
#include <string>

#include "studies/provenance/study_plan.hpp"

namespace frahm::studies {

// What one start of a tuning takes one thread, with the assessment of its optimum, which a tuning makes once.
struct TuningSample {
  double seconds = 0.0;                            // that the sample took
  bool is_whole = false;                           // the start ended within it
  std::string why_no_design;                       // of a whole one that found none with an objective
  std::uint64_t responses = 0;                     // computed in it
  double least_responses = 0, most_responses = 0;  // that a start usually takes, if it is not whole
  double least_seconds = 0.0, most_seconds = 0.0;  // of a start; equal if it is whole
  double assessment_seconds = 0.0;                 // 0 if it is not whole: within the range
};

// Computes the first start of a tuning, for `seconds` at most. A start that does not end within them is
// predicted from the responses computed so far and from how many a start usually takes, which is known to a
// factor of about five. Throws StudyError for an invalid task.
TuningSample sample_tuning(const StudyPlan& plan, double seconds);

}  // namespace frahm::studies
