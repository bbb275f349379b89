#pragma once

#include "results/layout.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// What the page of one motion, or of a tuning, says of its study: /page/study (results/FORMAT.md). For a
// motion whether it can end, its period and its signals; for a tuning the parts of the band over which limits
// hold, and the excitation for which the optimum holds. Empty for any other study.
results::GroupContent study_facts(const Study& study);

}  // namespace frahm::studies
