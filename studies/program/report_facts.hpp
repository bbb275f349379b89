#pragma once

#include <vector>

#include "results/report/page_data.hpp"
#include "studies/reading/study.hpp"

namespace frahm::studies {

// What a study tells its report besides the result: group "crank", the motion of its cranks; group "study",
// of one motion by what the page knows whether it can end and what a period is, of a tuning over which part
// of the band its limits hold.
std::vector<results::PageGroup> report_facts(const Study& study);

}  // namespace frahm::studies
