#pragma once

#include "studies/reading/system/network_reading.hpp"

// Joints: masses of zero without an inerter, where springs and dampers meet (solvers/mechanics/joints.hpp).
namespace frahm::studies {

// Refuses an element that cannot end at a joint, and a joint that no chain of springs holds.
void check_joints(const NetworkReading& reading);

}  // namespace frahm::studies
