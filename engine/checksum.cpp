#include "engine/checksum.hpp"

#include <isa-l/crc.h>
#include <isa-l/crc64.h>

#include <algorithm>

namespace frahm::engine {

std::uint32_t crc32c(std::span<const std::byte> bytes) {
  constexpr std::size_t longest = std::size_t{1} << 30;  // ISA-L takes the length as an int
  std::uint32_t crc = 0xFFFFFFFFU;
  while (!bytes.empty()) {
    const auto part = bytes.first(std::min(bytes.size(), longest));
    // ISA-L reads the buffer only, though its signature does not say so.
    auto* data = const_cast<unsigned char*>(reinterpret_cast<const unsigned char*>(part.data()));
    crc = crc32_iscsi(data, static_cast<int>(part.size()), crc);
    bytes = bytes.subspan(part.size());
  }
  return ~crc;
}

std::uint64_t crc64(std::span<const std::byte> bytes) {
  return crc64_ecma_refl(0, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
}

}  // namespace frahm::engine
