#pragma once

#include <vector>

#include "results/layout.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

inline constexpr int kCrankAngles = 361;  // of one turn: a degree apart, both ends

// /page/crank (results/FORMAT.md): the motion of a study's cranks over one turn, at the parameters of the
// study; empty without cranks.
std::vector<results::Column> crank_motions(const Study& study);

}  // namespace frahm::studies
