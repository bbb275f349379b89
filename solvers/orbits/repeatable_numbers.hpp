#pragma once

#include <cstdint>

namespace frahm::periodic {

// Numbers between -1 and 1, the same at every run: a counter's bits, mixed.
// Source: Steele, Lea, Flood, Proc. OOPSLA 2014, "SplitMix".
class RepeatableNumbers {
 public:
  explicit RepeatableNumbers(int index) : counter_(kStep * static_cast<std::uint64_t>(index)) {}

  double next() {
    std::uint64_t mixed = counter_ += kStep;
    mixed = (mixed ^ (mixed >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    mixed = (mixed ^ (mixed >> 27U)) * 0x94D049BB133111EBULL;
    return static_cast<double>((mixed ^ (mixed >> 31U)) >> 11U) * 0x1p-52 - 1.0;
  }

 private:
  static constexpr std::uint64_t kStep = 0x9E3779B97F4A7C15ULL;
  std::uint64_t counter_;
};

}  // namespace frahm::periodic
