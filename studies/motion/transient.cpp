#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string_view>

#include "solvers/mechanics/coordinates.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "solvers/mechanics/rotation.hpp"
#include "studies/motion/driving_record_columns.hpp"
#include "studies/motion/energy_columns.hpp"
#include "studies/motion/motion_columns.hpp"
#include "studies/motion/one_motion.hpp"

namespace frahm::studies {
namespace {

using transient::ForcedMotion, transient::MotionMeasure, transient::Stop;

// The network's values at another frequency, set through its parameter if there is one.
mechanics::NetworkValues values_at(const Study& study, std::vector<double> parameters, double omega) {
  const auto running = study.values.omega.expression.sole_parameter();
  if (running && study.transient()->sweep_to) parameters[*running] = omega;
  mechanics::NetworkValues values;
  evaluate(study.values, study.parameters, parameters, values);
  values.omega = omega;
  return values;
}

// The stops of each element with a contact: those of its contact. Elements are in the order of the network.
struct StopsOfElement {
  std::string name;
  std::vector<Stop> stops;
};
std::vector<StopsOfElement> stops_of_elements(const Study& study, const ForcedMotion& motion) {
  const mechanics::Assembly assembly(study.network);
  std::vector<StopsOfElement> result;
  for (std::size_t e = 0; e < study.network.elements.size(); ++e) {
    const mechanics::Element& element = study.network.elements[e];
    if (!mechanics::has_own_contact(element)) continue;
    result.push_back({element.name, motion.stops[assembly.shares()[e].contact]});
  }
  return result;
}

// The times at which each gap's stops are touched, of both sides in their order.
struct TouchesOfGap {
  std::string name;
  std::vector<transient::Touch> touches;
};
std::vector<TouchesOfGap> touches_of_gaps(const Study& study, const ForcedMotion& motion) {
  std::vector<TouchesOfGap> result;
  std::size_t bend = 0;
  for (const mechanics::Element& element : study.network.elements) {
    TouchesOfGap of{element.name, {}};
    for (std::size_t i = 0; i < element.bends.size(); ++i, ++bend)
      of.touches.insert(of.touches.end(), motion.touches[bend].begin(), motion.touches[bend].end());
    if (element.type != mechanics::ElementType::gap) continue;
    std::ranges::sort(of.touches, {}, &transient::Touch::onset);
    result.push_back(std::move(of));
  }
  return result;
}

void add_touches(const Study& study, const ForcedMotion& motion, MotionColumns& columns) {
  const auto gaps = touches_of_gaps(study, motion);
  std::size_t rows = 1;
  for (const auto& gap : gaps) rows = std::max(rows, gap.touches.size());
  for (const auto& [name, touches] : gaps) {
    std::vector<double> onsets, ends;
    for (const transient::Touch& touch : touches) {
      onsets.push_back(touch.onset);
      ends.push_back(touch.end);
    }
    columns.add({"*_touch", name}, "s", "touch", onsets, rows);
    columns.add({"*_touch_end", name}, "s", "touch", ends, rows);
  }
}

void print_touches(const Study& study, const ForcedMotion& motion, std::ostream& out) {
  for (const auto& [name, touches] : touches_of_gaps(study, motion)) {
    fmt::print(out, "{}: {} contact{}{}\n", name, touches.size(), touches.size() == 1 ? "" : "s",
               touches.empty() ? ""
                               : fmt::format(", the last from {:.10g}{}", touches.back().onset,
                                             study.dimensionless ? "" : " s"));
  }
}

}  // namespace

transient::ForcedOptions forced_options(const Study& study) {
  return forced_options(study, study.parameters.nominal());
}

transient::ForcedOptions forced_options(const Study& study, std::span<const double> parameters) {
  const TransientChoice& motion = *study.transient();
  const auto at = [&](const StudyValue& value) { return value.expression.evaluate(parameters); };
  transient::ForcedOptions options{.from = at(study.values.omega), .samples = motion.samples};
  if (motion.sweep_to) {
    options.run_up = {at(*motion.sweep_to), at(*motion.sweep_rate)};
    if (options.run_up.to == options.from) {
      throw study.source.error_at(rules::wrong_order, motion.sweep_to->position,
                                  "{}: is also the frequency at which the motion begins; for one frequency "
                                  "leave out sweep_to and sweep_rate",
                                  motion.sweep_to->where);
    }
    options.duration = std::abs(options.run_up.to - options.from) / options.run_up.rate;
  }
  if (motion.duration) {
    options.duration = at(*motion.duration);
  } else if (!motion.sweep_to) {
    options.duration = end_of_records(motion.records);
  }
  return options;
}

ForcedMotion motion_at(const Study& study, std::span<const double> parameters, std::size_t record,
                       const transient::ForcedOptions& options) {
  const std::vector<double> here(parameters.begin(), parameters.end());
  transient::ForcedOptions driven = options;
  driven.records = driven_by(study.transient()->records, record);
  return transient::forced_motion(
      study.network, [&](double omega) { return values_at(study, here, omega); },
      initial_state(study, parameters), driven);
}

ForcedMotion solve_transient(const Study& study, const transient::Watch& watch) {
  transient::ForcedOptions options = forced_options(study);
  options.watch = watch;
  try {
    ForcedMotion motion = motion_at(study, study.parameters.nominal(), 0, options);
    if (!motion.failure.empty())
      throw StudyError(rules::not_computed, "{}",
                       study.source.name + ": the motion is not computed: " + motion.failure);
    return motion;
  } catch (const mechanics::MechanicsError& error) {
    throw StudyError(rules::not_computed, "{}", study.source.name + ": " + error.what());
  }
}

std::vector<results::Column> transient_columns(const Study& study, const ForcedMotion& motion) {
  MotionColumns columns(study);
  columns.add_samples(motion.history);
  add_driving_records(study, columns);
  if (study.transient()->sweep_to) {
    columns.add_frequencies("frequency", "time", motion.frequency);
    columns.add_quantity({MotionMeasure::discretisation_error}, motion.discretisation_error);
  }
  for (std::size_t i = 0; i < motion.peaks.size(); ++i) {
    columns.add_quantity({MotionMeasure::peak, i}, std::abs(motion.peaks[i].displacement));
    columns.add_quantity({MotionMeasure::peak_time, i}, motion.peaks[i].time);
  }
  add_energies(study, motion.energy, columns);
  const auto elements = stops_of_elements(study, motion);
  std::size_t rows = 1;
  for (const auto& element : elements) rows = std::max(rows, element.stops.size());
  for (const auto& [name, stops] : elements) {
    std::vector<double> onsets, releases;
    for (const Stop& stop : stops) {
      onsets.push_back(stop.onset);
      releases.push_back(stop.release);
    }
    columns.add({"*_stop_onset", name}, "s", "stop", onsets, rows);
    columns.add({"*_release", name}, "s", "stop", releases, rows);
  }
  add_touches(study, motion, columns);
  return columns.take();
}

// The unit of the displacements of all masses and signals; "" where some are angles and others are not.
static std::string_view common_unit(const Study& study) {
  const std::string_view first = mechanics::coordinate_unit(study.network, 0, "m");
  for (std::size_t i = 1; i < mechanics::coordinate_count(study.network); ++i)
    if (mechanics::coordinate_unit(study.network, i, "m") != first) return "";
  return first;
}

void print_transient(const Study& study, const ForcedMotion& motion, std::ostream& out) {
  const bool si = !study.dimensionless;
  const std::string_view common = common_unit(study);
  fmt::print(out, "{:<16}{:>18}{:>18}\n", "",
             si ? fmt::format("peak [{}]", common.empty() ? "SI" : common) : "peak", si ? "at [s]" : "at");
  for (std::size_t i = 0; i < motion.peaks.size(); ++i) {
    const std::string_view unit =
        si && common.empty() ? mechanics::coordinate_unit(study.network, i, "m") : std::string_view();
    fmt::print(out, "{:<16}{:>18.10g}{:>18.10g}{:>6}\n", mechanics::coordinate_name(study.network, i),
               std::abs(motion.peaks[i].displacement), motion.peaks[i].time, unit);
  }
  for (const auto& [name, stops] : stops_of_elements(study, motion)) {
    fmt::print(out, "{}: {} stop{}", name, stops.size(), stops.size() == 1 ? "" : "s");
    fmt::print(
        out, "{}\n",
        stops.empty() ? "" : fmt::format(", the last from {:.10g}{}", stops.back().onset, si ? " s" : ""));
  }
  print_touches(study, motion, out);
  print_energies(study, motion.energy, out);
  if (!study.transient()->sweep_to) return;
  const std::string unit = !si ? "" : common.empty() ? " m or rad" : fmt::format(" {}", common);
  fmt::print(out,
             "the run-up's frequency rises in {} steps: no displacement changes by more than {:.2g}{} with "
             "half as many\n",
             motion.stairs, motion.discretisation_error, unit);
}

}  // namespace frahm::studies
