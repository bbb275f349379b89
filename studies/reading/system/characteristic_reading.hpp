#pragma once

#include "solvers/mechanics/network.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/study/characteristic.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/system/network_reading.hpp"

namespace frahm::studies {

// Gives each bend of a table its side of the origin, once units are converted.
void set_characteristics(Study& study);

// The stops, table or curve of friction of an element, if its kind has such and, of a table, the key is
// there; the bends go to the element.
StudyCharacteristic read_characteristic(NetworkReading& reading, const TomlSection& section, bool rotational,
                                        mechanics::Element& element);

}  // namespace frahm::studies
