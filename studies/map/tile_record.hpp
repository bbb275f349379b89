#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/bytes.hpp"

// The record of a finished tile, little-endian: for one quantity after the other its values (float64) at the
// points of the tile, row-major in the map's order of dimensions; then for each failed point its place among
// them (u64), the length of the reason (u64) and the reason.
namespace frahm::studies {

struct FailedPoint {
  std::uint64_t place = 0;  // among the points of the tile, row-major
  std::string reason;
};

struct TileRecord {
  std::vector<double> values;
  std::vector<FailedPoint> failed;
};

// Appends the record to `out`.
void encode(const TileRecord& record, engine::Bytes& out);

// values: their number, points of the tile x quantities. Throws std::runtime_error for bytes that are no such
// record.
void decode(std::span<const std::byte> bytes, std::size_t values, TileRecord& record);

// How many points of the tile failed, without decoding the values.
std::uint64_t count_failed(std::span<const std::byte> bytes, std::size_t values);

}  // namespace frahm::studies
