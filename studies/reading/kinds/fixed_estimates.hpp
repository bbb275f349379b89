#pragma once

#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/kinds/identify_reading.hpp"

namespace frahm::studies {

// `fixed_from`: estimates of earlier identifications replace the parameters of the same names.
void read_fixed(IdentifyReading& reading, const TomlSection& identify);

}  // namespace frahm::studies
