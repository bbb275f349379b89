#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/text/study_source.hpp"
#include "studies/reading/text/toml_reading.hpp"

// An [[axis]] of samples.
namespace frahm::studies {

// An [[axis]] of samples while it is read; its axes stand in the study.
struct SampleReading {
  const StudyContext& context;
  const TomlSection& section;
  Study& study;
  std::string zip;
  Position zip_position;
  SampleChoice choice;
};

// A new axis of a parameter, without values. Valid until the next one.
ParameterAxis& add_axis(SampleReading& reading, std::size_t parameter);

// What is told of an axis, with its unit.
std::string with_unit_of(const ParameterAxis& axis, const std::string& text);

// Whether an [[axis]] is one of samples: `samples = 1000`, or `from` a file.
bool is_axis_of_samples(const TomlValue& table);
// number: of the [[axis]], from 1.  folder: of its file.  data: as of read_axes().
void read_axis_of_samples(const StudyContext& context, const TomlValue& table, std::size_t number,
                          const std::filesystem::path& folder, DataFiles data, Study& study);

}  // namespace frahm::studies
