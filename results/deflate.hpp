#pragma once

#include <cstddef>
#include <span>

#include "results/storage.hpp"

namespace frahm::results {

// `data` in zlib's format, with `spare` bytes left free at the end.  level: 1 (fast) to 12 (small).
// Re-entrant; equal data give equal bytes.
//
// Uses libdeflate: its bytes depend on the input alone, and it is several times faster than zlib in HDF5.
// ISA-L is faster still, but its bytes may differ between runs (2.30: of some thousand runs under load a few
// chose another match of the same length).
Bytes deflated(std::span<const std::byte> data, int level, std::size_t spare = 0);

// Byte 0 of every element, then byte 1 of every element, ...: the slowly changing sign and exponent bytes of
// neighbours come together and compress.  element_size: 1, 4 or 8.
Bytes shuffled(std::span<const std::byte> elements, std::size_t element_size);

}  // namespace frahm::results
