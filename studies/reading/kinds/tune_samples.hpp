#pragma once

#include <filesystem>

#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/kinds/tune_reading.hpp"
#include "studies/reading/study/study.hpp"

// Samples of a tuning.
namespace frahm::studies {

// The samples of an [[axis]], each a scenario; after the designs and the scenarios.
void read_samples(TuneReading& reading, const std::filesystem::path& folder, DataFiles data);
// Refuses samples.
void refuse_samples(const TuneReading& reading);

}  // namespace frahm::studies
