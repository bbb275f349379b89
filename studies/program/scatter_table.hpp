#pragma once

#include <filesystem>
#include <iosfwd>

#include "studies/map/map_plan.hpp"

namespace frahm::studies {

// What the samples of a study's axis are: how they are drawn, and of each parameter its distribution with the
// mean and the deviation of its samples; nothing for a study without samples.
void print_samples(const Study& study, std::ostream& out);

// The scatter of the headline over the samples, where its highest quantile is largest: mean, deviation and
// quantiles with their 95 % intervals, and the shares of the uncertain parameters to first order. Nothing for
// a map without samples, or whose headline is not recorded.  file: the result.
void print_scatter(const MapPlan& plan, const std::filesystem::path& file, std::ostream& out);

}  // namespace frahm::studies
