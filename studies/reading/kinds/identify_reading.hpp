#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/text/study_source.hpp"
#include "studies/reading/text/toml_reading.hpp"

// Shared by the readers of [identify] and its tables.
namespace frahm::studies {

// The identification while it is read.
struct IdentifyReading {
  const StudyContext& context;
  std::filesystem::path folder;  // of the files that the study names
  DataFiles data = DataFiles::read;
  Study& study;
  IdentifyChoice& choice;  // study.identify()
};

TomlSection identify_section(const StudySource& source, const TomlValue& root);

// The sections of the tables [[identify.record]] and [[identify.parameter]], in the order of the study.
std::vector<TomlSection> record_sections(const TomlSection& identify, const TomlValue& root);
std::vector<TomlSection> parameter_sections(const TomlSection& identify, const TomlValue& root);

// [identify] and its tables into the study's choice. Their expressions are read before units are converted,
// as those of the network; measurements and earlier estimates after. folder: of their files.
void read_identification(const StudyContext& context, const TomlValue& root, Study& study);
void read_measurements(const StudyContext& context, const TomlValue& root,
                       const std::filesystem::path& folder, DataFiles data, Study& study);

}  // namespace frahm::studies
