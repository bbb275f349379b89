#include "studies/program/record_table.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>
#include <string>

#include "solvers/mechanics/rotation.hpp"
#include "solvers/transient/record_facts.hpp"
#include "studies/reading/quantities/units.hpp"

namespace frahm::studies {
namespace {

using transient::RecordFacts, transient::RecordOf;

constexpr std::size_t most_listed = 12;  // records of an axis: a screen
constexpr double drift = 0.05;           // of the largest velocity: what plots of a baseline show
constexpr double rounding = 1e-6;        // of times written with few digits

// A number with its unit, where the study has units.
std::string with_unit(const Study& study, double value, Quantity quantity) {
  return study.dimensionless ? fmt::format("{:.4g}", value)
                             : fmt::format("{:.4g} {}", value, written_si_unit(quantity));
}

// What stands between two samples.
const char* between_samples(const transient::Record& record) {
  return record.is_spline() ? "the cubic spline" : "straight lines";
}

struct Driven {
  std::string what;  // `acceleration of "base"`
  Quantity quantity = Quantity::force;
};
Driven driven_by(const Study& study, const DrivingRecord& driving, RecordOf of) {
  const std::size_t node = study.network.excitations[driving.excitation].node;
  const auto named = [&](const char* motion) {
    return fmt::format("{} of \"{}\"", motion, study.network.prescribed[node]);
  };
  switch (of) {
    case RecordOf::acceleration:
      return {named("acceleration"), Quantity::acceleration};
    case RecordOf::velocity:
      return {named("velocity"), Quantity::speed};
    case RecordOf::displacement:
      return {named("displacement"), Quantity::length};
    case RecordOf::force:
      break;
  }
  const bool turns = mechanics::rotates(study.network, node);
  return {
      fmt::format("{} on \"{}\"", turns ? "torque" : "force", mechanics::forced_node(study.network, node)),
      turns ? Quantity::torque : Quantity::force};
}

std::string interval_text(const Study& study, const RecordFacts& facts) {
  if (facts.even) return "every " + with_unit(study, facts.longest, Quantity::time);
  return fmt::format("uneven, {:.4g} to {}", facts.shortest, with_unit(study, facts.longest, Quantity::time));
}

// Whether integration leaves the support in motion.
bool drifts(const RecordFacts& facts) {
  return std::abs(facts.end_velocity) > drift * facts.peak_velocity;
}

void print_baseline(const Study& study, RecordOf of, const RecordFacts& facts, std::ostream& out) {
  if (of == RecordOf::acceleration)
    fmt::print(out, "           integrated: at the end {} (largest {}) and {} (largest {})\n",
               with_unit(study, facts.end_velocity, Quantity::speed),
               with_unit(study, facts.peak_velocity, Quantity::speed),
               with_unit(study, facts.end_displacement, Quantity::length),
               with_unit(study, facts.peak_displacement, Quantity::length));
  if (of == RecordOf::velocity)
    fmt::print(out, "           integrated: at the end {} (largest {})\n",
               with_unit(study, facts.end_displacement, Quantity::length),
               with_unit(study, facts.peak_displacement, Quantity::length));
}

void print_corners(const Study& study, const DrivingRecord& driving, std::ostream& out) {
  const transient::Record& record = driving.records.front();
  fmt::print(out, "corners    {}: {} to {}, straight lines between them; then the last value holds\n",
             driven_by(study, driving, record.of).what, record.time.size(),
             with_unit(study, record.time.back(), Quantity::time));
}

void print_one(const Study& study, const DrivingRecord& driving, std::ostream& out) {
  const transient::Record& record = driving.records.front();
  const auto [what, quantity] = driven_by(study, driving, record.of);
  const RecordFacts facts = transient::facts_of(record);
  fmt::print(out, "record     {} by {}: {} samples, {}, {}; {} between them\n", what, record.name,
             record.time.size(), interval_text(study, facts),
             with_unit(study, facts.duration, Quantity::time), between_samples(record));
  fmt::print(out, "           peak {} at {}; {:.4g} at its start, {:.4g} at its end\n",
             with_unit(study, facts.peak, quantity), with_unit(study, facts.peak_time, Quantity::time),
             facts.start, facts.end);
  print_baseline(study, record.of, facts, out);
}

// One line each, in SI.
void print_axis(const Study& study, const DrivingRecord& driving, std::ostream& out) {
  const auto [what, quantity] = driven_by(study, driving, driving.records.front().of);
  fmt::print(out, "records    {} by {} records of an axis{}\n", what, driving.records.size(),
             study.dimensionless ? "" : fmt::format(" (s, {}, m/s, m)", written_si_unit(quantity)));
  fmt::print(out, "           {:<24}{:>9}{:>11}{:>10}{:>11}{:>13}{:>13}\n", "", "samples", "interval",
             "duration", "peak", "end velocity", "end displ.");
  const std::size_t shown = std::min(driving.records.size(), most_listed);
  for (std::size_t i = 0; i < shown; ++i) {
    const transient::Record& record = driving.records[i];
    const RecordFacts facts = transient::facts_of(record);
    fmt::print(out, "           {:<24}{:>9}{:>11.4g}{:>10.4g}{:>11.4g}{:>13.4g}{:>13.4g}\n", record.name,
               record.time.size(), facts.longest, facts.duration, facts.peak, facts.end_velocity,
               facts.end_displacement);
  }
  if (shown < driving.records.size())
    fmt::print(out, "           and {} more\n", driving.records.size() - shown);
}

void warn_of_drift(const Study& study, const DrivingRecord& driving, std::ostream& out) {
  const auto drifting = std::ranges::count_if(
      driving.records, [](const auto& record) { return drifts(transient::facts_of(record)); });
  if (drifting == 0) return;
  const auto [what, quantity] = driven_by(study, driving, driving.records.front().of);
  fmt::print(out,
             "warning: {} by {}: the support keeps a velocity, more than {:.0f} % of its largest, when the "
             "record ends: its baseline is not corrected\n",
             what,
             driving.on_axis ? fmt::format("{} of {} records", drifting, driving.records.size())
                             : driving.records.front().name,
             100.0 * drift);
}

// Where samples are missing, the first such record of an axis.
void warn_of_gap(const Study& study, const DrivingRecord& driving, std::ostream& out) {
  for (const transient::Record& record : driving.records) {
    const RecordFacts facts = transient::facts_of(record);
    if (!transient::has_gap(facts)) continue;
    fmt::print(out,
               "warning: {} by {}: no sample from {:.6g} to {}, {:.0f} times its usual interval of {}; {} "
               "replaces them\n",
               driven_by(study, driving, record.of).what, record.name, facts.longest_from,
               with_unit(study, facts.longest_from + facts.longest, Quantity::time),
               facts.longest / facts.usual, with_unit(study, facts.usual, Quantity::time),
               record.is_spline() ? "the cubic spline" : "a straight line");
    return;
  }
}

// The interval of the samples, where some are missing the usual one.
double sampling_of(const transient::Record& record) {
  const RecordFacts facts = transient::facts_of(record);
  return transient::has_gap(facts) ? facts.usual : facts.longest;
}

// Where straight lines between samples drive the modes less than the record meant.
void warn_of_sampling(const Study& study, const DrivingRecord& driving, const periodic::LinearModes& modes,
                      std::ostream& out) {
  double longest = 0.0;
  const bool is_spline = driving.records.front().is_spline();
  for (const transient::Record& record : driving.records) longest = std::max(longest, sampling_of(record));
  const auto period = [](double omega) { return 2.0 * std::numbers::pi / omega; };
  const auto fast = std::ranges::find_if(modes.frequency, [&](double omega) {
    return omega > 0.0 && period(omega) < (1.0 - rounding) * transient::kSamplesOfPeriod * longest;
  });
  if (fast == modes.frequency.end()) return;
  const auto mode = fast - modes.frequency.begin() + 1;
  const bool is_last = mode == static_cast<std::ptrdiff_t>(modes.frequency.size());
  fmt::print(
      out,
      "{}: {}: mode {}{} (period {}) {} {:.2g} samples per period; {} between samples {} what drives it{}\n",
      mode == 1 ? "warning" : "note", driven_by(study, driving, driving.records.front().of).what, mode,
      is_last ? "" : " and those above", with_unit(study, period(*fast), Quantity::time),
      is_last ? "has" : "have", period(*fast) / longest, is_spline ? "the cubic spline" : "straight lines",
      is_spline ? "distorts" : "weaken", mode == 1 ? ": sample the record finer" : "");
}

}  // namespace

void print_records(const Study& study, const periodic::LinearModes& modes, std::ostream& out) {
  const auto& all = study.transient()->records;
  for (const DrivingRecord& driving : all) {
    if (driving.is_corners()) {
      print_corners(study, driving, out);
    } else if (driving.on_axis) {
      print_axis(study, driving, out);
    } else {
      print_one(study, driving, out);
    }
  }
  for (const DrivingRecord& driving : all) {
    if (driving.is_corners()) continue;
    warn_of_drift(study, driving, out);
    // A displacement by straight lines is a wish, of corners that are meant.
    if (driving.records.front().jumps()) continue;
    warn_of_gap(study, driving, out);
    warn_of_sampling(study, driving, modes, out);
  }
  if (!all.empty()) fmt::print(out, "\n");
}

}  // namespace frahm::studies
