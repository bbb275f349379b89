#include "solvers/transient/record_facts.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "solvers/transient/record_course.hpp"

namespace frahm::transient {
namespace {

constexpr double rounded = 1e-3;  // of an interval: what times written with few digits differ by

void find_intervals(const Record& record, RecordFacts& facts) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < record.time.size(); ++i)
    intervals.push_back(record.time[i] - record.time[i - 1]);
  const auto longest = std::ranges::max_element(intervals);
  facts.longest = *longest;
  facts.longest_from = record.time[static_cast<std::size_t>(longest - intervals.begin())];
  facts.shortest = std::ranges::min(intervals);
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>((intervals.size() - 1) / 2);
  std::ranges::nth_element(intervals, middle);
  facts.usual = *middle;
  facts.even = facts.longest - facts.shortest <= rounded * facts.longest;
}

// Between samples too.
void find_peak_of_spline(const Record& record, RecordFacts& facts) {
  const auto meet = [&](double value, double time) {
    if (std::abs(value) <= facts.peak) return;
    facts.peak = std::abs(value);
    facts.peak_time = time - record.time.front();
  };
  for (const Reach& reach : reaches(record)) {
    meet(reach.least, reach.least_at);
    meet(reach.most, reach.most_at);
  }
}

// For straight lines from sample to sample, over an interval h:
//   acceleration  v += h (a0 + a1)/2,   y += h v0 + h^2 (2 a0 + a1)/6
//   velocity      y += h (v0 + v1)/2
void integrate(const Record& record, RecordFacts& facts) {
  const bool is_acceleration = record.of == RecordOf::acceleration;
  if (!is_acceleration && record.of != RecordOf::velocity) return;
  for (std::size_t i = 1; i < record.time.size(); ++i) {
    const double h = record.time[i] - record.time[i - 1], a0 = record.values[i - 1], a1 = record.values[i];
    if (is_acceleration) {
      facts.end_displacement += h * facts.end_velocity + h * h * (2.0 * a0 + a1) / 6.0;
      facts.end_velocity += 0.5 * h * (a0 + a1);
    } else {
      facts.end_displacement += 0.5 * h * (a0 + a1);
    }
    facts.peak_velocity = std::max(facts.peak_velocity, std::abs(facts.end_velocity));
    facts.peak_displacement = std::max(facts.peak_displacement, std::abs(facts.end_displacement));
  }
}

}  // namespace

RecordFacts facts_of(const Record& record) {
  RecordFacts facts{.duration = record.time.back() - record.time.front(),
                    .start = record.values.front(),
                    .end = record.values.back()};
  find_intervals(record, facts);
  for (std::size_t i = 0; i < record.values.size(); ++i) {
    if (std::abs(record.values[i]) <= facts.peak) continue;
    facts.peak = std::abs(record.values[i]);
    facts.peak_time = record.time[i] - record.time.front();
  }
  if (record.is_spline()) find_peak_of_spline(record, facts);
  integrate(record, facts);
  return facts;
}

}  // namespace frahm::transient
