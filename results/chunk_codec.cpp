#include "results/chunk_codec.hpp"

#include <fmt/core.h>
#include <libdeflate.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>
#include <stdexcept>

namespace frahm::results {
namespace {

// Byte 0 of every element, then byte 1 of every element, ...: the slowly changing sign and exponent bytes of
// neighbours come together and compress.
template <std::size_t Size>
void shuffle(std::span<const std::byte> elements, std::span<std::byte> shuffled) {
  const std::size_t count = elements.size() / Size;
  for (std::size_t b = 0; b < Size; ++b) {
    for (std::size_t i = 0; i < count; ++i) shuffled[b * count + i] = elements[i * Size + b];
  }
}

Bytes shuffled(std::span<const std::byte> elements, std::size_t element_size) {
  Bytes bytes(elements.size());
  switch (element_size) {
    case 1:
      shuffle<1>(elements, bytes);
      return bytes;
    case 4:
      shuffle<4>(elements, bytes);
      return bytes;
    case 8:
      shuffle<8>(elements, bytes);
      return bytes;
    default:
      throw std::logic_error(fmt::format("element of {} bytes: must be 1, 4 or 8", element_size));
  }
}

struct FreeCompressor {
  void operator()(libdeflate_compressor* compressor) const { libdeflate_free_compressor(compressor); }
};

// In zlib's format, with `spare` bytes left free at the end.
Bytes deflated(std::span<const std::byte> data, std::size_t spare) {
  constexpr int level = 1;
  const std::unique_ptr<libdeflate_compressor, FreeCompressor> compressor(libdeflate_alloc_compressor(level));
  if (!compressor) throw std::bad_alloc();
  Bytes out(libdeflate_zlib_compress_bound(compressor.get(), data.size()) + spare);
  const std::size_t size =
      libdeflate_zlib_compress(compressor.get(), data.data(), data.size(), out.data(), out.size() - spare);
  if (size == 0)
    throw std::logic_error(fmt::format("{} bytes do not compress into their bound", data.size()));
  out.resize(size + spare);
  return out;
}

}  // namespace

Bytes encode_chunk(std::span<const std::byte> chunk, std::size_t element_size) {
  constexpr std::size_t checksum_size = 4;
  Bytes encoded = deflated(shuffled(chunk, element_size), checksum_size);
  const std::size_t size = encoded.size() - checksum_size;
  const std::uint32_t checksum = fletcher32({encoded.data(), size});
  std::memcpy(encoded.data() + size, &checksum, checksum_size);
  return encoded;
}

std::uint32_t fletcher32(std::span<const std::byte> data) {
  std::uint32_t sum1 = 0, sum2 = 0;
  const auto add = [&](std::byte high, std::byte low) {
    sum1 += std::to_integer<std::uint32_t>(high) << 8 | std::to_integer<std::uint32_t>(low);
    sum2 += sum1;
  };
  const auto fold = [](std::uint32_t sum) { return (sum & 0xffff) + (sum >> 16); };
  constexpr std::size_t block =
      2 * 359;  // bytes; the sums of 360 words, one kept for an odd end, stay below 2^32
  const std::size_t even = data.size() / 2 * 2;
  for (std::size_t from = 0; from < even; from += block) {
    sum1 = fold(sum1);
    sum2 = fold(sum2);
    for (std::size_t i = from; i < std::min(from + block, even); i += 2) add(data[i], data[i + 1]);
  }
  if (even < data.size()) add(data[even], std::byte{0});
  // Twice: the first leaves a carry.
  sum1 = fold(fold(sum1));
  sum2 = fold(fold(sum2));
  return sum2 << 16 | sum1;
}

}  // namespace frahm::results
