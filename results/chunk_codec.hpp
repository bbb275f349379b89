#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "results/storage.hpp"

namespace frahm::results {

// One chunk of an array as HDF5 stores it under the filters shuffle, deflate and fletcher32: what
// H5Dwrite_chunk takes and every HDF5 library reads back. chunk: the elements of a whole chunk, each of
// `element_size` bytes, fewer than 2^32 bytes in all. Re-entrant, and the same bytes for the same chunk.
//
// Deflate is libdeflate's at level 1: its bytes depend on its input alone, which those of the faster ISA-L do
// not quite (2.30: of some thousand runs under load a few chose another match of the same length), and it is
// several times faster than zlib through HDF5.
Bytes encode_chunk(std::span<const std::byte> chunk, std::size_t element_size);

// HDF5's variant of Fletcher's checksum: 16-bit words taken big-endian, the last one padded with zero.
std::uint32_t fletcher32(std::span<const std::byte> data);

}  // namespace frahm::results
