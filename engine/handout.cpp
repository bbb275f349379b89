#include "engine/handout.hpp"

#include <algorithm>

namespace frahm::engine {

std::uint64_t block_size(std::uint64_t left, int threads, int all_threads) {
  constexpr std::uint64_t parts = 4, most_per_thread = 64;
  const auto own = static_cast<std::uint64_t>(threads), all = static_cast<std::uint64_t>(all_threads);
  const std::uint64_t block = std::clamp<std::uint64_t>(left * own / (parts * all), 1, most_per_thread * own);
  return std::min(block, left);
}

}  // namespace frahm::engine
