#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace frahm::engine {

// CRC-32C (Castagnoli, as in iSCSI); of "123456789": 0xE3069283.
std::uint32_t crc32c(std::span<const std::byte> bytes);

// CRC-64/XZ (ECMA-182, reflected); of "123456789": 0x995DC9BBDF1939FA.
std::uint64_t crc64(std::span<const std::byte> bytes);

}  // namespace frahm::engine
