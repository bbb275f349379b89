#pragma once

#include "studies/reading/system/network_reading.hpp"

namespace frahm::studies {

// Refuses elements and signals that ask for the displacement of a node that moves on for ever.
void check_belts(const NetworkReading& reading);

}  // namespace frahm::studies
