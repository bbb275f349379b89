#pragma once

#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/kinds/identify_reading.hpp"

namespace frahm::studies {

// A [[identify.record]] with its data; its added mass or static displacement is already read.
void read_record(IdentifyReading& reading, const TomlSection& section, RecordChoice& record);

}  // namespace frahm::studies
