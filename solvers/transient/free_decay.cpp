#include "solvers/transient/free_decay.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "solvers/algebra/no_value.hpp"
#include "solvers/algebra/symmetric_modes.hpp"
#include "solvers/mechanics/coordinates.hpp"
#include "solvers/mechanics/free_directions.hpp"
#include "solvers/mechanics/joints.hpp"
#include "solvers/mechanics/undamped_resonance.hpp"
#include "solvers/quantities/observables.hpp"
#include "solvers/transient/trajectory.hpp"

namespace frahm::transient {
namespace {

// Passages are short, so that the limit of rest shrinks with the motion. Their length is no fraction of its
// half period, so that stops do not fall between two passages.
constexpr double kPassagePeriods = 0.37;

// The part of its initial energy norm at which a creeping motion counts as arrived.
constexpr double kArrived = 1e-12;

// [s]
double period_of(double rate) {
  return 2.0 * std::numbers::pi / rate;
}

// Times in which a motion changes: the shortest one, by which it is followed, and the longest [s]; infinite
// and 0: none.
struct Paces {
  double shortest = kInfinity, longest = 0.0;

  void add(double time) {
    shortest = std::min(shortest, time);
    longest = std::max(longest, time);
  }
  bool any() const { return longest > 0.0; }
};

struct Decaying {
  mechanics::LinearSystem system;
  Paces paces;
  bool all_damped = false;

  double period() const { return paces.shortest; }
  bool has_free_masses() const { return system.free_directions.cols() > 0; }
};

// Of masses that no spring holds or joins: those of the dampers, C phi = rate M phi, where Maxwell elements
// yield as dampers do, and of the contacts, that in which each would stop a motion of this energy [J].
Paces paces_of_stopping(const mechanics::LinearSystem& system, double energy) {
  constexpr double kNoRate = 1e-15;  // of the largest: rounding
  Paces paces;
  const Eigen::VectorXd dampers =
      (system.internal_rate.array() > 0.0)
          .select(system.internal_stiffness.cwiseQuotient(system.internal_rate), 0.0);
  Eigen::MatrixXd C = system.C + system.D * dampers.asDiagonal() * system.D.transpose();
  for (Eigen::Index j = 0; j < system.bends.count(); ++j) {
    if (system.bends.law[static_cast<std::size_t>(j)]->of_velocity)
      C += std::abs(system.bends.damping[j]) * system.bends.W.col(j) * system.bends.W.col(j).transpose();
  }
  const Eigen::VectorXd rates = algebra::symmetric_values(C, system.M);
  for (const double rate : rates)
    if (rate > kNoRate * rates.maxCoeff()) paces.add(period_of(rate));
  const Eigen::MatrixXd mobility = system.M.llt().solve(system.W);
  for (Eigen::Index j = 0; j < system.contacts(); ++j) {
    const double compliance = system.W.col(j).dot(mobility.col(j));
    if (system.limit[j] > 0.0)  // of a motion that never begins any time will do
      paces.add(energy > 0.0 ? std::sqrt(2.0 * energy / compliance) / system.limit[j] : 1.0);
  }
  return paces;
}

// The energy [J] of a start of masses that no spring holds: of their velocities, and of stops that are
// touched.
double energy_of(const mechanics::LinearSystem& system, const InitialState& initial) {
  const Eigen::Index n = system.masses();
  const auto vector = [&](const std::vector<double>& values) {
    if (static_cast<Eigen::Index>(values.size()) != n) return Eigen::VectorXd(Eigen::VectorXd::Zero(n));
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(values.data(), n));
  };
  const Eigen::VectorXd q = vector(initial.displacement), v = vector(initial.velocity);
  double energy = 0.5 * v.dot(system.M * v);
  for (Eigen::Index j = 0; j < system.bends.count(); ++j) {
    const double past = system.bends.W.col(j).dot(q) - system.bends.place[j];
    if (past > 0.0) energy += 0.5 * std::abs(system.bends.stiffness[j]) * past * past;
  }
  return energy;
}

// Where nothing oscillates the step is a part of the shortest of these times and of a given duration.
Paces paces_of(const mechanics::LinearSystem& system, double lowest, const InitialState& initial,
               double duration) {
  constexpr double kPart = 0.01;
  Paces paces;
  if (lowest > 0.0) {
    paces.add(period_of(lowest));
    return paces;
  }
  paces = paces_of_stopping(system, energy_of(system, initial));
  if (duration > 0.0) paces.add(kPart * duration);
  return paces;
}

Decaying set_up(const mechanics::Assembly& assembly, mechanics::NetworkValues& values,
                const InitialState& initial, double duration) {
  Decaying decaying;
  const bool given = values.hysteretic_omega > 0.0;
  values.omega = 1.0;
  if (!given) values.hysteretic_omega = 1.0;
  assembly.set_values(values, decaying.system);
  std::vector<double> frequencies, damping;
  periodic::modes_of(decaying.system, frequencies, damping);
  const double lowest = periodic::lowest_frequency(frequencies);
  decaying.paces = paces_of(decaying.system, lowest, initial, duration);
  if (!decaying.paces.any())
    throw mechanics::MechanicsError(
        "no spring makes the masses oscillate, and no damper or friction brings them to rest: the decay "
        "needs "
        "a duration");
  values.omega = lowest > 0.0 ? lowest : period_of(decaying.paces.shortest);
  if (!given) {
    values.hysteretic_omega = lowest;  // none: what has a loss factor has no stiffness
    if (lowest > 0.0) assembly.set_values(values, decaying.system);
  }
  assembly.set_forcing(values, decaying.system);
  decaying.all_damped = periodic::undamped_modes(decaying.system).empty();
  return decaying;
}

struct Ending {
  DecayEnd end = DecayEnd::cut_off;
  double remainder = kNone;  // FreeDecay::remainder
  EnergyBudget energy = {};
};

// [s] At most so far.
double last_time(double duration, double longest, double step) {
  const double steps = duration > 0.0 ? kStepsBeyond : kStepsByDefault;
  return std::max(duration, std::min(kMostPeriods * longest, duration + steps * step));
}

bool has_reached(const Trajectory& trajectory, double time) {
  constexpr double kRounding = 1e-12;
  return trajectory.time() >= time * (1.0 - kRounding);
}

// The end of the motion, if it is recognised; `left`: remaining part of the energy norm at the start.
std::optional<DecayEnd> seen_end(const Trajectory& trajectory, double left) {
  if (trajectory.is_at_rest()) return trajectory.has_crept() ? DecayEnd::creeping : DecayEnd::at_rest;
  // The contact still slides ever less where its own friction would hold it.
  if (trajectory.friction_slides()) {
    if (left <= kArrived) return DecayEnd::creeping;
  } else if (left <= kDecayed && trajectory.goes_on_freely()) {
    return trajectory.has_crept() ? DecayEnd::creeping : DecayEnd::decayed;
  }
  return std::nullopt;
}

// Follows the motion to a given duration, and beyond it for a while until it is clear how it ends.
Ending march(const Decaying& decaying, double duration, Trajectory& trajectory) {
  const double period = decaying.period();
  const double last = last_time(duration, decaying.paces.longest, trajectory.step());
  Ending ending{.energy = trajectory.energy_budget()};
  // What holds free masses at stops has energy too.
  const double start_norm =
      decaying.has_free_masses() ? std::sqrt(ending.energy.initial) : trajectory.energy_norm();
  while (!has_reached(trajectory, last)) {
    const bool within = !has_reached(trajectory, duration) || duration == 0.0;
    const double next = within && duration > 0.0 ? duration : last;
    // The phase has no meaning here: there is no excitation.
    if (!trajectory.advance(std::min(kPassagePeriods * period, next - trajectory.time()), 0.0)) {
      ending.end = within ? DecayEnd::failed : DecayEnd::cut_off;
      return ending;
    }
    if (within) ending.energy = trajectory.energy_budget();
    if (start_norm == 0.0) {
      ending.end = DecayEnd::at_rest;
      return ending;
    }
    const double left = trajectory.distance_from_rest() / start_norm;
    if (within) ending.remainder = left;
    const std::optional<DecayEnd> end = seen_end(trajectory, left);
    if (!end) continue;
    ending.end = *end;
    const bool gone = !decaying.has_free_masses() && !trajectory.friction_slides() && left <= kGone;
    if (gone) trajectory.come_to_rest();
    const bool settled = trajectory.friction_slides() || trajectory.is_at_rest();
    if (settled || gone || has_reached(trajectory, duration)) return ending;
    ending.end = DecayEnd::cut_off;
  }
  return ending;
}

// The same motion once more, to a duration that was already computed in full.
Samples history(const Decaying& decaying, const mechanics::Assembly& assembly, const InitialState& initial,
                double duration, const DecayOptions& options) {
  Trajectory trajectory(assembly, sample_times(duration, options.samples), options.watch);
  trajectory.set_system(decaying.system, 0.0);
  trajectory.start(initial);
  while (!has_reached(trajectory, duration) && !trajectory.is_at_rest()) {
    const double left = duration - trajectory.time();
    if (!trajectory.advance(std::min(kPassagePeriods * decaying.period(), left), 0.0)) break;
  }
  trajectory.finish();
  return trajectory.samples();
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

// Whether free masses have a share in a coordinate.
bool is_free(const mechanics::LinearSystem& system, const Eigen::VectorXd& w) {
  constexpr double kRounding = 1e-12;
  const Eigen::MatrixXd& R = system.free_directions;
  for (Eigen::Index k = 0; k < R.cols(); ++k)
    if (std::abs(w.dot(R.col(k))) > kRounding * w.cwiseAbs().dot(R.col(k).cwiseAbs())) return true;
  return false;
}

void tell_masses(const mechanics::Network& network, const mechanics::LinearSystem& system,
                 const Trajectory& trajectory, bool tends_somewhere, FreeDecay& decay) {
  constexpr double kRounding = 1e-13;
  const auto n = static_cast<Eigen::Index>(network.masses.size());
  const Eigen::VectorXd end = trajectory.tends_to(), rest = end.head(n);
  const Eigen::VectorXd velocity = end.segment(n, n) / trajectory.step();
  for (std::size_t i = 0; i < decay.masses.size(); ++i) {
    DecayOfMass& mass = decay.masses[i];
    for (const Extremum& extremum : trajectory.turning_points(i).extrema()) {
      if (extremum.time <= decay.duration * (1.0 + 1e-12)) mass.extrema.push_back(extremum);
    }
    const Eigen::VectorXd w = mechanics::at_rest(system, mechanics::coordinate_incidence(network, i));
    mass.log_decrement =
        is_free(system, w) ? std::vector<double>(mass.extrema.size(), kNone) : log_decrements(mass.extrema);
    mass.drift = tends_somewhere ? w.dot(velocity) : kNone;
    if (std::abs(mass.drift) <= kRounding * w.cwiseAbs().dot(velocity.cwiseAbs())) mass.drift = 0.0;
    mass.rest = mass.drift == 0.0 ? w.dot(rest) : kNone;
  }
}

// [s]; NaN: some mass is not held, and not everything has been at rest from the start.
double rest_since(const Trajectory& trajectory, const Ending& ending) {
  return std::isnan(ending.remainder) ? 0.0 : trajectory.held_since();
}

double found_duration(const Decaying& decaying, const Trajectory& trajectory, const Ending& ending) {
  if (ending.end != DecayEnd::at_rest) return trajectory.time();
  const double rest = rest_since(trajectory, ending);
  return rest == 0.0 ? decaying.period() : rest;  // of a motion that never begins, one period
}

}  // namespace

bool has_no_end(const mechanics::Network& network, const mechanics::NetworkValues& values) {
  const mechanics::Assembly assembly(network, mechanics::FreeMasses::allowed);
  mechanics::NetworkValues here = values;
  if (!(here.hysteretic_omega > 0.0)) here.hysteretic_omega = 1.0;
  mechanics::LinearSystem system;
  assembly.set_values(here, system);
  std::vector<double> frequencies, damping;
  periodic::modes_of(system, frequencies, damping);
  return !(periodic::lowest_frequency(frequencies) > 0.0) && !paces_of_stopping(system, 0.0).any();
}

FreeDecay free_decay(const mechanics::Network& network, mechanics::NetworkValues values,
                     const InitialState& initial, const DecayOptions& options) {
  const mechanics::Assembly assembly(network, mechanics::FreeMasses::allowed);
  const Decaying decaying = set_up(assembly, values, initial, options.duration);
  FreeDecay decay;
  decay.has_free_masses = decaying.has_free_masses();
  decay.hysteretic_omega = values.hysteretic_omega;
  decay.masses.resize(mechanics::coordinate_count(network));

  const bool given = options.duration > 0.0;
  Trajectory trajectory(assembly, sample_times(options.duration, given ? options.samples : 0), options.watch);
  trajectory.set_system(decaying.system, 0.0);
  trajectory.start(initial);
  const Ending ending = march(decaying, options.duration, trajectory);
  decay.end = ending.end;
  decay.remainder = ending.remainder;
  decay.energy = ending.energy;
  if (decay.end == DecayEnd::failed) {
    decay.reason = trajectory.failure();
  } else if (decay.reason = why_unbalanced(decay.energy); !decay.reason.empty()) {
    decay.end = DecayEnd::failed;
  }
  decay.duration = given ? options.duration : found_duration(decaying, trajectory, ending);
  const double rest = decay.end == DecayEnd::at_rest ? rest_since(trajectory, ending) : kNone;
  decay.stop_time = rest <= decay.duration ? rest : kNone;
  const bool linear =
      assembly.bends().count() == 0 && (assembly.contacts() == 0 || decaying.system.limit.isZero(0.0));
  const bool tends_somewhere =
      decay.end == DecayEnd::cut_off ? linear && decaying.all_damped : decay.end != DecayEnd::failed;
  tell_masses(network, decaying.system, trajectory, tends_somewhere, decay);
  if (options.samples == 0 || decay.end == DecayEnd::failed) return decay;
  trajectory.finish();
  decay.history =
      given ? trajectory.samples() : history(decaying, assembly, initial, decay.duration, options);
  return decay;
}

}  // namespace frahm::transient
