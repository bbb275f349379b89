#include "studies/map/tile_entry.hpp"

#include <bit>

#include "engine/bad_entry.hpp"

namespace frahm::studies {
namespace {

constexpr std::size_t word = sizeof(std::uint64_t);

// Reads words and texts from the front of an entry.
class EntryReading {
 public:
  explicit EntryReading(std::span<const std::byte> bytes) : bytes_(bytes) {}

  bool at_end() const { return bytes_.empty(); }
  std::uint64_t number() { return engine::get_little_endian<std::uint64_t>(take(word).data()); }
  std::span<const std::byte> take(std::size_t size) {
    if (size > bytes_.size()) throw engine::BadEntry("the record of a tile is shorter than its header says");
    const auto taken = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return taken;
  }

 private:
  std::span<const std::byte> bytes_;
};

void append(std::uint64_t number, engine::Bytes& out) {
  out.resize(out.size() + word);
  engine::put_little_endian(out.data() + out.size() - word, number);
}

// In the last word of a border.
constexpr unsigned element_shift = 16, below_shift = 32, above_shift = 48;

void append(const Border& border, engine::Bytes& out) {
  append(border.offset, out);
  append(std::bit_cast<std::uint64_t>(border.crossing.at), out);
  append(std::uint64_t{border.dimension} | std::uint64_t{border.element} << element_shift |
             static_cast<std::uint64_t>(border.crossing.below) << below_shift |
             static_cast<std::uint64_t>(border.crossing.above) << above_shift,
         out);
}

Border take_border(EntryReading& reading) {
  Border border{.offset = reading.number()};
  border.crossing.at = std::bit_cast<double>(reading.number());
  const std::uint64_t rest = reading.number();
  border.dimension = static_cast<std::uint16_t>(rest);
  border.element = static_cast<std::uint16_t>(rest >> element_shift);
  border.crossing.below = static_cast<periodic::Regime>(static_cast<std::uint16_t>(rest >> below_shift));
  border.crossing.above = static_cast<periodic::Regime>(static_cast<std::uint16_t>(rest >> above_shift));
  return border;
}

}  // namespace

void encode(const TileEntry& entry, engine::Bytes& out) {
  const std::size_t begin = out.size();
  out.resize(begin + word * entry.values.size());
  for (std::size_t i = 0; i < entry.values.size(); ++i) {
    engine::put_little_endian(out.data() + begin + word * i, std::bit_cast<std::uint64_t>(entry.values[i]));
  }
  for (const FailedPoint& point : entry.failed) {
    append(point.offset, out);
    append(point.reason.size(), out);
    const auto text = std::as_bytes(std::span(point.reason));
    out.insert(out.end(), text.begin(), text.end());
  }
  if (!entry.borders) return;
  append(no_point, out);
  for (const Border& border : *entry.borders) append(border, out);
}

void decode(std::span<const std::byte> bytes, std::size_t values, TileEntry& entry) {
  EntryReading reading(bytes);
  const auto numbers = reading.take(word * values);
  entry.values.resize(values);
  for (std::size_t i = 0; i < values; ++i) {
    entry.values[i] =
        std::bit_cast<double>(engine::get_little_endian<std::uint64_t>(numbers.data() + word * i));
  }
  entry.failed.clear();
  entry.borders.reset();
  while (!reading.at_end()) {
    const std::uint64_t offset = reading.number();
    if (offset == no_point) {
      entry.borders.emplace();
      while (!reading.at_end()) entry.borders->push_back(take_border(reading));
      return;
    }
    const auto text = reading.take(reading.number());
    entry.failed.push_back({offset, {reinterpret_cast<const char*>(text.data()), text.size()}});
  }
}

std::uint64_t count_failed(std::span<const std::byte> bytes, std::size_t values) {
  EntryReading reading(bytes);
  reading.take(word * values);
  std::uint64_t count = 0;
  for (; !reading.at_end(); ++count) {
    if (reading.number() == no_point) break;
    reading.take(reading.number());
  }
  return count;
}

}  // namespace frahm::studies
