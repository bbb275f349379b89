#include "studies/reading/map/corners.hpp"

namespace frahm::studies {
namespace {

constexpr std::size_t most_with_corners = 10;  // 2^10 corners are enough

}  // namespace

std::vector<std::vector<bool>> corners(std::size_t dimensions) {
  std::vector<std::vector<bool>> all;
  if (dimensions > most_with_corners) {
    for (const bool base : {false, true}) {
      all.emplace_back(dimensions, base);
      for (std::size_t i = 0; i < dimensions; ++i) {
        all.emplace_back(dimensions, base);
        all.back()[i] = !base;
      }
    }
    return all;
  }
  for (std::size_t bits = 0; bits < std::size_t{1} << dimensions; ++bits) {
    all.emplace_back(dimensions, false);
    for (std::size_t i = 0; i < dimensions; ++i) all.back()[i] = (bits >> i & 1U) != 0;
  }
  return all;
}

}  // namespace frahm::studies
