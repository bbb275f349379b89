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

struct LeapDecided {
  Task task;              // with the leap in its place
  std::vector<double> x;  // the design that decided it; empty where none was found
};

// The place of a leap: first that of the best path over a grid that may leap; from there it moves downhill,
// the schedules tuned at each place, to where the worst peak is least. Where neither side holds the worst
// peak the place stays. value: of each parameter.
LeapDecided decide_leap(const Task& task, const std::vector<QuantityLimit>& limits,
                        const std::vector<double>& value, Effort& effort,
                        const std::function<bool()>& stop_asked);

}  // namespace frahm::tuning
