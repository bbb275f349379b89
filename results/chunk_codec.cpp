#include "results/chunk_codec.hpp"

#include <algorithm>
#include <cstring>

#include "results/deflate.hpp"

namespace frahm::results {
Bytes encode_chunk(std::span<const std::byte> chunk, std::size_t element_size) {
  constexpr std::size_t checksum_size = 4;
  constexpr int level = 1;
  Bytes encoded = deflated(shuffled(chunk, element_size), level, checksum_size);
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
      std::size_t{2} * 359;  // bytes; the sums of 360 words, one reserved for an odd end, stay below 2^32
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
