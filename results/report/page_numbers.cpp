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

constexpr double most_levels = 5e8;  // their second differences fit into 32 bits

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  double least_positive = low;
};

Range range_of(std::span<const double> values) {
  Range range;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
    if (value > 0.0) range.least_positive = std::min(range.least_positive, value);
  }
  return range;
}

// The step is a power of ten, so that a value printed to it has no digit that the levels lack.
PackedLevels decimal_scale(const Range& range) {
  const double step = std::pow(10.0, std::floor(std::log10((range.high - range.low) * millionth)));
  return {.low = std::floor(range.low / step) * step, .step = step};
}

PackedLevels scale_of(std::span<const double> values, Spacing spacing) {
  const Range range = range_of(values);
  if (!(range.low <= range.high)) return {};
  if (spacing == Spacing::whole) return {.low = range.low, .step = 1.0};
  if (range.low == range.high) return {.low = range.low};
  if (range.low < 0.0) return decimal_scale(range);
  const double span = std::log(range.high) - std::log(range.least_positive);
  return {.logarithmic = true, .low = range.least_positive, .step = std::max(millionth, span / most_levels)};
}

std::int64_t level_of(double value, const PackedLevels& scale) {
  if (!std::isfinite(value)) return 0;
  if (scale.logarithmic)
    return value > 0.0 ? 2 + std::llround((std::log(value) - std::log(scale.low)) / scale.step) : 1;
  return 1 + (scale.step > 0.0 ? std::llround((value - scale.low) / scale.step) : 0);
}

// The levels of the values, before differences are taken.
std::vector<std::int64_t> levels_of(std::span<const double> values, const PackedLevels& scale) {
  std::vector<std::int64_t> levels;
  levels.reserve(values.size());
  for (const double value : values) levels.push_back(level_of(value, scale));
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

PackedLevels pack_levels(std::span<const double> values, const LineShape& line, Spacing spacing) {
  PackedLevels scale = scale_of(values, spacing);
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
