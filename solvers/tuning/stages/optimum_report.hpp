#pragma once

#include "solvers/tuning/optimum.hpp"
#include "solvers/tuning/stages/design_tuning.hpp"

namespace frahm::tuning {

// The report of a tuning: the design, its true maxima with the multipliers that hold them, its limits.
Optimum report_optimum(const Task& task, DesignTuning& tuning, const Stages& stages, Effort& effort);

}  // namespace frahm::tuning
