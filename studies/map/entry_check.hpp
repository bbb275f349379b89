#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "studies/map/map_plan.hpp"

namespace frahm::studies {

// Checks the entry of a tile of a map that comes from a log: its length, values that their variables can
// have, points, borders and reasons. Throws engine::BadEntry.
void check_entry(const MapPlan& plan, std::uint64_t tile, std::span<const std::byte> bytes);

// Whether a run could have recorded the value. If not, a person or another program wrote it.
bool is_possible(double value, const periodic::QuantityDescription& variable);

}  // namespace frahm::studies
