#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

// Numbers in the page of a report: compressed, as text. The page's script unpacks them (page/numbers.js).
namespace frahm::results {

// Base64 of zlib of the float64s' bytes, little-endian, all first bytes first, then all second ones ...
std::string packed_numbers(std::span<const double> values);

// Numbers to six digits. Level 0 is a missing value (NaN, or an infinite one), level 1 + n the value low + n
// step; on a logarithmic scale level 1 is zero and level 2 + n the value low exp(n step).
struct PackedLevels {
  bool logarithmic = false;
  double low = 0.0, step = 0.0;
  std::string levels = {};  // packed, see pack_levels
};

constexpr double millionth = 1e-6;

enum class Spacing {
  whole,       // whole numbers, all digits
  six_digits,  // of each value where none is negative, otherwise at least six of their range
};

// Lines of numbers along one axis: numbers i, i + stride, i + 2 stride, ... (`size` of them) are one line.
struct LineShape {
  std::uint64_t size = 1, stride = 1;
};

// A smooth response is nearly straight along each line, so the second differences of its levels are stored
// (levels before the first count as 0): 32-bit numbers with the sign in the lowest bit, whose bytes are
// shuffled and deflated as above.
PackedLevels pack_levels(std::span<const double> values, const LineShape& line, Spacing spacing);

}  // namespace frahm::results
