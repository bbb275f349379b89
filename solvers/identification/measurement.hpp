#pragma once

#include <string>
#include <vector>

#include "solvers/mechanics/network.hpp"
#include "solvers/transient/record.hpp"

// Measured time traces. Numbers are SI.
namespace frahm::identification {

enum class Signal { displacement, velocity, acceleration };

// Readings of a sensor on a mass, relative to the position where no spring is strained.
struct Channel {
  std::string name;      // "main_displacement"
  std::size_t mass = 0;  // index in Network::masses
  Signal signal = Signal::displacement;
  std::vector<double> values;  // [m], [m/s] or [m/s^2]; one for each time
};

// A measured force on a mass [N], or a measured displacement of a prescribed node [m].
struct MeasuredExcitation {
  mechanics::ExcitationKind kind = mechanics::ExcitationKind::force;  // force or motion
  std::size_t node = 0;        // in Network::masses or Network::prescribed
  std::vector<double> values;  // one for each time
};

enum class MotionKind {
  free,      // from initial values, without excitation
  forced,    // from initial values, under the network's excitation or a measured one
  periodic,  // the steady response to the network's excitation
};

struct TimeRecord {
  std::string name;
  MotionKind motion = MotionKind::free;
  std::vector<double> time;  // [s], increasing, at least two; the motion begins at the first
  std::vector<Channel> channels;
  std::vector<MeasuredExcitation> excitation;  // of a forced record, in place of the network's own
  transient::Interpolation interpolation = transient::Interpolation::spline;  // of measured supports
};

}  // namespace frahm::identification
