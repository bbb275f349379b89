#pragma once

#include <concepts>
#include <cstddef>
#include <vector>

namespace frahm::engine {

using Bytes = std::vector<std::byte>;

// Writes `value` to sizeof(T) bytes at `to`, least significant byte first on every machine.
template <std::unsigned_integral T>
void put_little_endian(std::byte* to, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) to[i] = static_cast<std::byte>(value >> (8 * i));
}

// Reads what put_little_endian wrote.
template <std::unsigned_integral T>
T get_little_endian(const std::byte* from) {
  T value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) value |= static_cast<T>(from[i]) << (8 * i);
  return value;
}

}  // namespace frahm::engine
