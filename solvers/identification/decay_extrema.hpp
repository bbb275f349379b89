#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

// The turning points of a measured free vibration.
namespace frahm::identification {

// Maxima and minima in turn. Without times a missing pair of them cannot be detected.
struct DecayExtrema {
  std::vector<double> time, displacement;              // [s], [m]; times may be empty: not known
  std::vector<double> time_sigma, displacement_sigma;  // standard errors; empty: not known
  double degrees_of_freedom = 0.0;                     // of the variance behind the standard errors
};

struct FoundExtrema {
  std::string failure;  // why there are no extrema, a sentence; empty: there are some
  DecayExtrema extrema;
  double noise = 0.0;              // standard deviation of the samples about the fits [m]
  std::vector<std::string> notes;  // what was left out
};

// The extrema of a sampled trace. time [s]: increasing; displacement [m]: as many, at least kLeastSamples.
// turning_point.hpp fits each of them over a quarter period on either side; all turns together give the half
// period and the decrease that shape these fits.
// Left out: turning points with less than half a side within the record, and swings that are lost in noise.
// failure: not finite, not increasing, too few samples, fewer than two turning points, or a fault of
// record_faults.hpp: samples that are missing, too far apart, wild, or clipped.
FoundExtrema find_extrema(std::span<const double> time, std::span<const double> displacement);
inline constexpr std::size_t kLeastSamples = 16;

}  // namespace frahm::identification
