#pragma once

#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/kinds/identify_reading.hpp"

namespace frahm::studies {

// [[identify.parameter]]: of a grey box before the records, of a formula after them.
void read_identified_parameters(IdentifyReading& reading, const TomlSection& section);

}  // namespace frahm::studies
