#include "solvers/transient/record_course.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/mechanics/recorded_columns.hpp"

namespace frahm::transient {
namespace {

using mechanics::ExcitationKind;
using mechanics::MechanicsError;

// r, r', r'', r''' at an instant.
using Numbers = std::array<double, mechanics::kRecordNumbers>;

// Slope at t[0] of the parabola through three points.
double end_slope(const double* t, const double* y, int towards) {
  const double h1 = t[towards] - t[0], h2 = t[2 * towards] - t[0];
  return ((y[towards] - y[0]) * h2 * h2 - (y[2 * towards] - y[0]) * h1 * h1) / (h1 * h2 * (h2 - h1));
}

// Slopes of the cubic spline: continuous second derivatives,
//   s_{i-1}/h_{i-1} + 2 s_i (1/h_{i-1} + 1/h_i) + s_{i+1}/h_i = 3 (dy_{i-1}/h_{i-1}^2 + dy_i/h_i^2)
// (source [27], ch. IV), by Gauss elimination.
std::vector<double> spline_slopes(const std::vector<double>& t, const std::vector<double>& y) {
  const std::size_t n = y.size();
  std::vector<double> slope(n), above(n, 0.0);
  slope[0] = end_slope(&t[0], &y[0], 1);
  slope[n - 1] = end_slope(&t[n - 1], &y[n - 1], -1);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = 1.0 / (t[i] - t[i - 1]), after = 1.0 / (t[i + 1] - t[i]);
    const double right = 3.0 * ((y[i] - y[i - 1]) * before * before + (y[i + 1] - y[i]) * after * after);
    const double pivot = 2.0 * (before + after) - before * above[i - 1];
    above[i] = after / pivot;
    slope[i] = (right - before * slope[i - 1]) / pivot;
  }
  for (std::size_t i = n - 2; i > 0; --i) slope[i] -= above[i] * slope[i + 1];
  return slope;
}

// The cubic with these values and slopes at both ends of an interval h (Hermite).
Numbers cubic(double y0, double y1, double s0, double s1, double h) {
  const double mean = (y1 - y0) / h;
  return {y0, s0, 2.0 * (3.0 * mean - 2.0 * s0 - s1) / h, 6.0 * (s0 + s1 - 2.0 * mean) / (h * h)};
}

// `s` later on the same polynomial.
Numbers later(const Numbers& r, double s) {
  return {r[0] + s * (r[1] + 0.5 * s * (r[2] + s / 3.0 * r[3])), r[1] + s * (r[2] + 0.5 * s * r[3]),
          r[2] + s * r[3], r[3]};
}

// A record from each of its times on; behind the last one what remains.
std::vector<Numbers> course_of(const Record& record) {
  const std::vector<double>&t = record.time, &y = record.values;
  std::vector<Numbers> course;
  const std::vector<double> slopes =
      record.of == RecordOf::displacement ? spline_slopes(t, y) : std::vector<double>();
  double displacement = 0.0, velocity = 0.0;  // of a support
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    const double h = t[i + 1] - t[i], slope = (y[i + 1] - y[i]) / h;
    switch (record.of) {
      case RecordOf::force:
        course.push_back({y[i], slope, 0.0, 0.0});
        break;
      case RecordOf::displacement:
        course.push_back(cubic(y[i], y[i + 1], slopes[i], slopes[i + 1], h));
        break;
      case RecordOf::velocity:
        course.push_back({displacement, y[i], slope, 0.0});
        break;
      case RecordOf::acceleration:
        course.push_back({displacement, velocity, y[i], slope});
        break;
    }
    displacement = later(course.back(), h)[0];
    velocity = later(course.back(), h)[1];
  }
  switch (record.of) {
    case RecordOf::force:
      course.push_back({});
      break;
    case RecordOf::displacement:
      course.push_back({y.back(), 0.0, 0.0, 0.0});
      break;
    case RecordOf::velocity:
      course.push_back({displacement, 0.0, 0.0, 0.0});
      break;
    case RecordOf::acceleration:
      course.push_back({displacement, velocity, 0.0, 0.0});
      break;
  }
  return course;
}

void check(const Record& record) {
  const std::size_t least = record.of == RecordOf::displacement ? 3 : 2;
  const std::string name = "record '" + record.name + "': ";
  if (record.time.size() < least || record.time.size() != record.values.size())
    throw MechanicsError(name + "needs at least " + std::to_string(least) +
                         " samples, a value for each time");
  const auto finite = [](double x) { return std::isfinite(x); };
  if (!std::ranges::all_of(record.time, finite) || !std::ranges::all_of(record.values, finite))
    throw MechanicsError(name + "must be finite");
  if (std::ranges::adjacent_find(record.time, std::greater_equal<>()) != record.time.end())
    throw MechanicsError(name + "its times must ascend");
}

// The record of a component.
const Record& record_of(const mechanics::Network& network, std::size_t excitation,
                        std::span<const RecordedExcitation> records) {
  const auto found = std::ranges::find(records, excitation, &RecordedExcitation::excitation);
  if (found == records.end()) throw MechanicsError("a recorded part of the excitation has no record");
  check(*found->record);
  const bool is_force = network.excitations[excitation].kind == ExcitationKind::recorded_force;
  if (is_force != (found->record->of == RecordOf::force))
    throw MechanicsError("record '" + found->record->name + "': " +
                         (is_force ? "a force acts on a mass, a motion is one of a support"
                                   : "a support moves, a force acts on a mass"));
  return *found->record;
}

}  // namespace

RecordCourse::RecordCourse(const mechanics::Network& network, std::span<const RecordedExcitation> records) {
  std::vector<const Record*> each;
  for (std::size_t k = 0; k < network.excitations.size(); ++k) {
    if (mechanics::is_recorded(network.excitations[k].kind)) each.push_back(&record_of(network, k, records));
  }
  for (const Record* record : each) {
    std::vector<double> all;
    std::ranges::set_union(times_, record->time, std::back_inserter(all));
    times_ = std::move(all);
  }
  const auto count = static_cast<Eigen::Index>(each.size()) * mechanics::kRecordNumbers;
  numbers_.assign(times_.size(), Eigen::VectorXd::Zero(count));
  sizes_.setZero(count);
  for (std::size_t r = 0; r < each.size(); ++r) {
    const std::vector<double>& t = each[r]->time;
    const std::vector<Numbers> course = course_of(*each[r]);
    std::size_t now = 0;
    for (std::size_t i = 0; i < times_.size(); ++i) {
      while (now + 1 < t.size() && t[now + 1] <= times_[i]) ++now;
      if (times_[i] < t.front()) continue;
      const Numbers at = later(course[now], times_[i] - t[now]);
      std::ranges::copy(at, numbers_[i].data() + r * at.size());
    }
  }
  bound_numbers();
  find_interval();
}

void RecordCourse::tell(mechanics::LinearSystem& system) const {
  system.recorded_size = sizes_;
  system.recorded_interval = interval_;
}

// Times are rounded to some parts of 1e-16 of the last.
void RecordCourse::find_interval() {
  if (times_.empty()) return;
  const auto intervals = static_cast<double>(times_.size() - 1);
  const double mean = (times_.back() - times_.front()) / intervals;
  for (std::size_t i = 0; i < times_.size(); ++i) {
    const double even = times_.front() + mean * static_cast<double>(i);
    if (std::abs(times_[i] - even) > 1e-14 * std::max(std::abs(times_.front()), std::abs(times_.back())))
      return;
  }
  interval_ = mean;
}

// |r| <= the largest at a time + the longest interval x the largest |r'|
void RecordCourse::bound_numbers() {
  double longest = 0.0;
  for (std::size_t i = 0; i + 1 < times_.size(); ++i) longest = std::max(longest, times_[i + 1] - times_[i]);
  for (const Eigen::VectorXd& numbers : numbers_) sizes_ = sizes_.cwiseMax(numbers.cwiseAbs());
  for (Eigen::Index k = sizes_.size() - 1; k-- > 0;) {
    if (mechanics::has_derivative(k)) sizes_[k] = std::max(sizes_[k], longest * sizes_[k + 1]);
  }
}

bool is_known_behind(const Record& record) {
  if (record.of == RecordOf::velocity) return record.values.back() == 0.0;
  if (record.of != RecordOf::displacement) return true;
  const std::size_t last = record.time.size() - 1;
  return end_slope(&record.time[last], &record.values[last], -1) == 0.0;
}

}  // namespace frahm::transient
