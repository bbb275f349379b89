#pragma once

#include <string_view>
#include <vector>

#include "studies/reading/study.hpp"

namespace frahm::studies {

// Reads what the command line says of parameters: `r=0.9,f=0.1`, `omega=250 rpm`. A bare number is in the
// unit in which the study speaks of the parameter (usual_unit). option: the name of the option, for messages:
// `--at`. Throws StudyError.
std::vector<Assignment> parse_assignments(const Study& study, std::string_view option, std::string_view text);

}  // namespace frahm::studies
