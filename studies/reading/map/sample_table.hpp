#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_context.hpp"

namespace frahm::studies {

// A column of a table of samples: an axis with its parameter, unit and values.
struct SampleColumn {
  ParameterAxis axis;
  std::optional<Unit> unit;  // of the heading
};

// A CSV file whose headings are parameters of the study, with their units: "k [kN/m],c [N s/m]"; a row each
// sample, two at least.  name: of the file, for messages.
// Throws StudyError, without a place in the study: for headings that are no parameters or have an axis, units
// of another dimension, cells that are no finite numbers.
std::vector<SampleColumn> read_sample_table(const StudyContext& context, Study& study,
                                            const std::filesystem::path& path, const std::string& name);

}  // namespace frahm::studies
