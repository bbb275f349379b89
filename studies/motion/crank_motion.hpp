#pragma once

#include <vector>

#include "results/layout.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

inline constexpr int kCrankAngles = 361;  // of one turn: a degree apart, both ends

// The motion of a study's cranks over one turn, at the parameters of the study; empty without cranks. Along
// the dimension "angle":
//   angle                                  of the crank, 0 to 2 pi [rad]
//   <node>_motion                          displacement a(angle) of its slider [m]
//   <node>_taylor_1, _2, _4                of the Taylor series in crank over rod, cut at that order [m]
//   <node>_taylor_1_error, _2_error, ...   how far that is from a, relative to l_AC = a + rod [1]
// with <node> the node driven; a second crank on it has the name <node>_2, and so on.
std::vector<results::Column> crank_motions(const Study& study);

}  // namespace frahm::studies
