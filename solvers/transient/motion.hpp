#pragma once

#include <functional>
#include <string>
#include <vector>

#include "solvers/mechanics/network.hpp"

// The record of a motion from given initial values.
namespace frahm::transient {

// At t = 0, of each mass: displacement [m] and velocity [m/s]. Empty: at rest where no spring is strained.
// Each is zero or of a size from kSmallestInitial to kLargestInitial: far beyond anything that is built, and
// the squares of a motion's energy norm stay within what a double holds, down to kGone (free_decay.hpp).
inline constexpr double kSmallestInitial = 1e-50, kLargestInitial = 1e50;

struct InitialState {
  std::vector<double> displacement, velocity;
};

// A zero of a mass's velocity, solved. A plateau counts once, at its arrival; a mass that starts with no
// velocity has its first at t = 0.
struct Extremum {
  double time = 0.0;          // [s]
  double displacement = 0.0;  // [m]
};

// An interval in which a contact is at rest. If it sticks at t = 0 the onset is 0.
struct Stop {
  double onset = 0.0;    // [s]
  double release = 0.0;  // [s]; NaN: not released by the end
};

// An interval in which an element is beyond a place of its displacement: a stop is touched. If it begins so
// the touch is 0.
struct Touch {
  double onset = 0.0;  // [s]
  double end = 0.0;    // [s]; NaN: not over by the end
};

// States at given times, ascending.
struct Samples {
  std::vector<double> time;  // [s]
  // For each mass, then of each signal, a value for each time: [m], [m/s], [m/s^2]; where the acceleration
  // jumps, what it jumps to.
  std::vector<std::vector<double>> displacement, velocity, acceleration;
  // By each element since t = 0 [J]; of those that never dissipate, no values. Last, where there is one, by
  // the damping of the structure.
  std::vector<std::vector<double>> dissipated;
};

// Where the energy of a motion comes from and goes to:  initial + input = final + sum of dissipated.
struct EnergyBudget {
  // Kinetic and potential energy [J] at t = 0 and at the end, of Maxwell elements that of their springs.
  double initial = 0.0, final = 0.0;
  // [J] Work of the excitation. Of a run-up also what changes of elements put in, and the jumps of its
  // supports' velocities from stair to stair.
  double input = 0.0;
  // The error of the energy balance, relative to its largest term (for the input, the integral of the size of
  // its power); 0 where nothing moves.
  double balance = 0.0;
  // By each element [J], 0 of those that dissipate nothing; last, where there is one, by the damping of the
  // structure.
  std::vector<double> dissipated = {};
  std::vector<double> share = {};  // of each of them in all that is dissipated; 0 where nothing is
};

// Why a motion is not told: its energies balance to worse than 1e-7, so that an event was missed. Empty: they
// do.
std::string why_unbalanced(const EnergyBudget& energy);

// The values of the network at a frequency [rad/s]. In a run-up the amplitudes of forces may follow it, and
// so may the elements; the amplitudes of prescribed motion must not.
using ValuesAt = std::function<mechanics::NetworkValues(double omega)>;

// Called every few hundred steps while a motion is followed; what it throws ends the motion and is passed on.
// Empty: nothing is called.
using Watch = std::function<void()>;

// count times from 0 to duration [s], equally spaced; none for a count of 0.
std::vector<double> sample_times(double duration, int count);

}  // namespace frahm::transient
