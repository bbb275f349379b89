#pragma once

#include <cstddef>
#include <span>

#include "results/storage.hpp"

namespace frahm::results {

// `data`, planes of equal size one after the other, in zlib's format, with `spare` bytes left free at the end.
// Each plane has blocks of its own: what compresses is found quickly, what does not is stored, and no plane
// is coded by the frequencies of another. planes: divides the size. Re-entrant; equal data give equal bytes.
//
// Uses ISA-L as a stream from cleared memory. Asked for whole chunks without a stream it had chosen another
// match of the same length in a few of some thousand runs; so asked, in none of three million chunks under
// load, from six threads, at random alignments and beside random memory.
Bytes deflated(std::span<const std::byte> data, std::size_t planes, std::size_t spare = 0);

// Byte 0 of every element, then byte 1 of every element, ...: the slowly changing sign and exponent bytes of
// neighbours come together and compress.  element_size: 1, 4 or 8.
Bytes shuffled(std::span<const std::byte> elements, std::size_t element_size);

}  // namespace frahm::results
