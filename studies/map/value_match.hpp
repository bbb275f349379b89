#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace frahm::studies {

// The equal values of two axes.
struct ValueMatch {
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  // For each value the rank, from the smallest, of the equal known value; or `none`.
  std::vector<std::uint32_t> known;
  std::vector<std::uint32_t> wanted;
};

// Values that were made in different ways, by steps of another number or in another unit, differ in their
// last digits: steps from a to b round by eps (|a| + |b|), and so do values near zero. So two values are the
// same if they differ by no more than 2 eps (|v| + n d) of either axis, v the value, n the number of
// different values on its axis and d the distance to its nearest neighbour: n d is the length of an axis of
// even steps, and the logarithm of its range times v of one of even ratios.
// That is about 1e-15 of the parameter, or 1e-9 of a step at most: a response moves by less than the residual
// of its solution, and no value can be taken for its neighbour.
ValueMatch match_values(std::span<const double> known, std::span<const double> wanted);

}  // namespace frahm::studies
