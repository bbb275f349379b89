#include "studies/map/tile_record.hpp"

#include <bit>
#include <stdexcept>

namespace frahm::studies {
namespace {

constexpr std::size_t word = sizeof(std::uint64_t);

// Takes words and texts off the front of a record.
class RecordReading {
 public:
  explicit RecordReading(std::span<const std::byte> bytes) : bytes_(bytes) {}

  bool at_end() const { return bytes_.empty(); }
  std::uint64_t number() { return engine::get_little_endian<std::uint64_t>(take(word).data()); }
  std::span<const std::byte> take(std::size_t size) {
    if (size > bytes_.size()) throw std::runtime_error("the record of a tile is shorter than it says");
    const auto taken = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return taken;
  }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace

void encode(const TileRecord& record, engine::Bytes& out) {
  const auto append = [&out](std::uint64_t number) {
    out.resize(out.size() + word);
    engine::put_little_endian(out.data() + out.size() - word, number);
  };
  const std::size_t begin = out.size();
  out.resize(begin + word * record.values.size());
  for (std::size_t i = 0; i < record.values.size(); ++i) {
    engine::put_little_endian(out.data() + begin + word * i, std::bit_cast<std::uint64_t>(record.values[i]));
  }
  for (const FailedPoint& point : record.failed) {
    append(point.place);
    append(point.reason.size());
    const auto text = std::as_bytes(std::span(point.reason));
    out.insert(out.end(), text.begin(), text.end());
  }
}

void decode(std::span<const std::byte> bytes, std::size_t values, TileRecord& record) {
  RecordReading reading(bytes);
  const auto numbers = reading.take(word * values);
  record.values.resize(values);
  for (std::size_t i = 0; i < values; ++i) {
    record.values[i] =
        std::bit_cast<double>(engine::get_little_endian<std::uint64_t>(numbers.data() + word * i));
  }
  record.failed.clear();
  while (!reading.at_end()) {
    const std::uint64_t place = reading.number();
    const auto text = reading.take(reading.number());
    record.failed.push_back({place, {reinterpret_cast<const char*>(text.data()), text.size()}});
  }
}

std::uint64_t count_failed(std::span<const std::byte> bytes, std::size_t values) {
  RecordReading reading(bytes);
  reading.take(word * values);
  std::uint64_t count = 0;
  for (; !reading.at_end(); ++count) {
    reading.number();
    reading.take(reading.number());
  }
  return count;
}

}  // namespace frahm::studies
