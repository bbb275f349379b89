#include "solvers/transient/motion_measurement.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/coordinates.hpp"
#include "solvers/orbits/orbit.hpp"

namespace frahm::transient {
namespace {

using enum MotionMeasure;
using periodic::TraceKind;

constexpr std::size_t kNoTrace = static_cast<std::size_t>(-1);

std::optional<TraceKind> trace_of(MotionMeasure measure) {
  switch (measure) {
    case peak:
    case peak_time:
    case rms:
    case pseudo_velocity:
    case pseudo_acceleration:
    case stroke:
      return TraceKind::displacement;
    case velocity_peak:
    case velocity_rms:
      return TraceKind::velocity;
    case acceleration_peak:
      return TraceKind::acceleration;
    default:
      return std::nullopt;
  }
}

bool is_mean_square(MotionMeasure measure) {
  return measure == rms || measure == velocity_rms;
}

bool is_of_energy(MotionMeasure measure) {
  return measure == energy || measure == energy_share || measure == damping_energy ||
         measure == damping_energy_share || measure == initial_energy || measure == final_energy ||
         measure == energy_input || measure == energy_balance;
}

// Longest stretches in which the contact does not stick; one that only reverses goes on.
double slip_phases(const std::vector<Stop>& stops) {
  double phases = stops.empty() || stops.front().onset > 0.0 ? 1.0 : 0.0;
  for (const Stop& stop : stops) phases += std::isnan(stop.release) ? 0.0 : 1.0;
  return phases;
}

}  // namespace

bool MotionMeasurement::needs_energies(std::span<const MotionQuantity> quantities) {
  return std::ranges::any_of(quantities, [](const auto& each) { return is_of_energy(each.measure); });
}

MotionMeasurement::MotionMeasurement(const mechanics::Assembly& assembly,
                                     std::span<const MotionQuantity> quantities, bool of_run_up)
    : assembly_(assembly), quantities_(quantities), traces_(quantities.size(), kNoTrace) {
  for (std::size_t q = 0; q < quantities.size(); ++q) {
    const auto& [measure, index] = quantities[q];
    const auto kind = trace_of(measure);
    if (!kind) continue;
    const mechanics::Incidence at = measure == stroke
                                        ? assembly.incidences()[index]
                                        : mechanics::coordinate_incidence(assembly.network(), index);
    const bool jumps = of_run_up && *kind != TraceKind::displacement && at.p.size() > 0 && !at.p.isZero(0.0);
    if (!jumps) traces_[q] = largest_.add(*kind, at, is_mean_square(measure));
  }
}

double MotionMeasurement::number(const MotionQuantity& quantity, std::size_t trace,
                                 const Trajectory& trajectory, const EnergyBudget& budget,
                                 double own_frequency) const {
  const auto& [measure, index] = quantity;
  if (trace != kNoTrace) {
    if (is_mean_square(measure)) return std::sqrt(largest_.mean_square(trace));
    const Extremum& largest = largest_.largest(trace);
    const double size = std::abs(largest.displacement);
    // S_v = w S_d,  S_a = w^2 S_d  (A. K. Chopra, Dynamics of Structures, 4th ed., 6.6)
    if (measure == pseudo_velocity) return own_frequency * size;
    if (measure == pseudo_acceleration) return own_frequency * own_frequency * size;
    return measure == peak_time ? largest.time : size;
  }
  switch (measure) {
    case residual:
      return trajectory.displacement(index);
    case energy:
      return budget.dissipated[index];
    case energy_share:
      return budget.share[index];
    case slips:
      return slip_phases(trajectory.stops(assembly_.shares()[index].contact));
    case damping_energy:
      return budget.dissipated.back();
    case damping_energy_share:
      return budget.share.back();
    case initial_energy:
      return budget.initial;
    case final_energy:
      return budget.final;
    case energy_input:
      return budget.input;
    case energy_balance:
      return budget.balance;
    case status:
      return static_cast<double>(periodic::Status::ok);
    default:
      return kNone;
  }
}

std::vector<double> MotionMeasurement::numbers(const Trajectory& trajectory, const EnergyBudget& budget,
                                               double own_frequency) const {
  std::vector<double> result;
  for (std::size_t q = 0; q < quantities_.size(); ++q)
    result.push_back(number(quantities_[q], traces_[q], trajectory, budget, own_frequency));
  return result;
}

}  // namespace frahm::transient
