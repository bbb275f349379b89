#pragma once

#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "solvers/identification/identification.hpp"

// For tests of identification: estimates by name, noise, and how often an interval holds the truth.
namespace frahm::identification {

inline const Estimate& estimate_of(const Identification& result, const std::string& name) {
  for (const Estimate& estimate : result.estimates) {
    if (estimate.name == name) return estimate;
  }
  throw std::invalid_argument("no estimate " + name + ": " + result.failure);
}

inline double value_of(const Identification& result, const std::string& name) {
  return estimate_of(result, name).value;
}

inline bool holds(const Identification& result, const std::string& name, double truth) {
  const Estimate& estimate = estimate_of(result, name);
  return estimate.low <= truth && truth <= estimate.high;
}

// White noise of one record.
class Noise {
 public:
  explicit Noise(unsigned seed) : random_(seed) {}
  std::vector<double> on(std::vector<double> values, double standard_deviation) {
    std::normal_distribution<double> normal(0.0, standard_deviation);
    for (double& value : values) value += normal(random_);
    return values;
  }

 private:
  std::mt19937_64 random_;
};

// Of a hundred noisy records the 95 % interval of each quantity holds the truth in at least so many: an
// honest interval misses that in one of fifty such tests only.
constexpr int kRecords = 100, kHeld = 90;

struct Truth {
  std::string name;
  double value;
  int held = 0;
};

// identify(seed): what is found of the record of that seed.
template <class Identify>
void count_held(std::vector<Truth>& truths, const Identify& identify) {
  for (unsigned seed = 1; seed <= kRecords; ++seed) {
    const Identification result = identify(seed);
    for (Truth& truth : truths) truth.held += holds(result, truth.name, truth.value) ? 1 : 0;
  }
}

}  // namespace frahm::identification
