#pragma once

#include <cstddef>

#include "studies/reading/system/network_reading.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {

// An [[element]], after the masses and the nodes of prescribed motion. number: from 1.
void read_element(NetworkReading& reading, const TomlValue& table, std::size_t number);

}  // namespace frahm::studies
