#include "solvers/transient/displacement_sensitivity.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/coordinates.hpp"
#include "solvers/mechanics/recorded_columns.hpp"
#include "solvers/mechanics/system_derivative.hpp"
#include "solvers/transient/motion_sensitivity.hpp"
#include "solvers/transient/record_course.hpp"

namespace frahm::transient {
namespace {

using Eigen::Index;
using mechanics::ExcitationKind, mechanics::LinearSystem, mechanics::Network, mechanics::NetworkValues;

// The masses that a coordinate has a share of.
std::vector<periodic::Observed> observed_of(const mechanics::Incidence& at) {
  std::vector<periodic::Observed> observed;
  for (Index i = 0; i < at.w.size(); ++i) {
    if (at.w[i] != 0.0) observed.push_back({.mass = i, .order = 0});
  }
  return observed;
}

// Whether the node's displacement has a share in the coordinate.
bool has_support(const mechanics::Incidence& at, std::size_t node) {
  return at.p.size() > 0 && at.p[static_cast<Index>(node)] != 0.0;
}

void check(const Network& network, std::span<const NetworkValues> along) {
  for (const mechanics::Excitation& each : network.excitations) {
    const bool is_constant = each.kind == ExcitationKind::force && each.order == 0;
    if (is_constant || mechanics::is_recorded(each.kind)) continue;
    throw mechanics::MechanicsError(
        "only constant forces may act together with records when the derivatives of a peak are requested");
  }
  if (std::ranges::any_of(along, [](const NetworkValues& each) { return each.omega != 0.0; }))
    throw mechanics::MechanicsError("a motion under records has no derivative with respect to a frequency");
}

// r at the time t, from the numbers of a record at an earlier one.
double record_at(const RecordCourse& course, std::size_t record, double t) {
  const std::vector<double>& times = course.times();
  const auto after = std::ranges::upper_bound(times, t);
  if (after == times.begin()) return 0.0;
  const auto i = static_cast<std::size_t>(after - times.begin()) - 1;
  const auto r = course.numbers(i).segment<mechanics::kRecordNumbers>(static_cast<Index>(record) *
                                                                      mechanics::kRecordNumbers);
  const double s = t - times[i];
  return r[0] + s * (r[1] + 0.5 * s * (r[2] + s / 3.0 * r[3]));
}

// Adds what supports have of a coordinate:  p A cos(phase) r(t), and its derivatives by A and phase.
void add_supports(const Network& network, const NetworkValues& values, std::span<const NetworkValues> along,
                  const mechanics::Incidence& at, const RecordCourse& course, std::span<const double> times,
                  DisplacementSensitivity& result) {
  std::size_t record = 0;
  for (std::size_t k = 0; k < network.excitations.size(); ++k) {
    const mechanics::Excitation& excitation = network.excitations[k];
    if (!mechanics::is_recorded(excitation.kind)) continue;
    const std::size_t number = record++;
    if (excitation.kind != ExcitationKind::recorded_motion || !has_support(at, excitation.node)) continue;
    const double share = at.p[static_cast<Index>(excitation.node)];
    const auto& [amplitude, phase, rod] = values.excitation[k];
    for (std::size_t i = 0; i < times.size(); ++i) {
      const double r = share * record_at(course, number, times[i]);
      result.displacement[static_cast<Index>(i)] += amplitude * std::cos(phase) * r;
      for (std::size_t d = 0; d < along.size(); ++d) {
        const mechanics::ExcitationValue& by = along[d].excitation[k];
        result.by(static_cast<Index>(i), static_cast<Index>(d)) +=
            (std::cos(phase) * by.amplitude - amplitude * std::sin(phase) * by.phase) * r;
      }
    }
  }
}

void set_system(const Network& network, const NetworkValues& values, std::span<const NetworkValues> along,
                const RecordCourse& course, MotionSensitivity& motion) {
  const mechanics::Assembly assembly(network);
  LinearSystem system;
  assembly.set_values(values, system);
  assembly.set_forcing(values, system);
  course.tell(system);
  std::vector<LinearSystem> by(along.size());
  for (std::size_t d = 0; d < by.size(); ++d)
    mechanics::differentiate(assembly, values, along[d], system, by[d]);
  motion.set_system(system, by);
}

// To `end` [s]. False: motion.failure() says why.
bool follow(const RecordCourse& course, double end, MotionSensitivity& motion) {
  const auto go = [&](double to) { return to <= motion.time() || motion.advance(to, 0.0, kInfinity); };
  const std::vector<double>& times = course.times();
  if (!go(std::min(times.front(), end))) return false;
  for (std::size_t i = 0; i < times.size() && times[i] < end; ++i) {
    motion.set_recorded(course.numbers(i), 0.0, course.jumps_at(i));
    if (!go(i + 1 < times.size() ? std::min(times[i + 1], end) : end)) return false;
  }
  return true;
}

}  // namespace

DisplacementSensitivity displacement_sensitivity(const Network& network, const NetworkValues& values,
                                                 std::span<const NetworkValues> along,
                                                 std::span<const RecordedExcitation> records,
                                                 std::size_t coordinate, std::span<const double> times,
                                                 const Watch& watch) {
  const mechanics::Incidence at = mechanics::coordinate_incidence(network, coordinate);
  if (at.has_joint())
    throw mechanics::MechanicsError(
        "the displacement of a joint without mass has no derivative under records");
  check(network, along);
  const RecordCourse course(network, records, times.back());
  const std::vector<periodic::Observed> observed = observed_of(at);
  std::vector<double> sampled{0.0};  // where the motion begins
  sampled.insert(sampled.end(), times.begin(), times.end());
  MotionSensitivity motion(observed, sampled, watch);
  set_system(network, values, along, course, motion);
  motion.start({}, std::vector<InitialState>(along.size()));
  DisplacementSensitivity result;
  if (follow(course, sampled.back(), motion) && sampled.back() > 0.0) motion.finish();
  if (motion.failure() != nullptr) {
    result.failure = motion.failure();
    return result;
  }
  const auto rows = static_cast<Index>(times.size()), columns = static_cast<Index>(along.size());
  if (columns > 0) result.why_none = motion.why_no_derivative();
  result.displacement.setZero(rows);
  result.by.setZero(rows, columns);
  for (std::size_t o = 0; o < observed.size() && sampled.back() > 0.0; ++o) {
    const double share = at.w[observed[o].mass];
    const auto column = static_cast<Index>(o);
    result.displacement += share * motion.motion().values.col(column).tail(rows);
    for (Index d = 0; d < columns; ++d)
      result.by.col(d) += share * motion.motion().by[static_cast<std::size_t>(d)].col(column).tail(rows);
  }
  add_supports(network, values, along, at, course, times, result);
  return result;
}

}  // namespace frahm::transient
