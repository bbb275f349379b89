#pragma once

#include <cstddef>
#include <span>
#include <string>

// Faults of a sampled free vibration that its samples show.
namespace frahm::identification {

// Fewer samples a cycle do not resolve the shape about a turning point: the point is then biased, and its
// standard error too small.
inline constexpr double kLeastSamplesOfCycle = 12.0;

// "" if there is no fault, otherwise a sentence that says what and where. turned: the samples, two at least,
// at which the trace turns; noise: standard deviation of the samples.
//   samples missing: a step of time above a quarter of a half period, and above twice the median step;
//   too coarse: fewer than kLeastSamplesOfCycle a cycle;
//   a wild sample: far from its neighbours' line, on the other side of it than they are of theirs, by more
//   than 20 standard deviations and by a hundredth of the range, where the steps of time are even;
//   clipped: three samples and more of one value, the largest or the least of all, at two turns and more.
std::string unless_whole(std::span<const double> time, std::span<const double> displacement,
                         std::span<const std::size_t> turned);
std::string unless_wild(std::span<const double> time, std::span<const double> displacement, double noise);

}  // namespace frahm::identification
