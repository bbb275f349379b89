#include "results/deflate.hpp"

#include <fmt/core.h>
#include <isa-l/igzip_lib.h>

#include <array>
#include <memory>
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

struct Compressor {
  isal_zstream stream;
  std::array<std::uint8_t, ISAL_DEF_LVL1_DEFAULT> workspace;
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

Bytes deflated(std::span<const std::byte> data, std::size_t planes, std::size_t spare) {
  constexpr std::size_t kHeaders = 1024;  // more than what the blocks of a plane add, and the stream's own
  const auto compressor = std::make_unique<Compressor>();  // zeros: what is left over never matters
  isal_zstream& stream = compressor->stream;
  isal_deflate_init(&stream);
  stream.level = 1;
  stream.level_buf = compressor->workspace.data();
  stream.level_buf_size = static_cast<std::uint32_t>(compressor->workspace.size());
  stream.gzip_flag = IGZIP_ZLIB;
  stream.flush = SYNC_FLUSH;
  Bytes out(data.size() + data.size() / 64 + kHeaders * (planes + 1) + spare);
  stream.next_out = reinterpret_cast<std::uint8_t*>(out.data());
  stream.avail_out = static_cast<std::uint32_t>(out.size() - spare);
  const std::size_t size = data.size() / planes;
  for (std::size_t p = 0; p < planes; ++p) {
    // The library reads through this pointer only.
    stream.next_in = reinterpret_cast<std::uint8_t*>(const_cast<std::byte*>(data.data() + p * size));
    stream.avail_in = static_cast<std::uint32_t>(size);
    stream.end_of_stream = p + 1 == planes ? 1 : 0;
    if (const int status = isal_deflate(&stream); status != COMP_OK || stream.avail_in != 0)
      throw std::logic_error(fmt::format("isal_deflate of {} bytes returned {}", size, status));
  }
  if (stream.internal_state.state != ZSTATE_END)
    throw std::logic_error(fmt::format("{} bytes do not compress into their bound", data.size()));
  out.resize(stream.total_out + spare);
  return out;
}

}  // namespace frahm::results
