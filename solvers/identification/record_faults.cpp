#include "solvers/identification/record_faults.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "solvers/algebra/no_value.hpp"
#include "solvers/identification/statement.hpp"

namespace frahm::identification {
namespace {

using Samples = std::span<const double>;
constexpr double kLongStep = 2.0;  // median steps
using Turned = std::span<const std::size_t>;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double median_step(Samples time) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < time.size(); ++i) steps.push_back(time[i] - time[i - 1]);
  return median(steps);
}

// The half period of most swings: a gap makes a swing longer.
double half_period_of(Samples time, Turned turned) {
  std::vector<double> swings;
  for (std::size_t k = 1; k < turned.size(); ++k) swings.push_back(time[turned[k]] - time[turned[k - 1]]);
  return median(swings);
}

// Samples in a cycle. Each swing counts whole samples, the mean of all gives the fraction; a gap is left out.
double samples_of_cycle(Samples time, Turned turned, double half_period, double step) {
  double together = 0.0, swings = 0.0;
  for (std::size_t k = 1; k < turned.size(); ++k) {
    const double swing = time[turned[k]] - time[turned[k - 1]];
    if (swing > 1.5 * half_period) continue;
    together += swing;
    swings += 1.0;
  }
  return 2.0 * together / (swings * step);
}

// From half a swing before the first turn to half a swing after the last: a gap beyond that has no effect.
std::string gap(Samples time, Turned turned, double half_period, double step) {
  const double from = time[turned.front()] - 0.5 * half_period, to = time[turned.back()] + 0.5 * half_period;
  for (std::size_t i = 1; i < time.size(); ++i) {
    const double missing = time[i] - time[i - 1];
    if (time[i] < from || time[i - 1] > to || missing <= std::max(0.25 * half_period, kLongStep * step))
      continue;
    return "samples are missing from " + number(time[i - 1]) + " to " + number(time[i]) +
           " s, a large part of a half period of " + number(half_period) +
           " s: turning points in between cannot be seen; use the part before or the part after";
  }
  return "";
}

// The number of samples about one that have its value, and the larger of the steps at both ends.
struct Level {
  std::size_t samples = 1;
  double step = 0.0;
};
Level level_about(Samples x, std::size_t at) {
  std::size_t first = at, last = at;
  while (first > 0 && x[first - 1] == x[at]) --first;
  while (last + 1 < x.size() && x[last + 1] == x[at]) ++last;
  Level level{last - first + 1, 0.0};
  if (first > 0) level.step = std::abs(x[first - 1] - x[at]);
  if (last + 1 < x.size()) level.step = std::max(level.step, std::abs(x[last + 1] - x[at]));
  return level;
}

double least_step(Samples x) {
  double least = kInfinity;
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (x[i] != x[i - 1]) least = std::min(least, std::abs(x[i] - x[i - 1]));
  }
  return least;
}

// A coarse resolution makes levels too, but the steps at their ends are then steps of the resolution.
std::string clipped_at(Samples x, Turned turned, double value, const char* which) {
  constexpr std::size_t kLevel = 3, kTurns = 2;
  constexpr double kSteps = 3.0;
  const double resolution = least_step(x);
  std::size_t turns = 0, most = 0;
  for (const std::size_t at : turned) {
    const Level level = level_about(x, at);
    if (x[at] != value || level.samples < kLevel || level.step < kSteps * resolution) continue;
    ++turns;
    most = std::max(most, level.samples);
  }
  if (turns < kTurns) return "";
  return "the record stays at its " + std::string(which) + ", " + number(value) + " m, at " +
         std::to_string(turns) + " of its turning points, for up to " + std::to_string(most) +
         " samples: it is clipped there";
}

}  // namespace

std::string unless_whole(Samples time, Samples x, Turned turned) {
  const double half_period = half_period_of(time, turned), step = median_step(time);
  if (std::string missing = gap(time, turned, half_period, step); !missing.empty()) return missing;
  const double of_cycle = samples_of_cycle(time, turned, half_period, step);
  if (of_cycle < kLeastSamplesOfCycle * (1.0 - 1e-9))
    return "the record has " + number(of_cycle) + " samples per cycle, it needs " +
           number(kLeastSamplesOfCycle) + " at least";
  const auto [least, most] = std::minmax_element(x.begin(), x.end());
  return first_of(
      {clipped_at(x, turned, *most, "largest value"), clipped_at(x, turned, *least, "least value")});
}

std::string unless_wild(Samples time, Samples x, double noise) {
  constexpr double kErrors = 20.0, kPart = 0.01;  // standard deviations; of the range
  const auto [least, most] = std::minmax_element(x.begin(), x.end());
  const double far = std::max(kErrors * noise, kPart * (*most - *least));
  // Distance of sample i from the line through its neighbours.
  const auto off = [&](std::size_t i) {
    const double part = (time[i] - time[i - 1]) / (time[i + 1] - time[i - 1]);
    return x[i] - x[i - 1] - part * (x[i + 1] - x[i - 1]);
  };
  // The line over a gap is inaccurate by itself.
  const double longest = kLongStep * median_step(time);
  for (std::size_t i = 2; i + 2 < x.size(); ++i) {
    bool even = true;
    for (std::size_t j = i - 1; j <= i + 2; ++j) even = even && time[j] - time[j - 1] <= longest;
    if (!even) continue;
    const double here = off(i), before = off(i - 1), behind = off(i + 1);
    if (std::abs(here) > far && here * before < 0.0 && here * behind < 0.0 &&
        std::abs(here) > std::max(std::abs(before), std::abs(behind)))
      return "the sample at " + number(time[i]) + " s, " + number(x[i]) + " m, is " + number(std::abs(here)) +
             " m off the line through its neighbours: take it out if it is a fault";
  }
  return "";
}

}  // namespace frahm::identification
