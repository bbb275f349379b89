#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

// Measured excitations: forces, and motions of supports, such as an earthquake's.
namespace frahm::transient {

enum class RecordOf { force, displacement, velocity, acceleration };

enum class Interpolation { spline, linear };

// Forces, velocities and accelerations are linear from one sample to the next, and motions follow from them
// exactly: a velocity begins at displacement 0, an acceleration at velocity 0 too. A displacement is the
// cubic spline through its samples, whose slopes at both ends are those of the parabola through the first, or
// last, three; or it is linear too, and its velocity jumps at the samples. After the end a force and an
// acceleration are 0; a motion whose velocity or displacement is recorded must have come to rest there, or is
// not known.
//
// A list of corners is no measurement: straight lines too, but its last value holds after its end, and a
// force, a velocity or an acceleration may step, by two values at one time.
struct Record {
  std::string name;  // of its file, or of what made it
  RecordOf of = RecordOf::force;
  std::vector<double> time;    // [s], ascending; of corners two may be equal; at least two, of a spline three
  std::vector<double> values;  // [N] ([N m] on a rotation), [m] ([rad]), [m/s] or [m/s^2]; one for each time
  Interpolation interpolation = Interpolation::spline;  // of a displacement
  bool is_corners = false;

  bool is_spline() const { return of == RecordOf::displacement && interpolation == Interpolation::spline; }
  bool jumps() const {  // the velocity of its support does, at samples
    return of == RecordOf::displacement && interpolation == Interpolation::linear;
  }
  bool steps_at(std::size_t i) const { return i > 0 && time[i] == time[i - 1]; }
  bool steps() const { return std::ranges::adjacent_find(time) != time.end(); }
};

// The least number of samples of a record of this kind.
inline std::size_t least_samples(const Record& record) {
  return record.is_spline() ? 3 : 2;
}

// Which component of the network's excitation a record drives; the component's amplitude multiplies it.
struct RecordedExcitation {
  std::size_t excitation = 0;      // in Network::excitations, of a recorded kind
  const Record* record = nullptr;  // must outlive the motion
};

}  // namespace frahm::transient
