#pragma once

#include <optional>
#include <string>

#include "solvers/transient/record.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/system/network_reading.hpp"

// Forces and motions of supports by corners, [[t, value], ...]: in a transient a course in time, as a record
// is; in other studies one period, by its Fourier series.
namespace frahm::studies {

// The key that holds a list of corners, and of what they are; nothing where none does. section: an
// [[excitation.force]] or [[excitation.motion]].
struct CornerKey {
  std::string key;
  transient::RecordOf of = transient::RecordOf::force;
};
std::optional<CornerKey> corner_key(const TomlSection& section);

// Adds the components that the corners of that key are; node: a mass for a force, otherwise a support.
// Throws StudyError for what is no list of corners, for times that do not rise from 0, for a displacement
// that jumps or does not close its period, for a velocity or an acceleration whose mean over the period is
// not zero, and for keys that have no use.
void read_corners(NetworkReading& reading, const TomlSection& section, const CornerKey& key,
                  const mechanics::Node& node);

// Refuses a velocity of a support that jumps where an inerter hangs, once the elements are known.
void check_jumps(const NetworkReading& reading);

}  // namespace frahm::studies
