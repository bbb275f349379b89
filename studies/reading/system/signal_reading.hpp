#pragma once

#include <string>

#include "studies/reading/system/network_reading.hpp"

namespace frahm::studies {

// [[output.signal]]: the names and directions of the network's signals, after its nodes and elements. Throws
// StudyError.
void read_signals(NetworkReading& reading, const TomlValue& root);

// [output] of a study that is no sweep has signals and nothing else. why: the reason, to end the message.
void check_output_has_signals_alone(const Study& study, const TomlEntry& output, const std::string& why);

// Gives the network's signals their factors, with the parameters as the study states them.
void set_signals(Study& study);

}  // namespace frahm::studies
