#pragma once

#include <vector>

#include "solvers/identification/identification.hpp"

// Viscous damping and Coulomb friction from the energy that keeps a vibration going, at several amplitudes.
namespace frahm::identification {

struct EnergyRows {
  std::vector<double> amplitude;     // X [m], > 0
  std::vector<double> energy;        // input per cycle [J]
  std::vector<double> omega;         // [rad/s], > 0: one for each row, or one for all
  std::vector<double> velocity_rms;  // [m/s]; empty: the motion is taken as harmonic
};

// E = pi c omega X^2 + 4 F X; with the rms velocity E = (2 pi / omega) c v_rms^2 + 4 F X, exact for any
// waveform that turns twice a cycle. Linear least squares.
// Estimates: damping [N s m-1], friction_force [N].
// failure: fewer than two rows, not positive, a negative energy; rows that are all of one amplitude, or of
// one omega X (with the rms velocity v^2 / (omega X)), for which both losses grow alike.
Identification energy_balance(const EnergyRows& rows);

}  // namespace frahm::identification
