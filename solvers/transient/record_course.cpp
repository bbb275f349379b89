#include "solvers/transient/record_course.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <list>
#include <sstream>

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/mechanics/recorded_columns.hpp"

namespace frahm::transient {
namespace {

using mechanics::ExcitationKind;
using mechanics::MechanicsError;

// r, r', r'', r''' at an instant.
using Numbers = std::array<double, mechanics::kRecordNumbers>;

// For a record's range: far beyond what lies between the samples of a smooth motion.
constexpr double kStrays = 0.25;

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

// A record from each of its times on; after the last one what remains.
std::vector<Numbers> course_of(const Record& record) {
  const std::vector<double>&t = record.time, &y = record.values;
  std::vector<Numbers> course;
  const std::vector<double> slopes = record.is_spline() ? spline_slopes(t, y) : std::vector<double>();
  double displacement = 0.0, velocity = 0.0;  // of a support
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    const double h = t[i + 1] - t[i], slope = h > 0.0 ? (y[i + 1] - y[i]) / h : 0.0;
    switch (record.of) {
      case RecordOf::force:
        course.push_back({y[i], slope, 0.0, 0.0});
        break;
      case RecordOf::displacement:
        course.push_back(record.is_spline() ? cubic(y[i], y[i + 1], slopes[i], slopes[i + 1], h)
                                            : Numbers{y[i], slope, 0.0, 0.0});
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

// Steps of corners apart.
bool ascends(const Record& record) {
  const bool may_step = record.is_corners && record.of != RecordOf::displacement;
  for (std::size_t i = 1; i < record.time.size(); ++i) {
    const bool steps = may_step && record.steps_at(i) && !record.steps_at(i - 1);
    if (!(record.time[i] > record.time[i - 1]) && !steps) return false;
  }
  return true;
}

// Corners whose last value holds until then.
Record held(const Record& corners, double until) {
  Record longer = corners;
  if (until > longer.time.back()) {
    longer.time.push_back(until);
    longer.values.push_back(longer.values.back());
  }
  return longer;
}

void check(const Record& record) {
  const std::size_t least = least_samples(record);
  const std::string name = "record '" + record.name + "': ";
  if (record.time.size() < least || record.time.size() != record.values.size())
    throw MechanicsError(name + "needs at least " + std::to_string(least) +
                         " samples, a value for each time");
  const auto finite = [](double x) { return std::isfinite(x); };
  if (!std::ranges::all_of(record.time, finite) || !std::ranges::all_of(record.values, finite))
    throw MechanicsError(name + "must be finite");
  if (!ascends(record)) throw MechanicsError(name + "its times must ascend");
  if (const std::string why = why_no_spline(record); !why.empty()) throw MechanicsError(name + why);
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
                         (is_force ? "a force acts on a mass, but a motion belongs to a support"
                                   : "a support moves, a force acts on a mass"));
  if (found->record->jumps() || (found->record->of == RecordOf::velocity && found->record->steps())) {
    const std::string why = why_no_jump(network, network.excitations[excitation].node);
    if (!why.empty()) throw MechanicsError("record '" + found->record->name + "': " + why);
  }
  return *found->record;
}

}  // namespace

RecordCourse::RecordCourse(const mechanics::Network& network, std::span<const RecordedExcitation> records,
                           double until) {
  std::vector<const Record*> each;
  std::list<Record> lengthened;
  for (std::size_t k = 0; k < network.excitations.size(); ++k) {
    if (!mechanics::is_recorded(network.excitations[k].kind)) continue;
    const Record& record = record_of(network, k, records);
    each.push_back(record.is_corners ? &lengthened.emplace_back(held(record, until)) : &record);
  }
  for (const Record* record : each) {
    std::vector<double> once, all;
    std::ranges::unique_copy(record->time, std::back_inserter(once));
    std::ranges::set_union(times_, once, std::back_inserter(all));
    times_ = std::move(all);
  }
  const auto count = static_cast<Eigen::Index>(each.size()) * mechanics::kRecordNumbers;
  numbers_.assign(times_.size(), Eigen::VectorXd::Zero(count));
  jumps_.assign(times_.size(), 0);
  sizes_.setZero(count);
  for (std::size_t r = 0; r < each.size(); ++r) {
    const std::vector<double>& t = each[r]->time;
    const std::vector<Numbers> course = course_of(*each[r]);
    find_jumps(*each[r], course);
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

// Where a straight line has another slope than the one before it, where a motion begins with a velocity, and
// where corners step: of a force or an acceleration too, which change at once what holds a contact at rest.
void RecordCourse::find_jumps(const Record& record, std::span<const Numbers> course) {
  const auto jumps_at_time = [&](double time) {
    jumps_[static_cast<std::size_t>(std::ranges::lower_bound(times_, time) - times_.begin())] = 1;
  };
  for (std::size_t i = 1; i < record.time.size(); ++i) {
    if (record.steps_at(i)) jumps_at_time(record.time[i]);
  }
  if (record.of == RecordOf::force) return;
  double before = 0.0;  // [m/s]
  for (std::size_t i = 0; i < course.size(); ++i) {
    const double velocity = course[i][1];
    if ((i == 0 || record.jumps()) && velocity != before) jumps_at_time(record.time[i]);
    before = velocity;
  }
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
  if (record.is_corners) return true;
  if (record.of == RecordOf::velocity) return record.values.back() == 0.0;
  if (record.of != RecordOf::displacement) return true;
  const std::size_t last = record.time.size() - 1;
  if (record.jumps()) return record.values[last] == record.values[last - 1];
  return end_slope(&record.time[last], &record.values[last], -1) == 0.0;
}

std::vector<Reach> reaches(const Record& displacement) {
  const std::vector<Numbers> course = course_of(displacement);
  std::vector<Reach> all;
  for (std::size_t i = 0; i + 1 < course.size(); ++i) {
    const double start = displacement.time[i], h = displacement.time[i + 1] - start;
    Reach reach{course[i][0], start, course[i][0], start};
    const auto meet = [&](double s) {
      const double y = later(course[i], s)[0];
      if (y < reach.least) {
        reach.least = y;
        reach.least_at = start + s;
      }
      if (y > reach.most) {
        reach.most = y;
        reach.most_at = start + s;
      }
    };
    meet(h);
    // Where it turns: the roots of c + b s + a s^2, its slope.
    const double a = 0.5 * course[i][3], b = course[i][2], c = course[i][1];
    const double q = -0.5 * (b + std::copysign(std::sqrt(std::max(0.0, b * b - 4.0 * a * c)), b));
    for (const double s : {q / a, c / q}) {
      if (s > 0.0 && s < h) meet(s);
    }
    all.push_back(reach);
  }
  return all;
}

std::string why_no_spline(const Record& record) {
  if (!record.is_spline()) return "";
  const std::vector<double>&t = record.time, &y = record.values;
  const auto [least, most] = std::ranges::minmax(y);
  const std::vector<Reach> all = reaches(record);
  std::size_t worst = 0;
  double strays = 0.0, extreme = 0.0, when = 0.0;  // of all, the most
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto first = y.begin() + static_cast<std::ptrdiff_t>(i > 0 ? i - 1 : 0);
    const auto end = y.begin() + static_cast<std::ptrdiff_t>(std::min(i + 3, y.size()));
    const auto [low, high] = std::minmax_element(first, end);
    const auto look = [&](double by, double value, double at) {
      if (by <= strays) return;
      strays = by;
      worst = i;
      extreme = value;
      when = at;
    };
    look(*low - all[i].least, all[i].least, all[i].least_at);
    look(all[i].most - *high, all[i].most, all[i].most_at);
  }
  if (strays <= kStrays * (most - least)) return "";
  std::ostringstream text;
  text << "the cubic spline through its samples goes to " << extreme << " at " << when
       << " s, between sample " << worst + 1 << " (" << y[worst] << " at " << t[worst] << " s) and sample "
       << worst + 2 << " (" << y[worst + 1] << " at " << t[worst + 1]
       << " s), and leaves the range of the four samples around it by more than a quarter of the record's "
          "range, "
       << least << " to " << most
       << ": it does not represent them; use interpolation = \"linear\" for straight lines from sample to "
          "sample, or more samples where the motion turns";
  return text.str();
}

std::string inerter_on(const mechanics::Network& network, std::size_t support) {
  const mechanics::Node node{mechanics::NodeKind::prescribed, support};
  for (const mechanics::Element& element : network.elements) {
    if (element.type != mechanics::ElementType::inerter) continue;
    const bool hangs =
        std::ranges::any_of(element.along, [&](const mechanics::Share& share) { return share.node == node; });
    if (hangs) return element.name;
  }
  return "";
}

std::string why_no_jump(const mechanics::Network& network, std::size_t support) {
  const std::string inerter = inerter_on(network, support);
  if (inerter.empty()) return "";
  return "straight lines make the velocity of \"" + network.prescribed[support] +
         "\" jump at the samples, and the inerter \"" + inerter +
         "\" there would need an infinite force; leave out interpolation = \"linear\", or record a "
         "velocity "
         "or an acceleration";
}

}  // namespace frahm::transient
