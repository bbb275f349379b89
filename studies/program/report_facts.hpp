#pragma once

#include <vector>

#include "results/report/page_data.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// Facts of a study for its report: group "crank", the motion of its cranks; group "study", for one motion
// whether it can end and its period, for a tuning the part of the band over which each limit holds; group
// "profile", the masses in their order over the height (report_profile.hpp).
std::vector<results::PageGroup> report_facts(const Study& study);

}  // namespace frahm::studies
