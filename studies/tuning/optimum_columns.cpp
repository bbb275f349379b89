#include "studies/tuning/optimum_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solvers/algebra/no_value.hpp"
#include "studies/tuning/outcome_words.hpp"
#include "studies/tuning/tuned_design.hpp"
#include "studies/tuning/tuning_about.hpp"

namespace frahm::studies {
namespace {

// a per b: "m (N m-1)-1".
std::string per_unit(const std::string& a, const std::string& b) {
  if (b == "1") return a;
  return a == "1" ? fmt::format("({})-1", b) : fmt::format("{} ({})-1", a, b);
}

using results::Type;
using tuning::Optimum;

void add_numbers(const TuningAbout& about, GroupColumns& columns) {
  const std::string unit = objective_unit(about.study);
  columns.add_number("objective", unit, about.optimum.objective);
  if (about.tune.has_schedule()) {
    columns.add_number("constant_objective", unit, about.optimum.constant_objective);
    columns.add_number("path_bound", unit, about.optimum.path_bound);
  }
  columns.add_number("certificate_gap", "1", about.optimum.certificate_gap);
  if (const auto width = about.least_width_seen())
    columns.add_number("certificate_width", about.band_unit, *width);
  columns.add_number("kkt_residual", "1", about.optimum.kkt_residual);
  columns.add_number("tolerance", "1", about.tune.tolerance);
  columns.add_number("violation", "1", about.optimum.violation);
  columns.add_flag("outcome", "", outcome_words(), outcome_flags({about.optimum.outcome}));
  if (const auto& trade_off = about.tune.trade_off)
    columns.add_number({"trade_off", {}, {trade_off->name}}, trade_off->unit.text,
                       about.optimum.trade_off / trade_off->unit.si_factor);
  columns.add_count("iterations", "", {static_cast<double>(about.optimum.iterations)});
  columns.add("orbits", "1", "", {static_cast<double>(about.optimum.orbits)}, Type::int64);
  columns.add("gradients", "1", "", {static_cast<double>(about.optimum.gradients)}, Type::int64);
  columns.add_count("best_start", "",
                    {static_cast<double>(about.result.starts[about.result.best.back()].number)});
}

void add_design(const TuningAbout& about, GroupColumns& columns, std::size_t i) {
  const auto& [choice, name, unit] = about.designs[i];
  const double factor = choice.unit.si_factor;
  const std::string along = choice.is_scheduled() ? "knots_" + name : "";
  const bool known = has_design(about.study, about.optimum);
  const std::size_t size = choice.count();
  const auto spoken = [&](std::vector<double> values, double by) {
    values.resize(size, kNone);
    for (double& value : values) value *= by;
    return values;
  };
  const tuning::TunedParameter none;
  const tuning::TunedParameter& tuned = known ? about.optimum.parameters[i] : none;
  if (choice.is_scheduled()) {
    std::vector<double> knots;
    for (const double knot : tuned.knots.empty() ? choice.knots : tuned.knots)
      knots.push_back(about.spoken_band(knot));
    knots.resize(size, kNone);
    columns.add({"knots_*", name}, about.band_unit, along, knots);
  }
  columns.add(Named::by_study(name, "optimum of the parameter " + name), unit, along,
              spoken(tuned.value, 1.0 / factor));
  if (choice.may_leap) {
    const Jump jump = jump_of(choice, {tuned.value, tuned.knots}).value_or(Jump{kNone, kNone, kNone});
    columns.add_number({"*_jump_at", name}, about.band_unit, about.spoken_band(jump.at));
    columns.add_number({"*_jump_from", name}, unit, jump.from / factor);
    columns.add_number({"*_jump_to", name}, unit, jump.to / factor);
  }
  columns.add_number({"*_lower", name}, unit, choice.lower / factor);
  columns.add_number({"*_upper", name}, unit, choice.upper / factor);
  const double nominal = about.study.parameters.nominal()[choice.parameter];
  columns.add_number({"*_before", name}, unit, nominal / factor);
  if (std::isfinite(choice.max_slope))
    columns.add_number({"*_max_slope", name}, per_unit(unit, about.band_unit),
                       choice.max_slope * about.tune.band->unit.si_factor / factor);
  std::vector<double> at_bound;  // flags from 1
  for (const tuning::AtBound end : tuned.at_bound) at_bound.push_back(1.0 + static_cast<double>(end));
  at_bound.resize(size, 0.0);
  columns.add_flag({"*_at_bound", name}, along, {"no", "lower", "upper"}, at_bound);
  const std::string price = per_unit(objective_unit(about.study), unit);
  columns.add({"*_lower_multiplier", name}, price, along, spoken(tuned.lower_multiplier, factor));
  columns.add({"*_upper_multiplier", name}, price, along, spoken(tuned.upper_multiplier, factor));
  if (!about.tune.has_schedule()) return;
  const double constant = i < about.optimum.constant.size() ? about.optimum.constant[i] : kNone;
  columns.add_number({"*_constant", name}, unit, constant / factor);
}

// For a tuning over records: which record each peak is of, and what it was before.
void add_records_of_peaks(const TuningAbout& about, GroupColumns& columns) {
  std::vector<double> records, before;
  for (std::size_t i = 0; i < about.optimum.peaks.size(); ++i) {
    records.push_back(static_cast<double>(about.optimum.peaks[i].record));
    before.push_back(i < about.result.before.size() ? about.result.before[i].value : kNone);
  }
  columns.add_count("peak_record", "peak", records);
  columns.add("peak_before", quantity_unit(about.study), "peak", before);
}

void add_peaks(const TuningAbout& about, GroupColumns& columns) {
  std::vector<double> at, values, scenarios, multipliers;
  for (const tuning::Peak& peak : about.optimum.peaks) {
    at.push_back(about.spoken_band(peak.at));
    values.push_back(peak.value);
    scenarios.push_back(static_cast<double>(peak.scenario));
    multipliers.push_back(peak.multiplier);
  }
  if (at.empty()) return;
  const std::string unit = quantity_unit(about.study);
  columns.add({"peak_*", about.band}, about.band_unit, "peak", at);
  if (about.tune.peaks) add_records_of_peaks(about, columns);
  columns.add("peak_value", unit, "peak", values);
  columns.add_count("peak_scenario", "peak", scenarios);
  columns.add("peak_multiplier", "1", "peak", multipliers);
  for (std::size_t i = 0; i < about.designs.size(); ++i) {
    const double factor = about.designs[i].choice.unit.si_factor;
    std::vector<double> slopes;
    for (const tuning::Peak& peak : about.optimum.peaks)
      slopes.push_back(i < peak.sensitivity.size() ? peak.sensitivity[i] * factor : kNone);
    columns.add({"*_sensitivity", about.designs[i].name}, per_unit(unit, about.designs[i].unit), "peak",
                slopes);
  }
}

void add_limits(const TuningAbout& about, GroupColumns& columns) {
  const std::vector<NamedLimit> limits = named_limits(about.study, about.optimum.trade_off);
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const auto& [name, usual, lower, upper] = limits[i];
    const double factor = usual.si_factor;
    const std::string unit = usual.text;
    const bool known = i < about.optimum.limits.size();
    const tuning::LimitState state = known ? about.optimum.limits[i] : tuning::LimitState{};
    columns.add_number({"*_limited", name}, unit, known ? state.value / factor : kNone);
    columns.add_number({"*_lower_limit", name}, unit, std::isfinite(lower) ? lower / factor : kNone);
    columns.add_number({"*_upper_limit", name}, unit, std::isfinite(upper) ? upper / factor : kNone);
    columns.add_number({"*_limited_at", name}, about.band_unit, known ? about.spoken_band(state.at) : kNone);
    columns.add_count({"*_limited_scenario", name}, "", {known ? static_cast<double>(state.scenario) : -1.0});
    columns.add_number({"*_limit_excess", name}, "1", known ? state.excess : kNone);
    columns.add_number({"*_limit_multiplier", name}, per_unit(objective_unit(about.study), unit),
                       known ? state.multiplier * factor : kNone);
  }
}

void add_detuning(const TuningAbout& about, GroupColumns& columns) {
  const tuning::Detuning& detuning = about.result.assessment.detuning;
  if (detuning.change.empty()) return;
  columns.add("change", "1", "change", detuning.change);
  for (std::size_t i = 0; i < about.designs.size() && i < detuning.growth.size(); ++i)
    columns.add({"*_detuning", about.designs[i].name}, "1", "change", detuning.growth[i]);
}

void add_search(const TuningAbout& about, GroupColumns& columns) {
  if (not_proved(about.study).empty()) return;
  const tuning::SearchedPoints& searched = about.result.assessment.searched;
  columns.add_count("searched_points", "", {static_cast<double>(searched.points)});
  columns.add_count("several_points", "", {static_cast<double>(searched.several)});
  columns.add_count("not_periodic_points", "", {static_cast<double>(searched.not_periodic)});
}

void add_rounds(const TuningAbout& about, GroupColumns& columns) {
  std::vector<double> active, iterations, bound, worst, violation;
  for (const tuning::Round& round : about.optimum.rounds) {
    active.push_back(static_cast<double>(round.active));
    iterations.push_back(round.iterations);
    bound.push_back(round.bound);
    worst.push_back(round.worst);
    violation.push_back(round.violation);
  }
  if (active.empty()) return;
  const std::string unit = objective_unit(about.study);
  columns.add_count("round_active", "round", active);
  columns.add_count("round_iterations", "round", iterations);
  columns.add("round_bound", unit, "round", bound);
  columns.add("round_worst", unit, "round", worst);
  columns.add("round_violation", "1", "round", violation);
}

void add_starts(const TuningAbout& about, GroupColumns& columns) {
  const std::size_t limit = about.result.limits() - 1;
  std::vector<double> numbers, objectives, residuals;
  std::vector<tuning::Outcome> outcomes;
  for (const StartResult& start : about.result.starts) {
    numbers.push_back(static_cast<double>(start.number));
    objectives.push_back(start.optima[limit].objective);
    residuals.push_back(start.optima[limit].kkt_residual);
    outcomes.push_back(start.optima[limit].outcome);
  }
  columns.add_count("start", "start", numbers);
  columns.add("start_objective", objective_unit(about.study), "start", objectives);
  columns.add("start_kkt_residual", "1", "start", residuals);
  columns.add_flag("start_outcome", "start", outcome_words(), outcome_flags(outcomes));
  std::vector<const Optimum*> optima;
  for (const StartResult& start : about.result.starts) optima.push_back(&start.optima[limit]);
  const NamedKnot of_start = [](const std::string& knot, const std::string& what) {
    return Named("start_*", {knot}, {what});
  };
  add_designs(about, of_start, "start", optima, columns);
}

// For a tuning that began at a map: what of the box it saw, and what its low cells led to.
void add_map(const TuningAbout& about, GroupColumns& columns) {
  const tuning::DesignsSeen& seen = about.optimum.seen;
  if (seen.cells == 0) return;
  columns.add_count("map_cells", "", {static_cast<double>(seen.cells)});
  columns.add_number("map_share", "1", seen.share);
  columns.add("map_objective", objective_unit(about.study), "map_place", seen.polished);
}

}  // namespace

void add_designs(const TuningAbout& about, const NamedKnot& named, const std::string& dimension,
                 const std::vector<const Optimum*>& optima, GroupColumns& columns) {
  for (std::size_t i = 0; i < about.designs.size(); ++i) {
    const auto& [choice, name, unit] = about.designs[i];
    const std::size_t size = choice.count();
    for (std::size_t k = 0; k < size; ++k) {
      std::vector<double> values;
      for (const Optimum* optimum : optima)
        values.push_back(has_design(about.study, *optimum)
                             ? optimum->parameters[i].value[k] / choice.unit.si_factor
                             : kNone);
      const bool has_knots = choice.is_scheduled();
      columns.add(named(has_knots ? fmt::format("{}_{}", name, k) : name,
                        has_knots ? fmt::format("{} at knot {}", name, k) : name),
                  unit, dimension, values);
    }
  }
}

std::vector<results::Column> optimum_columns(const Study& study, const TuningResult& result) {
  const TuningAbout about(study, result);
  GroupColumns columns;
  add_numbers(about, columns);
  for (std::size_t i = 0; i < about.designs.size(); ++i) add_design(about, columns, i);
  add_peaks(about, columns);
  add_limits(about, columns);
  add_band(about, columns);
  add_detuning(about, columns);
  add_search(about, columns);
  add_rounds(about, columns);
  add_starts(about, columns);
  add_map(about, columns);
  return columns.take();
}

}  // namespace frahm::studies
