#include "studies/tuning/sweep_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_units.hpp"
#include "studies/reading/study/toml_building.hpp"
#include "studies/reading/text/decimal_digits.hpp"
#include "studies/reading/text/toml_reading.hpp"
#include "studies/reading/text/toml_writing.hpp"

namespace frahm::studies {
namespace {

// The unit of a parameter in the sweep; empty for none.
std::string unit_of(const Study& study, std::size_t parameter) {
  return spoken_value(study, parameter, 0.0).unit;
}

TomlValue axis_of(const Study& study, std::size_t parameter, const std::vector<double>& values,
                  const std::string& zip) {
  TomlArray list;
  for (const double value : values) list.push_back(toml_number(value));
  TomlTable axis{{"parameter", {}, toml_string(study.parameters.list[parameter].name)}};
  const std::string unit = unit_of(study, parameter);
  if (!unit.empty()) axis.push_back({"unit", {}, toml_string(unit)});
  axis.push_back({"values", {}, {{}, std::move(list)}});
  if (!zip.empty()) axis.push_back({"zip", {}, toml_string(zip)});
  return {{}, std::move(axis)};
}

// The parameters that scenarios set, each as an axis of one zip; none where there are no scenarios.
void add_scenario_axes(const Study& study, TomlArray& axes) {
  const auto& scenarios = study.tune()->scenarios;
  std::vector<std::size_t> set;
  for (const ScenarioChoice& scenario : scenarios) {
    for (const Assignment& assignment : scenario.set) set.push_back(assignment.parameter);
  }
  std::sort(set.begin(), set.end());
  set.erase(std::unique(set.begin(), set.end()), set.end());
  std::string zip = "scenario";
  while (study.parameters.find(zip)) zip += "_";
  for (const std::size_t parameter : set) {
    std::vector<double> values;
    for (std::size_t s = 0; s < scenarios.size(); ++s)
      values.push_back(spoken_value(study, parameter, parameters_in_scenario(study, s)[parameter]).value);
    axes.push_back(axis_of(study, parameter, values, zip));
  }
}

// A schedule in SI. Its ends reach slightly beyond the band, because a value converted from one unit to
// another and back may be off by a rounding error.
std::string schedule_csv(const Study& study, const DesignChoice& design, const DesignCourse& course) {
  const auto& [values, knots] = course;
  constexpr double hair = 1e-9;
  const std::string& of = study.parameters.list[study.tune()->band->parameter].name;
  std::string csv = fmt::format("{},{}\n", of, study.parameters.list[design.parameter].name);
  const double reach = hair * (knots.back() - knots.front());
  csv += fmt::format("{},{}\n", knots.front() - reach, values.front());
  for (std::size_t k = 0; k < values.size(); ++k) csv += fmt::format("{},{}\n", knots[k], values[k]);
  return csv + fmt::format("{},{}\n", knots.back() + reach, values.back());
}

void set_parameters(const StoredTuning& stored, const std::string& stem, TomlTable& parameters,
                    SweepStudy& sweep) {
  const Study& study = stored.study;
  const auto put = [&](std::size_t parameter, TomlValue value) {
    entry_of(parameters, study.parameters.list[parameter].name)->value = std::move(value);
  };
  for (const Assignment& assignment : stored.overrides)
    put(assignment.parameter, toml_parameter(study, assignment.parameter, assignment.value));
  for (std::size_t i = 0; i < stored.design.size(); ++i) {
    const DesignChoice& design = study.tune()->designs[i];
    if (!design.is_scheduled()) {
      put(design.parameter, toml_parameter(study, design.parameter, stored.design[i].values.front()));
      continue;
    }
    const std::string& name = study.parameters.list[design.parameter].name;
    const std::string file = fmt::format("{}_{}.csv", stem, name);
    sweep.tables.emplace_back(file, schedule_csv(study, design, stored.design[i]));
    const std::string& of = study.parameters.list[study.tune()->band->parameter].name;
    put(design.parameter, {{}, TomlTable{{"table", {}, toml_string(file)}, {"of", {}, toml_string(of)}}});
  }
}

// What the tuning gave, on the band of the sweep; the signals among it are the tuning's own.
TomlValue output_of(const Study& study, const TomlEntry* output) {
  std::vector<std::string> names{study.tune()->quantity_name};
  for (const LimitChoice& limit : study.tune()->limits) names.push_back(limit.name);
  if (study.tune()->trade_off) names.push_back(study.tune()->trade_off->name);
  names.emplace_back("status");
  TomlArray list;
  for (auto name = names.begin(); name != names.end(); ++name) {
    if (std::find(names.begin(), name, *name) == name) list.push_back(toml_string(*name));
  }
  TomlTable table{{"quantities", {}, {{}, std::move(list)}}};
  if (output) table.push_back(*find_entry(output->value, "signal"));
  return {{}, std::move(table)};
}

// The study without what belongs to a tuning, of another kind, with the parameters of the optimum.
TomlValue tuned_study(const StoredTuning& stored, const char* kind, const std::string& stem,
                      SweepStudy& sweep) {
  TomlValue root = read_toml(stored.study.source);
  TomlTable& sections = std::get<TomlTable>(root.content);
  std::erase_if(sections, [](const TomlEntry& entry) {
    return entry.key == "tune" || entry.key == "design" || entry.key == "constraint" ||
           entry.key == "scenario" || entry.key == "column";
  });
  entry_of(std::get<TomlTable>(entry_of(sections, "study")->value.content), "kind")->value =
      toml_string(kind);
  set_parameters(stored, stem, std::get<TomlTable>(entry_of(sections, "parameters")->value.content), sweep);
  return root;
}

// From rest to the end of the band, slowly enough for most systems to show their steady response on the way;
// in the unit of the band.
TomlTable run_up_of(const Study& study, const BandChoice& band) {
  constexpr double kPeriods = 500.0;  // of the first frequency, that the band takes
  const double duration = kPeriods * 2.0 * std::numbers::pi / band.range.from;
  const double rate = (band.range.to - band.range.from) / duration / band.unit.si_factor;
  const std::string unit = unit_of(study, band.parameter);
  const TomlValue of_rate = unit.empty()      ? toml_number(to_digits(rate, 2))
                            : unit == "rad/s" ? toml_with_unit(to_digits(rate, 2), "rad/s2")
                                              : toml_with_unit(to_digits(rate, 2), unit + "/s");
  return {{"sweep_to", {}, toml_parameter(study, band.parameter, band.range.to)},
          {"sweep_rate", {}, of_rate},
          {"samples", {}, {{}, std::int64_t{2001}}}};
}

// A page of the sweep opens with what was tuned, where that is a peak or a stroke.
std::optional<TomlTable> report_of(const std::string& quantity) {
  for (const std::string_view ending : {"_peak", "_stroke"}) {
    if (quantity.ends_with(ending))
      return TomlTable{{"headline", {}, toml_string(quantity.substr(0, quantity.size() - ending.size()))}};
  }
  return std::nullopt;
}

}  // namespace

SweepStudy sweep_study(const StoredTuning& stored, const std::string& stem) {
  const Study& study = stored.study;
  if (!study.tune()->band || stored.band.empty())
    throw StudyError(rules::missing_key, "{}: a tuning without a band has no response to sweep",
                     study.source.name);
  SweepStudy sweep;
  TomlValue root = tuned_study(stored, "sweep", stem, sweep);
  TomlTable& sections = std::get<TomlTable>(root.content);
  TomlArray axes;
  add_scenario_axes(study, axes);
  axes.push_back(axis_of(study, study.tune()->band->parameter, stored.band, ""));
  sections.push_back({"axis", {}, {{}, std::move(axes)}});
  TomlValue output = output_of(study, find_entry(root, "output"));
  std::erase_if(sections, [](const TomlEntry& entry) { return entry.key == "output"; });
  sections.push_back({"output", {}, std::move(output)});
  if (auto report = report_of(study.tune()->quantity_name))
    sections.push_back({"report", {}, {{}, std::move(*report)}});
  sweep.text = fmt::format("{}\n{}", sweep_mark, toml_text(root));
  return sweep;
}

SweepStudy run_up_study(const StoredTuning& stored, const std::string& stem) {
  const Study& study = stored.study;
  const auto& band = study.tune()->band;
  if (!band || study.values.omega.expression.sole_parameter() != band->parameter ||
      !(band->range.from < band->range.to))
    throw StudyError(rules::unfit_for_method,
                     "{}: has no run-up: its band must be a range of the parameter that is the excitation's "
                     "frequency itself",
                     study.source.name);
  SweepStudy sweep;
  TomlValue root = tuned_study(stored, "transient", stem, sweep);
  TomlTable& sections = std::get<TomlTable>(root.content);
  entry_of(std::get<TomlTable>(entry_of(sections, "parameters")->value.content),
           study.parameters.list[band->parameter].name)
      ->value = toml_parameter(study, band->parameter, band->range.from);
  // For a tuning's output there are the signals alone, which a motion has too.
  std::erase_if(sections, [](const TomlEntry& entry) { return entry.key == "orbits"; });
  sections.push_back({"transient", {}, {{}, run_up_of(study, *band)}});
  TomlArray axes;
  add_scenario_axes(study, axes);
  if (!axes.empty()) sections.push_back({"axis", {}, {{}, std::move(axes)}});
  sweep.text = fmt::format("{}\n{}", run_up_mark, toml_text(root));
  return sweep;
}

}  // namespace frahm::studies
