#include "studies/reading/kinds/design_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/kinds/tune_reading.hpp"
#include "studies/reading/study/assignment_reading.hpp"
#include "studies/reading/study/dimension_check.hpp"
#include "studies/reading/study/parameter_reading.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/study/study_values.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {
namespace {

// A bound in the given unit, converted to SI; `otherwise` if absent.
double read_bound(const TomlSection& section, const char* key, double si_factor, double otherwise) {
  return section.find(key) ? section.number(key) * si_factor : otherwise;
}

void check_bounds(const TomlSection& section, double lower, double upper) {
  if (lower <= upper) return;
  section.fail(rules::wrong_order, "upper",
               "{} is below \"lower\" = {}; the upper bound must not be below the lower",
               section.number("upper"), section.number("lower"));
}

std::size_t read_design_parameter(const TuneReading& reading, const TomlSection& section) {
  const std::size_t parameter = read_number_parameter(section, reading.study.parameters, "parameter",
                                                      "a design parameter needs one that is a number");
  const std::string& name = reading.study.parameters.list[parameter].name;
  if (const auto* twice = of_parameter(reading.choice.designs, parameter))
    section.fail(rules::given_twice, "parameter", "\"{}\" is already a design parameter (line {})", name,
                 twice->position.line);
  if (runs_over_band(reading.choice, parameter))
    section.fail(rules::beyond_schema(rules::key_without_use), "parameter",
                 "\"{}\" runs over the band, so it cannot be tuned", name);
  if (!network_depends_on(reading.study, parameter))
    section.fail(rules::wrong_dependence, "parameter", "no value of the network depends on \"{}\"", name);
  return parameter;
}

std::vector<double> even_knots(const tuning::Band& band, std::size_t count) {
  std::vector<double> knots(count);
  for (std::size_t i = 0; i < count; ++i)
    knots[i] = std::lerp(band.from, band.to, static_cast<double>(i) / static_cast<double>(count - 1));
  knots.back() = band.to;
  return knots;
}

// Knots in the unit of the band: their number, evenly spaced, or their values.
std::vector<double> read_knots(const TomlSection& section, const BandChoice& band) {
  const TomlValue& value = section.require("knots");
  if (!value.as<TomlArray>()) {
    return even_knots(band.range, static_cast<std::size_t>(section.integer("knots")));
  }
  std::vector<double> knots = read_numbers(section, "knots");
  for (double& knot : knots) knot *= band.unit.si_factor;
  const auto falls = std::adjacent_find(knots.begin(), knots.end(), std::greater_equal<>());
  if (falls != knots.end())
    section.fail(rules::wrong_order, "knots",
                 "{} follows {}; knots must rise from one end of the band to the other",
                 falls[1] / band.unit.si_factor, falls[0] / band.unit.si_factor);
  if (knots.size() < 2 || knots.front() != band.range.from || knots.back() != band.range.to)
    section.fail(rules::wrong_order, "knots",
                 "the first and the last knot must be the ends of the band, {} and {}",
                 band.range.from / band.unit.si_factor, band.range.to / band.unit.si_factor);
  return knots;
}

// A jump is placed by a search over one schedule and one response at each point (solvers/tuning/stages,
// leap_place).
void read_jumps(const TuneReading& reading, const TomlSection& section, DesignChoice& design) {
  if (std::ranges::any_of(reading.choice.designs, &DesignChoice::may_leap))
    section.fail_here(rules::beyond_schema(rules::key_without_use),
                      "another schedule jumps, and a schedule that jumps must be the only one");
  if (!section.find("jumps")) return;
  design.may_leap = section.integer("jumps") == 1;
  if (!design.may_leap) return;
  if (reading.choice.objective != tuning::Objective::minimax)
    section.fail(rules::beyond_schema(rules::key_without_use), "jumps",
                 "needs objective = \"minimax\": the worst peak decides where a schedule jumps");
  if (tuning::may_take_several_orbits(reading.study.network))
    section.fail(
        rules::unfit_for_method, "jumps",
        "a system that may have several responses at one frequency has no grid on which to place a jump");
  if (reading.choice.has_schedule())
    section.fail(rules::beyond_schema(rules::key_without_use), "jumps",
                 "needs this to be the only schedule of the study");
}

// max_slope is in the unit of the bounds over that of the band.
void read_schedule(const TuneReading& reading, const TomlSection& section, DesignChoice& design) {
  const TomlValue* value = section.find("schedule");
  if (!value) return;
  const auto& band = reading.choice.band;
  if (reading.choice.peaks)
    section.fail(rules::beyond_schema(rules::key_without_use), "schedule",
                 "a tuning over records has no band for a schedule; leave out the schedule");
  if (reading.choice.objective == tuning::Objective::variance || !band)
    section.fail(rules::beyond_schema(rules::key_without_use), "schedule",
                 "a variance belongs to one system for all frequencies; leave out the schedule");
  if (!(band->range.from < band->range.to))
    section.fail(rules::beyond_schema(rules::key_without_use), "schedule",
                 "the band is a single frequency; leave out the schedule");
  const TomlSection schedule(reading.context.source, *value, fmt::format("{}: schedule", section.where()),
                             "design.schedule");
  design.knots = read_knots(schedule, *band);
  read_jumps(reading, schedule, design);
  if (!schedule.find("max_slope")) return;
  design.max_slope = schedule.number("max_slope") * design.unit.si_factor / band->unit.si_factor;
}

// A rule gives the parameter, so it has its dimension, where a unit tells it.
std::optional<WantedDimension> wanted_of_parameter(const Parameter& parameter) {
  const std::optional<Unit>& unit = parameter.unit ? parameter.unit : parameter.unit_of_range;
  if (!unit) return std::nullopt;
  return WantedDimension{*unit, fmt::format("\"{}\" is {}", parameter.name, dimension_with_unit(*unit))};
}

void read_design(TuneReading& reading, const TomlValue& table, std::size_t number) {
  const TomlSection section(reading.context.source, table,
                            label(table, "design", "parameter", "design", number), "design");
  DesignChoice design;
  design.position = section.position();
  design.parameter = read_design_parameter(reading, section);
  design.unit = read_parameter_unit(reading.context, section, reading.study, design.parameter);
  design.lower = section.number("lower") * design.unit.si_factor;
  design.upper = section.number("upper") * design.unit.si_factor;
  check_bounds(section, design.lower, design.upper);
  read_schedule(reading, section, design);
  if (section.find("rule")) {
    const Parameter& parameter = reading.study.parameters.list[design.parameter];
    design.rule = read_formula(reading, section, "rule", wanted_of_parameter(parameter));
  }
  reading.choice.designs.push_back(std::move(design));
}

void read_limit(TuneReading& reading, const TomlValue& table, std::size_t number) {
  const TomlSection section(reading.context.source, table,
                            label(table, "constraint", "quantity", "constraint", number), "constraint");
  LimitChoice limit;
  limit.quantity = read_real_quantity(reading, section, "quantity");
  limit.name = section.text("quantity");
  limit.unit = read_quantity_unit(reading, section, limit.quantity);
  limit.lower = read_bound(section, "lower", limit.unit.si_factor, limit.lower);
  limit.upper = read_bound(section, "upper", limit.unit.si_factor, limit.upper);
  check_bounds(section, limit.lower, limit.upper);
  if (const TomlValue* value = section.find("band")) {
    const TomlSection range(reading.context.source, *value, fmt::format("{}: band", section.where()),
                            "constraint.band");
    const auto& whole = reading.choice.band;  // if there is none, require_band() says so
    const UsualUnit unit = whole && range.find("unit")
                               ? read_parameter_unit(reading.context, range, reading.study, whole->parameter)
                               : whole.value_or(BandChoice{}).unit;
    limit.band = read_range(range, unit.si_factor);
  }
  reading.choice.limits.push_back(std::move(limit));
}

Assignment read_setting(const TuneReading& reading, const TomlSection& scenario, const TomlEntry& entry) {
  return read_assignment(
      reading.context, reading.study, scenario.where() + ": set", entry, [&](std::size_t parameter) {
        return of_parameter(reading.choice.designs, parameter) ? "it is tuned, so a scenario cannot set it"
               : runs_over_band(reading.choice, parameter)
                   ? "it runs over the band, so a scenario cannot set it"
                   : "";
      });
}

void read_scenario(TuneReading& reading, const TomlValue& table, std::size_t number) {
  const TomlSection section(reading.context.source, table,
                            label(table, "scenario", "name", "scenario", number), "scenario");
  ScenarioChoice scenario;
  scenario.name = section.identifier("name");
  for (const ScenarioChoice& other : reading.choice.scenarios) {
    if (other.name == scenario.name)
      section.fail(rules::name_taken, "name", "\"{}\" is already the name of an earlier scenario",
                   scenario.name);
  }
  const TomlValue& set = section.require("set");
  const auto* entries = set.as<TomlTable>();
  if (!entries)
    section.fail(rules::wrong_type, "set", "expected a table such as {{ FP = 0.1 }}, found {}",
                 described(set));
  for (const TomlEntry& entry : *entries) scenario.set.push_back(read_setting(reading, section, entry));
  reading.choice.scenarios.push_back(std::move(scenario));
}

void read_column(TuneReading& reading, const TomlValue& table, std::size_t number) {
  const TomlSection section(reading.context.source, table, label(table, "column", "name", "column", number),
                            "column");
  ColumnChoice column;
  column.name = section.identifier("name");
  std::optional<WantedDimension> wanted;
  if (const TomlValue* value = section.find("unit")) {
    if (const auto unit = read_unit(reading.context, section.where(), *value)) {
      column.unit = unit->text;
      column.si_factor = factor_of_label(reading.study.parameters, section.text("value"), *unit);
      wanted = wanted_by_label(*unit);
    }
  }
  column.value = read_formula(reading, section, "value", std::move(wanted));
  column.lower = read_bound(section, "lower", 1.0, column.lower);
  column.upper = read_bound(section, "upper", 1.0, column.upper);
  check_bounds(section, column.lower, column.upper);
  if (!reading.choice.band)
    section.fail_here(rules::beyond_schema(rules::key_without_use),
                      "a column accompanies the schedule over a band, but there is no band");
  reading.choice.columns.push_back(std::move(column));
}

// Reads each of the tables [[path]].
template <class Read>
void read_each(TuneReading& reading, const std::string& path, const Read& read) {
  std::size_t number = 0;
  for (const TomlValue* table : read_tables(reading.context.source, reading.root, path))
    read(reading, *table, ++number);
}

}  // namespace

bool network_depends_on(const Study& study, std::size_t parameter) {
  std::vector<std::size_t> reads = study.values.read_by_factors();  // refused in the end, by direction_of()
  reads.insert(reads.end(), study.values.omega.expression.reads().begin(),
               study.values.omega.expression.reads().end());
  for (const auto* list : study.values.lists()) {
    for (const StudyValue& value : *list)
      reads.insert(reads.end(), value.expression.reads().begin(), value.expression.reads().end());
  }
  const auto inputs = study.parameters.inputs_of(reads);
  return std::find(inputs.begin(), inputs.end(), parameter) != inputs.end();
}

void read_designs(TuneReading& reading) {
  read_each(reading, "design", read_design);
}

void read_limits(TuneReading& reading) {
  read_each(reading, "constraint", read_limit);
}

void read_scenarios(TuneReading& reading) {
  read_each(reading, "scenario", read_scenario);
}

void read_columns(TuneReading& reading) {
  read_each(reading, "column", read_column);
}

}  // namespace frahm::studies
