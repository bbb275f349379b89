#pragma once

#include <functional>
#include <vector>

#include "solvers/tuning/exchange/exchange.hpp"
#include "solvers/tuning/optimum.hpp"

// Where a schedule leaps.
namespace frahm::tuning {

// Whether a schedule of the task may leap.
bool may_leap(const Task& task);

// The task with a leap of its schedule at a place of the band [SI]: both sides of it are knots.
Task with_leap_at(const Task& task, double place);

// The task with the knots of an optimum, which has those of a leap.
Task with_knots_of(const Task& task, const Optimum& optimum);

// The task with the place of its leap tuned: first the best path over a grid that may leap; then the place is
// moved to where the responses on both sides are equally high, the schedules are tuned again, and so on while
// the worst peak falls. Where neither side holds the worst peak the place stays. value: of each parameter.
Task with_leap_decided(const Task& task, const std::vector<QuantityLimit>& limits,
                       const std::vector<double>& value, Effort& effort,
                       const std::function<bool()>& stop_asked);

}  // namespace frahm::tuning
