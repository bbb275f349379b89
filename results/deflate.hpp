#pragma once

#include <cstddef>
#include <span>

#include "results/storage.hpp"

namespace frahm::results {

// `data` in zlib's format, with `spare` bytes left free at the end.  level: 1 (fast) to 12 (small).
// Re-entrant, and the same bytes for the same data.
//
// Deflate is libdeflate's: its bytes depend on its input alone, which those of the faster ISA-L do not quite
// (2.30: of some thousand runs under load a few chose another match of the same length), and it is several
// times faster than zlib through HDF5.
Bytes deflated(std::span<const std::byte> data, int level, std::size_t spare = 0);

// Byte 0 of every element, then byte 1 of every element, ...: the slowly changing sign and exponent bytes of
// neighbours come together and compress.  element_size: 1, 4 or 8.
Bytes shuffled(std::span<const std::byte> elements, std::size_t element_size);

}  // namespace frahm::results
