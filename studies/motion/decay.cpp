#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string_view>

#include "solvers/mechanics/coordinates.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "solvers/mechanics/modes.hpp"
#include "solvers/mechanics/rotation.hpp"
#include "solvers/response/periodic_response.hpp"
#include "studies/motion/energy_columns.hpp"
#include "studies/motion/motion_columns.hpp"
#include "studies/motion/one_motion.hpp"

namespace frahm::studies {
namespace {

using transient::DecayEnd, transient::Extremum, transient::FreeDecay;

std::string ending(const Study& study, const FreeDecay& decay) {
  const char* seconds = study.dimensionless ? "" : " s";
  const bool drifts = std::ranges::any_of(decay.masses, [](const auto& mass) { return mass.drift != 0.0; });
  const std::string left =
      fmt::format("the energy norm of its distance from {} is {:.3g} of the initial one",
                  drifts && decay.end != DecayEnd::cut_off ? "a steady drift" : "rest", decay.remainder);
  switch (decay.end) {
    case DecayEnd::at_rest:
      if (decay.stop_time == 0.0) return "at rest from the start";
      return std::isnan(decay.stop_time)
                 ? fmt::format("still moving after {:.10g}{}; it will come to rest", decay.duration, seconds)
                 : fmt::format("comes to rest at {:.10g}{}", decay.stop_time, seconds);
    case DecayEnd::creeping:
      // With less than critical damping friction stops it in the end, where it passes its rest by less than
      // rounding.
      return fmt::format(
          "creeps towards its rest position, or stops there within rounding; followed to {:.6g}{}, where {}",
          decay.duration, seconds, left);
    case DecayEnd::decayed:
      return fmt::format("never stops; after {:.6g}{} {}", decay.duration, seconds, left);
    case DecayEnd::cut_off:
      return fmt::format("still moving after {:.6g}{}; {}{}", decay.duration, seconds, left,
                         study.decay()->duration ? "" : "\nto follow it further, give [decay] a duration");
    case DecayEnd::failed:
      break;
  }
  return decay.reason;
}

}  // namespace

double stated(const Study& study, const StudyValue& value) {
  const std::vector<double> parameters = study.parameters.nominal();
  return value.expression.evaluate(std::span<const double>(parameters));
}

mechanics::NetworkValues motion_values(const Study& study) {
  mechanics::NetworkValues values;
  std::vector<double> parameters = study.parameters.nominal();
  evaluate(study.values, study.parameters, parameters, values);
  if (study.kind() != StudyKind::decay) return values;
  if (study.decay()->reference_frequency) {
    values.hysteretic_omega = stated(study, *study.decay()->reference_frequency);
    return values;
  }
  try {
    values.hysteretic_omega = 1.0;  // the natural frequencies do not depend on it
    values.hysteretic_omega =
        periodic::lowest_frequency(study.network, values, free_masses(study.kind(), study.network));
  } catch (const mechanics::MechanicsError& error) {
    throw StudyError(rules::not_computed, "{}", study.source.name + ": " + error.what());
  }
  return values;
}

transient::InitialState initial_state(const Study& study) {
  return initial_state(study, study.parameters.nominal());
}

transient::InitialState initial_state(const Study& study, std::span<const double> parameters) {
  const std::size_t n = study.network.masses.size();
  transient::InitialState state{std::vector<double>(n, 0.0), std::vector<double>(n, 0.0)};
  for (const InitialValues& initial : study.initial()) {
    state.displacement[initial.mass] = initial.displacement.expression.evaluate(parameters);
    state.velocity[initial.mass] = initial.velocity.expression.evaluate(parameters);
  }
  return state;
}

void check_duration(const Study& study, const mechanics::NetworkValues& values) {
  if (study.decay()->duration || !transient::has_no_end(study.network, values)) return;
  throw study.source.error_at(rules::beyond_schema(rules::missing_key), study.values.mass.front().position,
                              "no spring makes the masses oscillate, and no damper or friction brings them "
                              "to rest, so this decay has "
                              "no end of its own; give [decay] a duration (a time, s)");
}

FreeDecay solve_decay(const Study& study, const transient::Watch& watch) {
  const transient::DecayOptions options{
      .duration = study.decay()->duration ? stated(study, *study.decay()->duration) : 0.0,
      .samples = study.decay()->samples,
      .watch = watch};
  try {
    const mechanics::NetworkValues values = motion_values(study);
    check_duration(study, values);
    FreeDecay decay = transient::free_decay(study.network, values, initial_state(study), options);
    if (decay.end == DecayEnd::failed)
      throw StudyError(rules::not_computed, "{}",
                       study.source.name + ": the motion is not computed: " + decay.reason);
    return decay;
  } catch (const mechanics::MechanicsError& error) {
    throw StudyError(rules::not_computed, "{}", study.source.name + ": " + error.what());
  }
}

std::vector<results::Column> decay_columns(const Study& study, const FreeDecay& decay) {
  MotionColumns columns(study);
  std::size_t rows = 1;
  for (const auto& mass : decay.masses) rows = std::max(rows, mass.extrema.size());
  for (std::size_t i = 0; i < decay.masses.size(); ++i) {
    const std::string& name = mechanics::coordinate_name(study.network, i);
    const std::string_view unit = mechanics::coordinate_unit(study.network, i, "m");
    std::vector<double> times, values;
    for (const Extremum& extremum : decay.masses[i].extrema) {
      times.push_back(extremum.time);
      values.push_back(extremum.displacement);
    }
    columns.add({"*_extremum_time", name}, "s", "extremum", times, rows);
    columns.add({"*_extremum", name}, unit, "extremum", values, rows);
    columns.add({"*_log_decrement", name}, "1", "extremum", decay.masses[i].log_decrement, rows);
    columns.add_number({"*_rest", name}, unit, decay.masses[i].rest);
    if (decay.has_free_masses)
      columns.add_number({"*_drift", name}, mechanics::coordinate_unit(study.network, i, "m s-1"),
                         decay.masses[i].drift);
  }
  columns.add_number("stop_time", "s", decay.stop_time);
  columns.add_number("duration", "s", decay.duration);
  columns.add_frequencies("reference_frequency", "", {decay.hysteretic_omega});
  add_energies(study, decay.energy, columns);
  if (!decay.history.time.empty()) columns.add_samples(decay.history);
  return columns.take();
}

void print_decay(const Study& study, const FreeDecay& decay, std::ostream& out) {
  constexpr std::size_t most_rows = 12;
  fmt::print(out, "free decay: {}\n", ending(study, decay));
  for (std::size_t i = 0; i < decay.masses.size(); ++i) {
    const auto& [extrema, decrement, rest, drift] = decay.masses[i];
    const std::string_view unit = mechanics::coordinate_unit(study.network, i, "m");
    fmt::print(out, "\n{}: {} {}", mechanics::coordinate_name(study.network, i), extrema.size(),
               extrema.size() == 1 ? "extremum" : "extrema");
    if (!std::isnan(rest)) {
      const char* stopped = std::isnan(decay.stop_time) ? "will rest at" : "rests at";
      fmt::print(out, ", {} {:.10g}{}", decay.end == DecayEnd::at_rest ? stopped : "tends to", rest,
                 study.dimensionless ? "" : fmt::format(" {}", unit));
    } else if (std::abs(drift) > 0.0) {
      fmt::print(out, ", drifts on at {:.10g}{}", drift,
                 study.dimensionless ? "" : fmt::format(" {}/s", unit));
    }
    fmt::print(out, "\n{:>6}{:>18}{:>18}{:>16}\n", "", study.dimensionless ? "time" : "time [s]",
               study.dimensionless ? "extremum" : fmt::format("extremum [{}]", unit), "log decrement");
    for (std::size_t k = 0; k < std::min(most_rows, extrema.size()); ++k) {
      fmt::print(out, "{:>6}{:>18.10g}{:>18.10g}", k, extrema[k].time, extrema[k].displacement);
      fmt::print(out, "{}\n", std::isnan(decrement[k]) ? "" : fmt::format("{:>16.8g}", decrement[k]));
    }
    if (extrema.size() > most_rows) fmt::print(out, "{:>6}  and {} more\n", "", extrema.size() - most_rows);
  }
  print_energies(study, decay.energy, out);
}

}  // namespace frahm::studies
