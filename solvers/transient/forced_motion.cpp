#include "solvers/transient/forced_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/coordinates.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/free_directions.hpp"
#include "solvers/transient/driven_motion.hpp"
#include "solvers/transient/motion_measurement.hpp"
#include "solvers/transient/record_course.hpp"
#include "solvers/transient/trajectory.hpp"

namespace frahm::transient {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr int kMostStairs = 1 << 20;  // of the finest staircase: a minute or so for a few masses

// Belts that are asked where they are, as records of a velocity 1 that their own multiplies.
struct FollowedBelts {
  mechanics::Network network;
  Record record;
};

FollowedBelts follow_belts(const mechanics::Network& network, double duration) {
  FollowedBelts followed{network,
                         {.name = "a constant velocity",
                          .of = RecordOf::velocity,
                          .time = {0.0, duration},
                          .values = {1.0, 1.0}}};
  for (mechanics::Excitation& each : followed.network.excitations) {
    if (each.kind == mechanics::ExcitationKind::belt) each.kind = mechanics::ExcitationKind::recorded_motion;
  }
  return followed;
}

// How the frequency runs: the time to its end, and phase and frequency until then.
struct Running {
  double from = 0.0, alpha = 0.0, time = 0.0;  // [rad/s], [rad/s^2], [s]

  double frequency(double t) const { return from + alpha * std::min(t, time); }
  double phase(double t) const { return (from + 0.5 * alpha * t) * t; }  // t <= time
};

Running running_of(const ForcedOptions& options) {
  if (options.run_up.rate == 0.0) return {.from = options.from};
  const double change = options.run_up.to - options.from;
  return {.from = options.from,
          .alpha = std::copysign(options.run_up.rate, change),
          .time = std::abs(change) / options.run_up.rate};
}

// At one frequency, period by period, so that the phase is exact however long the motion is.
bool keep_frequency(DrivenMotion& driven, double omega, double phase, double until) {
  const double period = kTurn / omega;
  driven.drive(omega, 0.0, phase);
  if (!driven.trajectory.can_last(until - driven.trajectory.time())) return false;
  while (driven.trajectory.time() < until) {
    const double left = until - driven.trajectory.time();
    // A rounding error of the last period is not a passage of its own.
    if (left <= 1e-12 * until) break;
    if (!driven.trajectory.advance(std::min(period, left), phase)) return false;
  }
  return true;
}

// Under records, from one of their times to the next, together with harmonics of one frequency.
bool follow_records(DrivenMotion& driven, double omega, const RecordCourse& course, double until) {
  const std::vector<double>& times = course.times();
  driven.drive(omega, 0.0, 0.0);
  if (!driven.trajectory.can_last(until)) return false;
  if (times.front() > 0.0 && !driven.trajectory.advance(std::min(times.front(), until), 0.0)) return false;
  for (std::size_t i = 0; i < times.size() && times[i] < until; ++i) {
    const double phase = std::remainder(omega * times[i], kTurn);
    const double end = i + 1 < times.size() ? std::min(times[i + 1], until) : until;
    driven.trajectory.set_recorded(course.numbers(i), phase, course.jumps_at(i));
    if (!driven.trajectory.advance(end - driven.trajectory.time(), phase)) return false;
  }
  return true;
}

// Through a range of frequencies on `count` stairs, to time `until` <= running.time. Start and end have their
// true frequency, half a stair from that of the first and the last stair, and the energies that belong to it.
bool climb(DrivenMotion& driven, const Running& running, double until, int count) {
  const double tau = until / count, lag = running.alpha * tau * tau / 12.0;
  driven.drive(running.from, running.alpha, 0.0);
  for (int i = 0; i < count; ++i) {
    const double start = tau * i;
    const double phase = std::remainder(running.phase(start) - lag, kTurn);
    driven.drive(running.frequency(start + 0.5 * tau), running.alpha, phase);
    driven.trajectory.set_frequency(running.frequency(start), running.alpha);
    if (!driven.trajectory.advance(tau, phase)) return false;
  }
  driven.drive(running.frequency(until), 0.0, std::remainder(running.phase(until), kTurn));
  return true;
}

struct Problem {
  const mechanics::Assembly& assembly;
  const ValuesAt& values_at;
  const InitialState& initial;
  const ForcedOptions& options;
  Running running;
  std::optional<RecordCourse> course = std::nullopt;
};

std::optional<RecordCourse> course_of(const mechanics::Network& network, const ForcedOptions& options) {
  if (!mechanics::has_records(network)) return std::nullopt;
  if (options.run_up.rate != 0.0)
    throw mechanics::MechanicsError("a run-up cannot also be driven by records");
  for (const RecordedExcitation& each : options.records) {
    if (options.duration <= each.record->time.back() || is_known_behind(*each.record)) continue;
    throw mechanics::MechanicsError("record '" + each.record->name +
                                    "': ends while its support moves, so the later motion is not known");
  }
  return RecordCourse(network, options.records, options.duration);
}

// The peaks of all coordinates: of a record, and of a run-up, which is refined until they stand.
class CoordinatePeaks {
 public:
  CoordinatePeaks(const mechanics::Network& network, LargestValues& largest) : largest_(largest) {
    for (std::size_t i = 0; i < mechanics::coordinate_count(network); ++i)
      numbers_.push_back(
          largest.add(periodic::TraceKind::displacement, mechanics::coordinate_incidence(network, i)));
  }
  std::vector<Extremum> found() const {
    std::vector<Extremum> peaks;
    for (const std::size_t number : numbers_) peaks.push_back(largest_.largest(number));
    return peaks;
  }

 private:
  const LargestValues& largest_;
  std::vector<std::size_t> numbers_;
};

// w = sqrt(K/M) of one mass, its contacts sliding; NaN of several.
double own_frequency(const Problem& problem) {
  if (problem.assembly.network().masses.size() != 1) return kNone;
  mechanics::LinearSystem system;
  problem.assembly.set_values(problem.values_at(problem.options.from), system);
  return std::sqrt(std::max(0.0, system.K(0, 0)) / system.M(0, 0));
}

// The motion with so many stairs, 0 for one frequency.
ForcedMotion follow(const Problem& problem, int stairs, EnergyDetail energies) {
  const ForcedOptions& options = problem.options;
  const Running& running = problem.running;
  const bool is_record = options.quantities.empty();
  MotionMeasurement measurement(problem.assembly, options.quantities, stairs > 0);
  std::optional<CoordinatePeaks> peaks;
  if (is_record || options.extrema || stairs > 0)
    peaks.emplace(problem.assembly.network(), measurement.largest());
  const Kept kept{
      .extrema = options.extrema, .energies = energies, .rest = false, .largest = &measurement.largest()};
  DrivenMotion driven(problem.assembly, problem.values_at, problem.initial,
                      problem.course ? &*problem.course : nullptr,
                      sample_times(options.duration, options.samples), options.watch, kept);
  if (stairs == 0) driven.trajectory.expect_many_steps();
  bool complete = true;
  double phase = 0.0;
  if (stairs > 0) {
    const double until = std::min(options.duration, running.time);
    complete = climb(driven, running, until, stairs);
    phase = std::remainder(running.phase(until), kTurn);
  }
  if (problem.course)
    complete = follow_records(driven, options.from, *problem.course, options.duration);
  else if (complete && options.duration > running.time * (1.0 + 1e-12))
    complete = keep_frequency(driven, running.frequency(running.time), phase, options.duration);
  ForcedMotion motion;
  motion.stairs = stairs;
  motion.discretisation_error = kNone;
  if (!complete) motion.failure = driven.trajectory.failure();
  if (complete) driven.trajectory.finish();
  if (energies != EnergyDetail::none) motion.energy = driven.trajectory.energy_budget();
  if (motion.failure.empty()) motion.failure = why_unbalanced(motion.energy);
  motion.history = driven.trajectory.samples();
  for (const double t : motion.history.time) motion.frequency.push_back(running.frequency(t));
  if (peaks) motion.peaks = peaks->found();
  if (complete)
    motion.numbers = measurement.numbers(driven.trajectory, motion.energy, own_frequency(problem));
  for (std::size_t i = 0; options.extrema && i < mechanics::coordinate_count(problem.assembly.network()); ++i)
    motion.extrema.push_back(driven.trajectory.turning_points(i).extrema());
  for (std::size_t j = 0; j < problem.assembly.contacts(); ++j)
    motion.stops.push_back(driven.trajectory.stops(j));
  for (std::size_t j = 0; j < problem.assembly.bends().law.size(); ++j)
    motion.touches.push_back(driven.trajectory.touches(j));
  return motion;
}

// The totals of the energies are cheap, and never more lenient than the account of each element, which alone
// decides where they miss.
ForcedMotion run(const Problem& problem, int stairs) {
  const ForcedOptions& options = problem.options;
  if (options.quantities.empty() || MotionMeasurement::needs_energies(options.quantities))
    return follow(problem, stairs, EnergyDetail::each);
  if (!options.weighed) return follow(problem, stairs, EnergyDetail::none);
  ForcedMotion motion = follow(problem, stairs, EnergyDetail::total);
  return why_unbalanced(motion.energy).empty() ? motion : follow(problem, stairs, EnergyDetail::each);
}

// The largest change of a sample or a peak of a mass [m].
double largest_change(const ForcedMotion& coarse, const ForcedMotion& fine, std::size_t masses) {
  double change = 0.0;
  for (std::size_t i = 0; i < masses; ++i) {
    change = std::max(
        change, std::abs(std::abs(coarse.peaks[i].displacement) - std::abs(fine.peaks[i].displacement)));
    const auto &a = coarse.history.displacement[i], &b = fine.history.displacement[i];
    for (std::size_t k = 0; k < b.size(); ++k) change = std::max(change, std::abs(a[k] - b[k]));
  }
  return change;
}

double largest_peak(const ForcedMotion& motion, std::size_t masses) {
  double largest = 0.0;
  for (std::size_t i = 0; i < masses; ++i)
    largest = std::max(largest, std::abs(motion.peaks[i].displacement));
  return largest;
}

// Stairs to begin with: a radian of the fastest excitation, and a phase that strays by a hundredth.
int first_stairs(const Problem& problem) {
  const Running& running = problem.running;
  const double until = std::min(problem.options.duration, running.time);
  const double radian = 1.0 / std::max(running.from, running.frequency(running.time));
  const double strays = std::sqrt(0.12 / std::abs(running.alpha));
  return static_cast<int>(std::clamp(until / std::min(radian, strays), 8.0, 0.25 * kMostStairs));
}

}  // namespace

double stepping_frequency(const mechanics::Assembly& assembly, const mechanics::NetworkValues& values,
                          const ForcedOptions& options) {
  constexpr double kSteps = 100.0;
  const auto& excitations = assembly.network().excitations;
  const bool oscillates = std::ranges::any_of(excitations, [](const auto& each) { return each.order > 0; });
  if (oscillates || assembly.matrices_depend_on_frequency() || !mechanics::has_free_masses(assembly, values))
    return options.from;
  return kSteps * periodic::kStepRate / options.duration;
}

bool asks_where_belts_are(const mechanics::Network& network) {
  const auto asks = [&](const mechanics::Element& element) {
    const mechanics::ElementKind& kind = mechanics::kind_of(element);
    return (kind.holds || kind.stop != nullptr) && mechanics::is_on_belt(network, element.along);
  };
  const auto is_on_one = [&](const mechanics::Signal& each) {
    return mechanics::is_on_belt(network, each.along);
  };
  return std::ranges::any_of(network.elements, asks) || std::ranges::any_of(network.signals, is_on_one);
}

ForcedMotion forced_motion(const mechanics::Network& network, const ValuesAt& values_at,
                           const InitialState& initial, const ForcedOptions& asked) {
  if (asks_where_belts_are(network)) {
    const FollowedBelts followed = follow_belts(network, asked.duration);
    ForcedOptions options = asked;
    for (std::size_t k = 0; k < network.excitations.size(); ++k) {
      if (network.excitations[k].kind == mechanics::ExcitationKind::belt)
        options.records.push_back({k, &followed.record});
    }
    return forced_motion(followed.network, values_at, initial, options);
  }
  const mechanics::Assembly assembly(network, mechanics::FreeMasses::allowed);
  ForcedOptions options = asked;
  options.from = stepping_frequency(assembly, values_at(asked.from), asked);
  const Problem problem{assembly, values_at,           initial,
                        options,  running_of(options), course_of(network, options)};
  if (problem.running.time == 0.0) return run(problem, 0);
  int stairs = first_stairs(problem);
  ForcedMotion coarse = run(problem, stairs);
  while (coarse.failure.empty()) {
    stairs *= 2;
    ForcedMotion fine = run(problem, stairs);
    if (!fine.failure.empty()) return fine;
    fine.discretisation_error = largest_change(coarse, fine, network.masses.size());
    for (std::size_t q = 0; q < options.quantities.size(); ++q) {
      if (options.quantities[q].measure == MotionMeasure::discretisation_error)
        fine.numbers[q] = fine.discretisation_error;
    }
    if (fine.discretisation_error <= kRunUpTolerance * largest_peak(fine, network.masses.size()) ||
        2 * stairs > kMostStairs)
      return fine;
    coarse = std::move(fine);
  }
  return coarse;
}

}  // namespace frahm::transient
