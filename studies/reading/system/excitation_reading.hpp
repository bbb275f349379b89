#pragma once

#include "studies/reading/system/network_reading.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {

// [[excitation.motion]] names the nodes of prescribed motion, so it comes before the elements. [excitation]
// with its forces and the frequency comes after the masses. Constant forces alone are refused unless
// constant_will_do: they cause no periodic motion, but a suddenly applied load causes a transient. Without a
// harmonic no frequency is needed: it is 1 rad/s then.
void read_prescribed_nodes(NetworkReading& reading, const TomlValue& excitation);
void read_excitation(NetworkReading& reading, const TomlValue& excitation, bool constant_will_do);

}  // namespace frahm::studies
