#pragma once

#include <vector>

#include "solvers/identification/identification.hpp"

// The damping of an element from its measured loop of force over displacement, in steady vibration.
namespace frahm::identification {

struct LoopTraces {
  std::vector<double> time;          // [s], increasing; at least a period
  std::vector<double> displacement;  // relative displacement of its ends [m]
  std::vector<double> force;         // force on them, positive against the displacement [N]
};

// Both traces are Fourier series of one omega by least squares over the record, with as many harmonics as
// Akaike's corrected criterion prefers; the loss is that of the series, W = pi sum_n n (force x
// displacement)_n, so that noise, independent in both, does not add to the loop's area. omega is fitted.
// Estimates: energy_loss W = oint F dx [J], amplitude X [m] (half the stroke), frequency omega [rad s-1],
// storage_stiffness k [N m-1] (force in phase with the displacement, of the first harmonic), loss_factor = W
// / (2 pi U) with U = k X^2 / 2, equivalent_damping = W / oint v dx (W / (pi omega X^2) of a harmonic motion)
// [N s m-1], equivalent_friction = W / (4 X) [N]. A force that jumps is seen only between samples: its loss
// is known to that part of the stroke.
// The loss factor is not determined where the storage stiffness may be zero, as of a damper alone. A note
// says where the loss is negative. failure: a record of less than two periods.
Identification hysteresis_loop(const LoopTraces& traces);

}  // namespace frahm::identification
