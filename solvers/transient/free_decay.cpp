#include "solvers/transient/free_decay.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "solvers/periodic/observables.hpp"
#include "solvers/periodic/resonance.hpp"
#include "solvers/transient/trajectory.hpp"

namespace frahm::transient {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Passages are short, so that what counts as rest shrinks with the motion, and not in step with its half
// periods, so that stops do not fall between two passages.
constexpr double kPassagePeriods = 0.37;

// What is left of a creeping motion, of the energy norm it started with, when it counts as arrived.
constexpr double kArrived = 1e-12;

struct Decaying {
  mechanics::LinearSystem system;
  double lowest = 0.0;  // natural frequency [rad/s]
  bool all_damped = false;
};

Decaying set_up(const mechanics::Assembly& assembly, mechanics::NetworkValues& values) {
  Decaying decaying;
  const bool given = values.hysteretic_omega > 0.0;
  values.omega = 1.0;
  if (!given) values.hysteretic_omega = 1.0;
  assembly.set_values(values, decaying.system);
  std::vector<double> frequencies, damping;
  periodic::modes_of(decaying.system, frequencies, damping);
  decaying.lowest = values.omega = frequencies.front();
  if (!given) {
    values.hysteretic_omega = decaying.lowest;
    assembly.set_values(values, decaying.system);
  }
  assembly.set_forcing(values, decaying.system);
  decaying.all_damped = periodic::undamped_modes(decaying.system).empty();
  return decaying;
}

// Goes on beyond a given duration until it is clear how the motion ends.
DecayEnd march(const Decaying& decaying, double duration, Trajectory& trajectory) {
  const double period = 2.0 * std::numbers::pi / decaying.lowest, passage = kPassagePeriods * period;
  const double most = std::max(duration, kMostPeriods * period);
  const double start_norm = trajectory.energy_norm();
  while (trajectory.time() < most) {
    const double left = most - trajectory.time();
    // A phase has no meaning here: nothing is forced.
    if (!trajectory.advance(std::min(passage, left), 0.0)) return DecayEnd::failed;
    if (trajectory.is_at_rest()) return trajectory.has_crept() ? DecayEnd::creeping : DecayEnd::at_rest;
    const double distance = trajectory.distance_from_rest();
    // Still sliding, by less and less, where its own friction would hold it.
    if (trajectory.friction_slides() && distance <= kArrived * start_norm) return DecayEnd::creeping;
    const bool decayed = !trajectory.friction_slides() && distance <= kDecayed * start_norm;
    if (decayed && trajectory.time() >= duration)
      return trajectory.has_crept() ? DecayEnd::creeping : DecayEnd::decayed;
  }
  return DecayEnd::cut_off;
}

std::vector<double> log_decrements(const std::vector<Extremum>& extrema) {
  constexpr double kZero = 1e-12;  // of the largest: an extremum that is zero but for rounding
  double largest = 0.0;
  for (const Extremum& extremum : extrema) largest = std::max(largest, std::abs(extremum.displacement));
  std::vector<double> result(extrema.size(), kNone);
  for (std::size_t i = 0; i + 2 < extrema.size(); ++i) {
    const double before = std::abs(extrema[i].displacement), after = std::abs(extrema[i + 2].displacement);
    if (std::min(before, after) > kZero * largest) result[i] = std::log(before / after);
  }
  return result;
}

void tell_masses(const Trajectory& trajectory, bool tends_somewhere, FreeDecay& decay) {
  const Eigen::VectorXd rest = trajectory.tends_to();
  for (std::size_t i = 0; i < decay.masses.size(); ++i) {
    DecayOfMass& mass = decay.masses[i];
    for (const Extremum& extremum : trajectory.turning_points(i).extrema()) {
      if (extremum.time <= decay.duration * (1.0 + 1e-12)) mass.extrema.push_back(extremum);
    }
    mass.log_decrement = log_decrements(mass.extrema);
    mass.rest = tends_somewhere ? rest[static_cast<Eigen::Index>(i)] : kNone;
  }
}

double found_duration(const Decaying& decaying, const Trajectory& trajectory, DecayEnd end) {
  // Of a motion that never begins, one period.
  if (end == DecayEnd::at_rest && trajectory.held_since() == 0.0)
    return 2.0 * std::numbers::pi / decaying.lowest;
  return end == DecayEnd::at_rest ? trajectory.held_since() : trajectory.time();
}

}  // namespace

FreeDecay free_decay(const mechanics::Network& network, mechanics::NetworkValues values,
                     const InitialState& initial, const DecayOptions& options) {
  const mechanics::Assembly assembly(network);
  const Decaying decaying = set_up(assembly, values);
  FreeDecay decay;
  decay.hysteretic_omega = values.hysteretic_omega;
  decay.masses.resize(network.masses.size());

  Trajectory trajectory(assembly, {});
  trajectory.set_system(decaying.system, 0.0);
  trajectory.start(initial);
  decay.end = march(decaying, options.duration, trajectory);
  if (decay.end == DecayEnd::failed) decay.reason = trajectory.failure();
  decay.duration =
      options.duration > 0.0 ? options.duration : found_duration(decaying, trajectory, decay.end);
  const bool stopped = decay.end == DecayEnd::at_rest && trajectory.held_since() <= decay.duration;
  decay.stop_time = stopped ? trajectory.held_since() : kNone;
  const bool linear = assembly.contacts() == 0 || decaying.system.limit.isZero(0.0);
  const bool tends_somewhere =
      decay.end == DecayEnd::cut_off ? linear && decaying.all_damped : decay.end != DecayEnd::failed;
  tell_masses(trajectory, tends_somewhere, decay);
  if (options.samples == 0) return decay;

  Trajectory sampled(assembly, sample_times(decay.duration, options.samples));
  sampled.set_system(decaying.system, 0.0);
  sampled.start(initial);
  march(decaying, decay.duration, sampled);
  sampled.finish();
  decay.history = sampled.samples();
  return decay;
}

}  // namespace frahm::transient
