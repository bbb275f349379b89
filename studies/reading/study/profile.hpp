#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "solvers/mechanics/network.hpp"
#include "studies/reading/text/study_source.hpp"

namespace frahm::studies {

// Masses in their order along a line, such as the floors of a building: a report draws peaks and mode shapes
// over them.
struct Profile {
  std::vector<std::size_t> masses;                  // indices in Network::masses, the lowest first
  std::vector<double> height = {};                  // of each above the base, rising [m]; empty: not known
  std::optional<Position> position = std::nullopt;  // of the study's own choice
};

}  // namespace frahm::studies
