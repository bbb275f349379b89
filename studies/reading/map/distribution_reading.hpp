#pragma once

#include <string>

#include "solvers/samples/distribution.hpp"
#include "studies/reading/keys/toml_section.hpp"

namespace frahm::studies {

struct ReadDistribution {
  samples::Distribution distribution;  // in the unit of the section
  std::string text;                    // for readers, without the unit: "normal, mean 5, deviation 0.5"
};

// distribution = "normal" with mean and deviation, or variation (deviation over mean); "lognormal" with mean
// or median, and deviation or variation; both with lower and upper, where they are cut off, if they are;
// "uniform" with lower and upper; "triangular" with lower, mode and upper.
ReadDistribution read_distribution(const TomlSection& section);

}  // namespace frahm::studies
