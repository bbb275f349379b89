#pragma once

#include "solvers/mechanics/element_table.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/system/network_reading.hpp"

namespace frahm::studies {

// The law of a coulomb element, or of a number that one law alone has; otherwise exact. Refuses keys of other
// laws.
mechanics::ForceLaw read_law(const TomlSection& section, const mechanics::ElementKind& kind);
// Refuses a contact beside others of which some are followed exactly and some are smooth.
void check_one_law(const NetworkReading& reading, const TomlSection& section,
                   const mechanics::ElementKind& kind, mechanics::ForceLaw law);

}  // namespace frahm::studies
