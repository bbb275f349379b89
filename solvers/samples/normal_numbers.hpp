#pragma once

#include <cstdint>
#include <random>

namespace frahm::samples {

// Independent normal random numbers of mean 0 and variance 1, the same ones on every machine: the generator
// and its seeding are fixed by the C++ standard, and the numbers follow from its integers by
// functions that round alike (elementary.hpp).
class NormalNumbers {
 public:
  // For one stream of a seed: numbers of different streams are independent.
  NormalNumbers(std::uint64_t seed, std::uint32_t stream);

  double next();

 private:
  double uniform();  // in (0, 1)

  std::mt19937_64 generator_;
};

}  // namespace frahm::samples
