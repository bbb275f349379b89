#pragma once

#include <functional>
#include <vector>

#include "solvers/tuning/schedules/design_space.hpp"

namespace frahm::tuning {

// Parameter values (one per design parameter) that a start begins from: start 0 is the nominal design moved
// into its bounds, start i > 0 the i-th point of a sequence that fills the box evenly (starts.hpp).
std::vector<double> start_design(const DesignSpace& space, std::size_t start);

// The best parameter values found by a global search of the bounds, with constant schedules. worst_of(value):
// the true objective, raised by broken limits; NaN: no value.
std::vector<double> global_design(const Task& task, const DesignSpace& space,
                                  const std::function<double(std::span<const double>)>& worst_of,
                                  const std::function<bool()>& stop_asked);

}  // namespace frahm::tuning
