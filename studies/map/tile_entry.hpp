#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/bytes.hpp"
#include "studies/map/regime_crossings.hpp"

// The entry of a finished tile, little-endian: for one quantity after the other its values (float64) at the
// points of the tile, row-major in the map's order of dimensions; then for each failed point its offset among
// them (u64), the length of the reason (u64) and the reason. A study with borders adds no_point (u64) and for
// each border the offset of the edge's lower point (u64), t (float64), the dimension, the element and the
// regimes below and above (u16 each).
namespace frahm::studies {

inline constexpr std::uint64_t no_point = std::numeric_limits<std::uint64_t>::max();

struct FailedPoint {
  std::uint64_t offset = 0;  // offset among the points of the tile, row-major
  std::string reason;
};

// A change of regime between a point of the tile and its neighbour along a dimension.
struct Border {
  std::uint64_t offset = 0;      // offset of the point in the tile, row-major
  std::size_t dimension = 0;     // of the map, slowest first
  std::size_t element = 0;       // among the network's Coulomb elements
  RegimeCrossing crossing = {};  // t from 0 at the point to 1 at its neighbour
};

struct TileEntry {
  std::vector<double> values;
  std::vector<FailedPoint> failed;
  std::optional<std::vector<Border>> borders = std::nullopt;  // of a study with borders
};

// Appends the entry to `out`.
void encode(const TileEntry& entry, engine::Bytes& out);

// values: their number, points of the tile x quantities. Throws engine::BadEntry for bytes that are not a
// entry.
void decode(std::span<const std::byte> bytes, std::size_t values, TileEntry& entry);

// How many points of the tile failed, without decoding the values.
std::uint64_t count_failed(std::span<const std::byte> bytes, std::size_t values);

}  // namespace frahm::studies
