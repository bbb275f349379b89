#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "results/storage.hpp"

namespace frahm::results {

// One chunk of an array as HDF5 stores it under the filters shuffle, deflate and fletcher32: what
// H5Dwrite_chunk takes and every HDF5 library reads back. chunk: the elements of a whole chunk, each of
// `element_size` bytes, fewer than 2^32 bytes in all. Re-entrant; equal chunks give equal bytes.
Bytes encode_chunk(std::span<const std::byte> chunk, std::size_t element_size);

// HDF5's variant of Fletcher's checksum: 16-bit words taken big-endian, the last one padded with zero.
std::uint32_t fletcher32(std::span<const std::byte> data);

}  // namespace frahm::results
