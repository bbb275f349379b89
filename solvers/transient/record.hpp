#pragma once

#include <cstddef>
#include <string>
#include <vector>

// Measured excitations: forces, and motions of supports, such as an earthquake's.
namespace frahm::transient {

enum class RecordOf { force, displacement, velocity, acceleration };

// Forces, velocities and accelerations are linear from one sample to the next, and motions follow from them
// exactly, displacement and velocity being 0 at the start; displacements are the cubic spline through the
// samples. Behind its end a force and an acceleration are 0, a velocity ends and a displacement stays.
struct Record {
  std::string name;  // of its file, or of what made it
  RecordOf of = RecordOf::force;
  std::vector<double> time;    // [s], ascending from 0; at least two
  std::vector<double> values;  // [N] ([N m] on a rotation), [m] ([rad]), [m/s] or [m/s^2]; one for each time
};

// Which component of the network's excitation a record drives; its amplitude multiplies it.
struct RecordedExcitation {
  std::size_t excitation = 0;      // in Network::excitations, of a recorded kind
  const Record* record = nullptr;  // must outlive the motion
};

}  // namespace frahm::transient
