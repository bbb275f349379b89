#pragma once

#include <string>
#include <vector>

// What a motion from given initial values leaves behind.
namespace frahm::transient {

// At t = 0, of each mass: displacement [m] and velocity [m/s]. Empty: at rest where no spring is strained.
struct InitialState {
  std::vector<double> displacement, velocity;
};

// A zero of a mass's velocity, solved. A plateau counts once, at its arrival; a mass that starts with no
// velocity has its first at t = 0.
struct Extremum {
  double time = 0.0;          // [s]
  double displacement = 0.0;  // [m]
};

// A contact at rest. Of one that sticks at t = 0 the onset is 0.
struct Stop {
  double onset = 0.0;    // [s]
  double release = 0.0;  // [s]; NaN: not released by the end
};

// States at given times, ascending.
struct Samples {
  std::vector<double> time;                                 // [s]
  std::vector<std::vector<double>> displacement, velocity;  // of each mass, a value for each time
};

// count times from 0 to duration [s], equally spaced; none for a count of 0.
std::vector<double> sample_times(double duration, int count);

}  // namespace frahm::transient
