#pragma once

#include <string_view>
#include <vector>

#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// Reads parameter values from the command line: `r=0.9,f=0.1`, `omega=250 rpm`. A bare number is in the
// parameter's usual_unit. option: its name for messages, such as `--at`. Throws StudyError.
std::vector<Assignment> parse_assignments(const Study& study, std::string_view option, std::string_view text);

}  // namespace frahm::studies
