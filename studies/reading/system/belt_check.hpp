#pragma once

#include "studies/reading/system/network_reading.hpp"

namespace frahm::studies {

// Refuses elements and signals that ask for the displacement of a node that moves on for ever, except in a
// transient, which ends.
void check_belts(const NetworkReading& reading, StudyKind kind);

}  // namespace frahm::studies
