#pragma once

#include <span>
#include <vector>

#include "solvers/transient/largest_values.hpp"
#include "solvers/transient/motion_quantity.hpp"
#include "solvers/transient/trajectory.hpp"

namespace frahm::transient {

// What is measured of a motion, and nothing else of it: the numbers of quantities.
class MotionMeasurement {
 public:
  // Both must outlive the measurement. of_run_up: the frequency runs.
  MotionMeasurement(const mechanics::Assembly& assembly, std::span<const MotionQuantity> quantities,
                    bool of_run_up);

  // Whether one of the quantities is an energy.
  static bool needs_energies(std::span<const MotionQuantity> quantities);

  // What the trajectory has to follow.
  LargestValues& largest() { return largest_; }

  // For a motion that is complete, one for each quantity. NaN: the discretisation error, which the trajectory
  // does not know; velocities and accelerations of signals with a support's part in a run-up, where the
  // supports' rates jump from stair to stair.
  // own_frequency: the natural one [rad/s] of a network of one mass.
  std::vector<double> numbers(const Trajectory& trajectory, const EnergyBudget& energy,
                              double own_frequency) const;

 private:
  double number(const MotionQuantity& quantity, std::size_t place, const Trajectory& trajectory,
                const EnergyBudget& energy, double own_frequency) const;

  const mechanics::Assembly& assembly_;
  std::span<const MotionQuantity> quantities_;
  LargestValues largest_;
  std::vector<std::size_t> traces_;  // of each quantity its number among the largest values; kNoTrace
};

}  // namespace frahm::transient
