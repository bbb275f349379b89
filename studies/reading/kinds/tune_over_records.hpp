#pragma once

#include <filesystem>

#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {

// [tune] of a network under records, with its tables, into the study's choice, once units are converted.
// folder: of the records' files.
void read_tuning_over_records(const StudyContext& context, const TomlValue& root,
                              const std::filesystem::path& folder, DataFiles data,
                              std::vector<DrivingRecord> corners, Study& study);

}  // namespace frahm::studies
