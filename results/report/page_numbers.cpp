#include "results/report/page_numbers.hpp"

#include <algorithm>
#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "results/deflate.hpp"

namespace frahm::results {
namespace {

std::string base64(Bytes bytes) {
  using namespace boost::archive::iterators;
  using Text = base64_from_binary<transform_width<const char*, 6, 8>>;
  const std::size_t padding = (3 - bytes.size() % 3) % 3;
  bytes.resize(bytes.size() + padding);
  const auto* data = reinterpret_cast<const char*>(bytes.data());
  std::string text(Text(data), Text(data + bytes.size()));
  std::fill_n(text.rbegin(), padding, '=');
  return text;
}

template <typename Number>
std::string packed(std::span<const Number> numbers) {
  constexpr int level = 9;  // a page is made once and sent often
  return base64(deflated(shuffled(std::as_bytes(numbers), sizeof(Number)), level));
}

// The levels of the values, before differences are taken.
std::vector<std::int64_t> levels_of(std::span<const double> values, const PackedLevels& scale) {
  std::vector<std::int64_t> levels(values.size(), 0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    const double above = values[i] - scale.low;
    levels[i] = 1 + (scale.step > 0.0 ? std::llround(above / scale.step) : 0);
  }
  return levels;
}

// 0, -1, 1, -2, ... to 0, 1, 2, 3, ...
std::uint32_t sign_in_lowest_bit(std::int64_t difference) {
  return static_cast<std::uint32_t>(difference >= 0 ? 2 * difference : -2 * difference - 1);
}

}  // namespace

std::string packed_numbers(std::span<const double> values) {
  return packed(values);
}

PackedLevels pack_levels(std::span<const double> values, const LineShape& line, double step) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  PackedLevels scale;
  if (low <= high) {
    scale.low = low;
    scale.step = step > 0.0 ? step : (high - low) / levels_in_range;
  }
  const std::vector<std::int64_t> levels = levels_of(values, scale);
  std::vector<std::uint32_t> differences(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::uint64_t along = i / line.stride % line.size;
    const std::int64_t before = along > 0 ? levels[i - line.stride] : 0;
    const std::int64_t before_that = along > 1 ? levels[i - 2 * line.stride] : 0;
    differences[i] = sign_in_lowest_bit(levels[i] - 2 * before + before_that);
  }
  scale.levels = packed(std::span<const std::uint32_t>(differences));
  return scale;
}

}  // namespace frahm::results
