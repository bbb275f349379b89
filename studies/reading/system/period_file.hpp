#pragma once

#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/system/network_reading.hpp"

// profile = "file": one period of a force or of a support's motion, from a file.
namespace frahm::studies {

// Adds the components of its Fourier series: straight lines from row to row, of which the last closes the
// period of the frequency, however long the file says that it is. The mean of a velocity or an acceleration
// is left out, and said so.  section: an [[excitation.force]] or [[excitation.motion]]; node: a mass for a
// force, otherwise a support.
// Throws StudyError for what is wrong with the file, its columns and units, and for a displacement that does
// not close.
void read_period_file(NetworkReading& reading, const TomlSection& section, const mechanics::Node& node);

}  // namespace frahm::studies
