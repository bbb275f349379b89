#pragma once

#include <filesystem>
#include <vector>

#include "studies/reading/study/study.hpp"
#include "studies/tuning/tuned_design.hpp"

namespace frahm::studies {

// A tuning read from its result file.
struct StoredTuning {
  Study study;                        // with the overrides of its run
  std::vector<Assignment> overrides;  // of its run
  DesignValues design;                // of the optimum
  std::vector<double> band;           // where the responses are sampled, in the unit of the band
};

// Tables of the study are searched next to the result. Throws StudyError for a file without an optimum,
// results::StoreError.
StoredTuning read_stored_tuning(const std::filesystem::path& file);

}  // namespace frahm::studies
