#pragma once

#include <filesystem>
#include <vector>

#include "results/map_reader.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// The study that a result was made from.
struct StoredStudy {
  Study study;                        // with the overrides of its run
  std::vector<Assignment> overrides;  // of its run
};

// Reads the text in the result. The study's tables are searched next to the result; measurements are not
// read. file: of `result`.  Throws StudyError, also where a table or matrix has other numbers than in the
// run; results::StoreError.
StoredStudy read_stored_study(const results::MapReader& result, const std::filesystem::path& file);

}  // namespace frahm::studies
