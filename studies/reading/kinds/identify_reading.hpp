#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "studies/reading/study/study_reading.hpp"

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

// [[identify.parameter]]: of a grey box before the records, of a formula after them.
void read_identified_parameters(IdentifyReading& reading, const TomlSection& section);

// A [[identify.record]] with its data; its added mass or static displacement is already read.
void read_record(IdentifyReading& reading, const TomlSection& section, RecordChoice& record);

// `fixed_from`: estimates of earlier identifications replace the parameters of the same names.
void read_fixed(IdentifyReading& reading, const TomlSection& identify);

}  // namespace frahm::studies
