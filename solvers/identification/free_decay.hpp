#pragma once

#include <span>

#include "solvers/identification/decay_extrema.hpp"
#include "solvers/identification/identification.hpp"
#include "solvers/identification/one_mass.hpp"

// Viscous damping and Coulomb friction together from the extremes of a free vibration, source [22]:
//   |x_{i+1}| = beta |x_i| - x_f (1 + beta),   beta = exp(-pi zeta / sqrt(1 - zeta^2)),   x_f = F/k.
namespace frahm::identification {

struct FreeDecayOptions {
  OneMass known;               // at most one of mass and stiffness; otherwise nothing in N is estimated
  bool sensor_offset = false;  // the sensor's zero is not where the spring is at rest: fit it
};

// Estimates: damping_ratio, friction_displacement [m], natural_frequency, damped_frequency [rad/s], offset
// [m] if fitted; with a mass or a stiffness damping [N s m-1], friction_force [N] and the other of the two
// (stiffness [N m-1] or mass [kg]). damping_ratio_first, friction_displacement_first: of the linear
// regression of each extreme on the one before, from which the least squares of the whole sequence start.
// Ratios and forces within noise of zero may be negative: their intervals are then still correct.
// failure: fewer than three extremes (four with an offset), an oscillation that grows.
Identification free_decay(const DecayExtrema& extrema, const FreeDecayOptions& options);
// The same from a trace [s], [m].
Identification free_decay(std::span<const double> time, std::span<const double> displacement,
                          const FreeDecayOptions& options);

}  // namespace frahm::identification
