#pragma once

#include "solvers/mechanics/network.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/system/network_reading.hpp"

// How large a system may be.
namespace frahm::studies {

// Refuses more contacts than are followed exactly: the exact law knows which stick by the bits of a word.
void check_number_of_contacts(const NetworkReading& reading, const TomlSection& section,
                              const mechanics::Element& element);

// Refuses a mass, or an element with a spring in series, that makes the system too large.
void check_number_of_states(const NetworkReading& reading, const TomlSection& section);

}  // namespace frahm::studies
