#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "solvers/mechanics/network.hpp"
#include "studies/reading/study_source.hpp"
#include "studies/reading/toml_section.hpp"

namespace frahm::studies {

// Masses in their order along a line, such as the floors of a building: a report draws peaks and mode shapes
// over them.
struct Profile {
  std::vector<std::size_t> masses;                  // indices in Network::masses, the lowest first
  std::vector<double> height = {};                  // of each above the base, rising [m]; empty: not known
  std::optional<Position> position = std::nullopt;  // of the study's own choice
};

// The profile of [report], otherwise that of a system of more than eight masses: all of them, as the study
// lists them. Nothing for other systems.  report: null if the study has no such table. Throws StudyError.
std::optional<Profile> read_profile(const TomlSection* report, const mechanics::Network& network);

}  // namespace frahm::studies
