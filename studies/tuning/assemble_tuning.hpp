#pragma once

#include <optional>

#include "studies/map/assemble.hpp"
#include "studies/tuning/tuning_result.hpp"

namespace frahm::studies {

// Makes the result file of a tuning from the starts in the logs, whoever computed them, and then removes
// these logs; nothing if it was stopped, with the output unchanged. Throws as assemble() does, and StudyError
// for an invalid task.
std::optional<TuningResult> assemble_tuning(const StudyPlan& plan, const RunFacts& run,
                                            const AssemblyOptions& options, const engine::OutputLock& held);

}  // namespace frahm::studies
