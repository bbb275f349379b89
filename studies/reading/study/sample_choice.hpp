#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace frahm::studies {

// The dimension of a map whose points are samples of uncertain parameters.
struct SampleChoice {
  std::size_t dimension = 0;      // of the map
  std::vector<std::size_t> axes;  // of the uncertain parameters; all of them lie along that dimension
  std::vector<std::string>
      texts;          // of each its distribution, for readers: "normal, mean 5, deviation 0.5 (kg)"
  std::string drawn;  // for readers: "1000 points of sobol, seed 1", "of samples.csv"
  std::vector<double> quantiles{0.05, 0.5, 0.95};  // shares, strictly between 0 and 1, rising
};

// Without a name of its own. Not "sample": that is an instant of the histories next to it in a file.
inline constexpr const char* sample_dimension = "draw";

// "q5", "q97_5": the name of a quantile in the record.
std::string quantile_name(double share);

}  // namespace frahm::studies
