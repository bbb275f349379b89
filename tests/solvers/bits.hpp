#pragma once

#include <bit>
#include <cstdint>

namespace frahm {

// A checksum of the bits of numbers (FNV-1a over words): the same numbers in the same order have the same.
template <class Numbers>
std::uint64_t checksum_of_bits(const Numbers& numbers) {
  std::uint64_t sum = 0xcbf29ce484222325;
  for (const double number : numbers) sum = (sum ^ std::bit_cast<std::uint64_t>(number)) * 0x100000001b3;
  return sum;
}

}  // namespace frahm
