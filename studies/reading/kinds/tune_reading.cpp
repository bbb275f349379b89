#include "studies/reading/kinds/tune_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/reading/kinds/design_reading.hpp"
#include "studies/reading/kinds/tune_samples.hpp"
#include "studies/reading/kinds/tune_start.hpp"
#include "studies/reading/map/orbits_reading.hpp"
#include "studies/reading/quantities/parameters.hpp"
#include "studies/reading/study/parameter_reading.hpp"
#include "studies/reading/system/unfit_elements.hpp"
#include "studies/reading/text/spelling.hpp"

namespace frahm::studies {
namespace {

using periodic::Measure;
using tuning::Objective;

void read_objective(const TomlSection& section, TuneChoice& choice) {
  const std::string word = section.choice("objective");
  choice.objective = word == "minimax"       ? Objective::minimax
                     : word == "mean_square" ? Objective::mean_square
                                             : Objective::variance;
}

// Under white noise only the variance of the motion is known, and only for a linear system whose stiffness
// and damping are the same at all frequencies.
void check_variance(const TuneReading& reading, const TomlSection& section) {
  const Measure measure = reading.choice.quantity.measure;
  if (measure != Measure::rms && measure != Measure::stroke) {
    section.fail(rules::unfit_quantity, "quantity",
                 "\"{}\" has no variance; under white noise use <mass>_rms of a mass or <element>_stroke of "
                 "an element (its rms)",
                 reading.choice.quantity_name);
  }
  if (const mechanics::Element* unfit = mechanics::element_unfit_for_noise(reading.study.network)) {
    section.fail(rules::unfit_for_method, "objective",
                 "a variance needs a linear system under white noise, but element \"{}\" is a {}{}; write "
                 "\"minimax\" or \"mean_square\"",
                 unfit->name, mechanics::kind_of(*unfit).name, unfit->bends.empty() ? "" : " with a table");
  }
}

void read_noise(TuneReading& reading, const TomlSection& section) {
  const TomlValue* value = section.find("noise");
  const bool wanted = reading.choice.objective == Objective::variance;
  if (const auto& joints = reading.study.network.joints; wanted && !joints.empty())
    section.fail(rules::unfit_for_method, "objective",
                 "a variance needs a mass at every node, but \"{}\" is a joint without mass; give it one, or "
                 "write objective = \"mean_square\"",
                 joints.front());
  if (!value && wanted)
    section.fail_here(rules::missing_key,
                      "the key \"noise\" is missing: a variance needs noise = {{ force_on = \"<mass>\" }} or "
                      "{{ acceleration_of = \"<node>\" }}");
  if (!value) return;
  if (!wanted)
    section.fail(rules::beyond_schema(rules::key_without_use), "noise",
                 "belongs to objective = \"variance\"");
  const TomlSection noise(reading.context.source, *value, "[tune]: noise", "tune.noise");
  const bool force = noise.find("force_on") != nullptr;
  const auto& network = reading.study.network;
  const char* key = force ? "force_on" : "acceleration_of";
  const auto& names = force ? network.masses : network.prescribed;
  const std::string name = noise.text(key);
  const auto node = place_among(names, name);
  if (!node)
    noise.fail(rules::unknown_name, key, "{}",
               none_called(force ? "mass" : "node of prescribed motion", name, names));
  reading.choice.noise.kind = force ? tuning::NoiseKind::force_on : tuning::NoiseKind::acceleration_of;
  reading.choice.noise.node = *node;
  if (noise.find("intensity")) reading.choice.noise.intensity = noise.number("intensity");
}

// As with an axis, a range without a unit is SI, and refused if the parameter is given in another unit.
UsualUnit read_band_unit(const TuneReading& reading, const TomlSection& section, std::size_t parameter) {
  UsualUnit unit = read_parameter_unit(reading.context, section, reading.study, parameter);
  if (!section.find("unit") && unit.si_factor != 1.0) {
    section.fail_here(
        rules::missing_unit,
        "the parameter is given in \"{0}\", but its band has no unit; add unit = \"{0}\" or another",
        unit.text);
  }
  return unit;
}

// Where the frequency is a fixed number there is no parameter that a band could run over.
void refuse_fixed_frequency(const TuneReading& reading, const TomlSection& section, const char* key) {
  const Study& study = reading.study;
  if (!study.parameters.inputs_of(study.values.omega.expression.reads()).empty()) return;
  const std::string message =
      "the excitation's frequency is a fixed number, but a band runs over a parameter: write frequency = "
      "\"omega\", [parameters] omega = { value = 3, unit = \"Hz\" }, and band = { parameter = \"omega\", "
      "from = 3, to = 3, unit = \"Hz\" } for this one frequency";
  *key ? section.fail(rules::wrong_dependence, key, "{}", message)
       : section.fail_here(rules::beyond_schema(rules::missing_key), "the key \"band\" is missing: {}",
                           message);
}

void read_band(TuneReading& reading, const TomlSection& section) {
  const TomlValue* value = section.find("band");
  if (!value) return;
  refuse_fixed_frequency(reading, section, "band");
  const TomlSection band(reading.context.source, *value, "[tune]: band", "tune.band");
  BandChoice choice;
  choice.position = band.position();
  choice.parameter =
      read_number_parameter(band, reading.study.parameters, "parameter", "a band needs one that is a number");
  const Study& study = reading.study;
  const auto inputs = study.parameters.inputs_of(study.values.omega.expression.reads());
  if (std::find(inputs.begin(), inputs.end(), choice.parameter) == inputs.end()) {
    band.fail(rules::wrong_dependence, "parameter", "the excitation frequency does not depend on \"{}\"",
              study.parameters.list[choice.parameter].name);
  }
  choice.unit = read_band_unit(reading, band, choice.parameter);
  choice.range = read_range(band, choice.unit.si_factor);
  reading.choice.band = choice;
}

void require_band(const TuneReading& reading, const TomlSection& section) {
  const TuneChoice& choice = reading.choice;
  if (choice.band) return;
  if (choice.objective != Objective::variance) {
    refuse_fixed_frequency(reading, section, "");
    section.fail_here(rules::beyond_schema(rules::missing_key),
                      "the key \"band\" is missing: band = {{ parameter = \"omega\", from = 15.0, to = 35.0 "
                      "}}; one frequency is "
                      "from = to");
  }
  if (!choice.limits.empty())
    section.fail_here(rules::beyond_schema(rules::missing_key),
                      "the key \"band\" is missing: limits hold over a band of frequencies");
}

// White noise is of all frequencies: only limits, which are of harmonic responses, hold over a band.
void refuse_idle_band(const TuneReading& reading, const TomlSection& section) {
  const TuneChoice& choice = reading.choice;
  if (choice.objective != Objective::variance || !choice.band || !choice.limits.empty() || choice.trade_off)
    return;
  section.fail(rules::beyond_schema(rules::key_without_use), "band",
               "a variance under white noise covers all frequencies, and no limit needs this band; leave it "
               "out, or write objective = \"mean_square\", which covers the band");
}

void read_trade_off(TuneReading& reading, const TomlSection& section) {
  const TomlValue* value = section.find("trade_off");
  if (!value) return;
  const TomlSection table(reading.context.source, *value, "[tune]: trade_off", "tune.trade_off");
  TradeOffChoice trade_off;
  trade_off.quantity = read_real_quantity(reading, table, "quantity");
  trade_off.name = table.text("quantity");
  trade_off.unit = read_quantity_unit(reading, table, trade_off.quantity);
  for (const double limit : read_numbers(table, "values"))
    trade_off.limits.push_back(limit * trade_off.unit.si_factor);
  reading.choice.trade_off = std::move(trade_off);
}

// A weight is a function of the band alone, independent of design parameters and of scenarios.
void check_weight(const TuneReading& reading, const TomlSection& section) {
  const TuneChoice& choice = reading.choice;
  if (!choice.weight) return;
  if (choice.objective == Objective::variance)
    section.fail(rules::beyond_schema(rules::key_without_use), "weight",
                 "a variance has no weight over frequencies");
  const Parameters& parameters = reading.study.parameters;
  for (const std::size_t input : parameters.inputs_of(choice.weight->expression.reads())) {
    const bool designed = of_parameter(choice.designs, input);
    const bool set = std::ranges::any_of(choice.scenarios, [&](const ScenarioChoice& scenario) {
      return of_parameter(scenario.set, input) != nullptr;
    });
    if (designed || set)
      section.fail(rules::wrong_dependence, "weight",
                   "depends on \"{}\", which the {}; a weight may depend only on the band",
                   parameters.list[input].name, designed ? "tuning changes" : "scenarios change");
  }
}

void check_dominate(const TuneReading& reading, const TomlSection& section) {
  if (!section.find("dominate")) return;
  section.choice("dominate");
  if (!reading.choice.has_schedule())
    section.fail(rules::beyond_schema(rules::key_without_use), "dominate",
                 "needs a [[design]] with a schedule, which must be nowhere above its constant");
  if (std::ranges::any_of(reading.choice.designs, &DesignChoice::may_leap))
    section.fail(
        rules::beyond_schema(rules::key_without_use), "dominate",
        "cannot be combined with a schedule that jumps, because its jump is placed for the least worst peak");
}

}  // namespace

periodic::Quantity read_real_quantity(const TuneReading& reading, const TomlSection& section,
                                      const std::string& key) {
  const std::string name = section.text(key);
  const mechanics::Network& network = reading.study.network;
  const auto describe = [&](const periodic::Quantity& quantity) {
    return periodic::describe(quantity, network, reading.study.dimensionless);
  };
  const auto quantity = periodic::find_quantity(name, network);
  if (!quantity) {
    std::vector<std::string> known;
    for (const auto& each : periodic::all_quantities(network)) known.push_back(describe(each).name);
    section.fail(rules::unknown_name, key, "\"{}\" is not a quantity of the study{}", name,
                 suggestion(name, known));
  }
  if (describe(*quantity).kind != periodic::QuantityKind::real)
    section.fail(rules::unfit_quantity, key,
                 "\"{}\" is a count or a flag; a tuning needs a number that varies "
                 "continuously",
                 name);
  if (!periodic::is_differentiable(quantity->measure))
    section.fail(rules::unfit_quantity, key,
                 "\"{}\" has no derivative with respect to a design; a tuning needs one", name);
  return *quantity;
}

UsualUnit read_quantity_unit(const TuneReading& reading, const TomlSection& section,
                             const periodic::Quantity& quantity) {
  const auto description = periodic::describe(quantity, reading.study.network, reading.study.dimensionless);
  const TomlValue* value = section.find("unit");
  if (!value) return {description.unit, 1.0};
  const auto unit = read_unit(reading.context, section.where(), *value);
  if (!unit) return {"1", 1.0};
  const Unit own = reading.context.units.parse(description.unit);
  if (own.exponents != unit->exponents || unit->foreign)
    section.fail(rules::wrong_dimension, "unit", "\"{}\" is the unit of {}, but {} is in {}", unit->text,
                 dimension_name(*unit), description.name, description.unit);
  if (description.unit == si_unit(Quantity::angular_frequency))
    return {unit->text, si_factor(*unit, Quantity::angular_frequency)};
  return {unit->text, unit->scale / own.scale};
}

std::vector<double> read_numbers(const TomlSection& section, const std::string& key) {
  const TomlValue& list = section.require(key);
  const auto* items = list.as<TomlArray>();
  if (!items || items->empty())
    section.fail(rules::wrong_type, key, "expected an array of numbers, found {}",
                 items ? "an empty array" : described(list));
  std::vector<double> values;
  for (const TomlValue& item : *items)
    values.push_back(read_number(section.source(), fmt::format("{}: {}", section.where(), key), item));
  return values;
}

tuning::Band read_range(const TomlSection& section, double si_factor) {
  const double from = section.number("from"), to = section.number("to");
  if (!(from <= to))
    section.fail(rules::wrong_order, "to",
                 "{} is below \"from\" = {}; a band runs from the lower end to the upper", to, from);
  // Ends that rounding hardly tells apart are one frequency: no number lies between them to be scanned.
  constexpr double one_frequency = 1e-14;
  const bool is_one = to - from <= one_frequency * std::abs(to);
  return {from * si_factor, (is_one ? from : to) * si_factor};
}

StudyValue read_formula(const TuneReading& reading, const TomlSection& section, const std::string& key,
                        std::optional<WantedDimension> wanted) {
  const TomlValue& value = section.require(key);
  StudyValue formula;
  formula.where = fmt::format("{}: {}", section.where(), key);
  formula.position = value.position;
  formula.expression =
      read_expression(reading.context, reading.study.parameters, formula.where, value, std::move(wanted));
  return formula;
}

void read_tuning(const StudyContext& context, const TomlValue& root, Study& study) {
  refuse_smooth_laws(study, kind_noun(study.kind()));
  const TomlSection section(context.source, find_entry(root, "tune")->value, "[tune]", "tune", "band");
  TuneReading reading{context, root, study};
  TuneChoice& choice = reading.choice;
  refuse_samples(reading);
  read_objective(section, choice);
  if (choice.objective == Objective::mean_square) refuse_several_responses(study, "a mean square");
  if (choice.objective == Objective::variance) refuse_several_responses(study, "a variance");
  choice.orbits = read_orbits_wanted(context, root, study);
  choice.quantity = read_real_quantity(reading, section, "quantity");
  choice.quantity_name = section.text("quantity");
  if (choice.objective == Objective::variance) check_variance(reading, section);
  read_noise(reading, section);
  read_band(reading, section);
  read_start(section, choice);
  choice.tolerance = section.number("tolerance");
  read_trade_off(reading, section);
  read_designs(reading);
  choice.solver = read_solver(section, choice);
  check_map(reading, section);
  read_limits(reading);
  read_scenarios(reading);
  read_columns(reading);
  require_band(reading, section);
  if (section.find("weight")) choice.weight = read_formula(reading, section, "weight");
  check_weight(reading, section);
  refuse_idle_band(reading, section);
  check_dominate(reading, section);
  choice.dominate_constant = section.find("dominate") != nullptr;
  study.choice = std::move(choice);
}

bool TuneChoice::has_schedule() const {
  return std::any_of(designs.begin(), designs.end(),
                     [](const DesignChoice& design) { return design.is_scheduled(); });
}

}  // namespace frahm::studies
