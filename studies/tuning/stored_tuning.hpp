#pragma once

#include <filesystem>
#include <vector>

#include "studies/reading/study.hpp"
#include "studies/tuning/tuned_design.hpp"

namespace frahm::studies {

// A tuning as its result file keeps it.
struct StoredTuning {
  Study study;                        // with the overrides of its run
  std::vector<Assignment> overrides;  // these
  DesignValues design;                // of the optimum
  std::vector<double> band;           // where the responses are sampled, in the unit of the band
};

// Tables that the study reads are looked for beside the result. Throws StudyError for a file without an
// optimum, results::StoreError.
StoredTuning read_stored_tuning(const std::filesystem::path& file);

}  // namespace frahm::studies
