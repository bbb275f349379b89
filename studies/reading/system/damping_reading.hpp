#pragma once

#include "studies/reading/system/network_reading.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {

// [damping], if there is one, once all masses are there.
void read_damping(NetworkReading& reading, const TomlValue& root);

}  // namespace frahm::studies
