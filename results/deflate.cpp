#include "results/deflate.hpp"

#include <fmt/core.h>
#include <libdeflate.h>

#include <memory>
#include <new>
#include <stdexcept>

namespace frahm::results {
namespace {

template <std::size_t Size>
void shuffle(std::span<const std::byte> elements, std::span<std::byte> shuffled) {
  const std::size_t count = elements.size() / Size;
  for (std::size_t b = 0; b < Size; ++b) {
    for (std::size_t i = 0; i < count; ++i) shuffled[b * count + i] = elements[i * Size + b];
  }
}

struct FreeCompressor {
  void operator()(libdeflate_compressor* compressor) const { libdeflate_free_compressor(compressor); }
};

}  // namespace

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

Bytes deflated(std::span<const std::byte> data, int level, std::size_t spare) {
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

}  // namespace frahm::results
