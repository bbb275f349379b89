#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "studies/reading/study/study.hpp"

// Parameter values from the command line.
namespace frahm::studies {

// The study with the values of --set (name=value each; none: unchanged). Throws StudyError.
Study read_study_with(const std::filesystem::path& path, const std::vector<std::string>& set);
// The same for a study that was read. option: what messages call the place of the values.
Study with_settings(Study study, const std::vector<std::string>& set, std::string_view option = "--set");

// SI values of all parameters at one point: those of --at (name=value each), the rest as the study states
// them. option: what messages call their place. Throws StudyError for a wrong name or value, or if a network
// value is out of range there.
std::vector<double> parameters_at(const Study& study, const std::vector<std::string>& at,
                                  std::string_view option = "--at");

}  // namespace frahm::studies
