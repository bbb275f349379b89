#pragma once

#include <span>
#include <vector>

#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// The points that a slow sweep of the frequency passes on its way along a row to a point of any frequency,
// that point last; the point alone where nothing is swept. Each is the values of all parameters, completed.
std::vector<std::vector<double>> way_of_slow_sweep(const Study& study, const periodic::OrbitsWanted& wanted,
                                                   std::span<const double> parameters);

}  // namespace frahm::studies
