#include "studies/program/report_facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>

#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/rotation.hpp"
#include "studies/motion/crank_motion.hpp"
#include "studies/motion/one_motion.hpp"
#include "studies/program/report_profile.hpp"
#include "studies/reading/study/study_units.hpp"
#include "studies/tuning/optimum_columns.hpp"

namespace frahm::studies {
namespace {

// The study's excitation frequency [rad/s], from which the page knows the period.
results::Column excitation_frequency(const Study& study) {
  std::vector<double> parameters = study.parameters.nominal();
  mechanics::NetworkValues values;
  evaluate(study.values, study.parameters, parameters, values);
  return {.variable = {.name = "excitation_frequency",
                       .unit = study.dimensionless ? "1" : "rad s-1",
                       .long_name = "excitation frequency as the study states it"},
          .values = {values.omega}};
}

// What the unit of the run's frequency is in rad/s, which the page takes periods from; none of SI.
std::vector<results::Column> frequency_unit_in_si(const Study& study) {
  const UsualUnit unit = frequency_unit_in_file(study);
  if (unit.si_factor == 1.0) return {};
  return {{.variable = {.name = "frequency_unit",
                        .unit = unit.text,
                        .long_name = "unit of the excitation frequency in rad/s"},
           .values = {unit.si_factor}}};
}

// The number of elements that meet a condition.
template <class Condition>
results::Column number_of(const Study& study, const std::string& name, const Condition& holds) {
  const auto& elements = study.network.elements;
  const mechanics::NetworkValues values = motion_values(study);
  double number = 0.0;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const mechanics::ElementKind& kind = mechanics::kind_of(elements[e]);
    constexpr double any_frequency = 1.0;
    if (holds(kind, kind.adds(values.element[e], mechanics::second_value(values, e), any_frequency)))
      ++number;
  }
  return {.variable = {.name = name, .unit = "1", .long_name = "number of them in the study"},
          .values = {number}};
}

// Without a duration a free vibration is followed to its end, as far as it has one.
results::Column given_duration(const Study& study) {
  return {.variable = {.name = "given_duration",
                       .unit = "1",
                       .long_name = "whether the study says until when its motion is followed"},
          .values = {study.motion()->duration ? 1.0 : 0.0}};
}

// The page of a motion needs these to know whether the motion can end, and its period.
std::vector<results::Column> motion_facts(const Study& study) {
  using mechanics::ElementKind;
  using Added = mechanics::Added<double>;
  const auto rubs = [](const ElementKind&, const Added& added) { return added.limit != 0.0; };
  const auto hysteretic = [](const ElementKind& kind, const Added& added) {
    return kind.depends_on_frequency && added.stiffness != 0.0;
  };
  std::vector<results::Column> facts = {number_of(study, "rubbing_elements", rubs),
                                        number_of(study, "hysteretic_elements", hysteretic),
                                        given_duration(study)};
  if (study.kind() == StudyKind::transient) {
    facts.push_back(excitation_frequency(study));
    for (results::Column& unit : frequency_unit_in_si(study)) facts.push_back(std::move(unit));
  }
  return facts;
}

// The page calls them signals next to the masses, whose quantities they share.
std::vector<results::Text> names_of_signals(const Study& study) {
  std::vector<std::string> names;
  for (const mechanics::Signal& signal : study.network.signals) names.push_back(signal.name);
  return {{"signals", fmt::format("{}", fmt::join(names, ","))}};
}

// The parts of the band over which the limits of a tuning hold, for limits that name one, in the unit of the
// band.
std::vector<results::Column> limit_bands(const Study& study) {
  const TuneChoice& tune = *study.tune();
  const std::vector<NamedLimit> named = named_limits(study, 0.0);
  std::vector<results::Column> bands;
  for (std::size_t i = 0; i < tune.limits.size(); ++i) {
    if (!tune.limits[i].band || !tune.band) continue;
    const auto add = [&](const char* end, double value) {
      bands.push_back({.variable = {.name = named[i].name + "_band_" + end,
                                    .unit = "1",
                                    .long_name = "end of the part of the band over which the limit holds"},
                       .values = {value / tune.band->unit.si_factor}});
    };
    add("from", tune.limits[i].band->from);
    add("to", tune.limits[i].band->to);
  }
  return bands;
}

// Whether the response is in proportion to its excitation.
bool is_linear(const mechanics::Network& network) {
  return std::ranges::all_of(network.elements, [](const auto& each) { return mechanics::is_linear(each); });
}

// "force of 100 N on main", "motion of base, 0.0127 m"; where the amplitude follows the band it is reported
// so.
std::string component_text(const Study& study, std::size_t k, double at_start, double at_end) {
  const mechanics::Network& network = study.network;
  const mechanics::Excitation& each = network.excitations[k];
  const bool is_force =
      each.kind == mechanics::ExcitationKind::force || each.kind == mechanics::ExcitationKind::recorded_force;
  const std::string& node = is_force ? network.masses[each.node] : network.prescribed[each.node];
  const std::string what =
      fmt::format("{} {} {}", is_force ? "force" : "motion", is_force ? "on" : "of", node);
  if (mechanics::is_recorded(each.kind))
    return what + (at_start == 1.0 ? " as recorded" : fmt::format(" as recorded, times {:.6g}", at_start));
  const char* unit = study.dimensionless ? ""
                     : !is_force         ? each.kind == mechanics::ExcitationKind::belt ? " m/s" : " m"
                     : mechanics::rotates(network, each.node) ? " N m"
                                                              : " N";
  const std::string order = each.order > 1 ? fmt::format(", order {}", each.order) : "";
  const char* crank = each.kind == mechanics::ExcitationKind::crank ? " by a crank" : "";
  if (std::abs(at_end - at_start) <= 1e-12 * std::abs(at_start))
    return fmt::format("{}{}{}, {:.6g}{}", what, crank, order, at_start, unit);
  return fmt::format("{}{}{}, {:.6g} to {:.6g}{} over the band", what, crank, order, at_start, at_end, unit);
}

// The excitation of a scenario, or of the study itself where it sets nothing.
std::string excitation_with(const Study& study, std::span<const Assignment> set) {
  const auto amplitudes_at = [&](double band) {
    std::vector<double> parameters = study.parameters.nominal();
    for (const Assignment& each : set) parameters[each.parameter] = each.value;
    if (study.tune()->band) parameters[study.tune()->band->parameter] = band;
    mechanics::NetworkValues values;
    evaluate(study.values, study.parameters, parameters, values);
    return values.excitation;
  };
  const auto& band = study.tune()->band;
  const auto start = amplitudes_at(band ? band->range.from : 0.0),
             end = amplitudes_at(band ? band->range.to : 0.0);
  std::vector<std::string> components;
  for (std::size_t k = 0; k < start.size(); ++k)
    components.push_back(component_text(study, k, start[k].amplitude, end[k].amplitude));
  return fmt::format("{}", fmt::join(components, "; "));
}

// The excitation for which an optimum holds; of each scenario, where these differ in it. None where the
// response is in proportion to it.
std::vector<results::Text> excitation_of_optimum(const Study& study) {
  if (is_linear(study.network)) return {};
  std::vector<results::Text> texts;
  for (const ScenarioChoice& scenario : study.tune()->scenarios)
    texts.push_back({"excitation_" + scenario.name, excitation_with(study, scenario.set)});
  const auto differs = [&](const results::Text& each) { return each.second != texts.front().second; };
  if (std::ranges::any_of(texts, differs)) return texts;
  return {{"excitation", texts.empty() ? excitation_with(study, {}) : texts.front().second}};
}

}  // namespace

std::vector<results::PageGroup> report_facts(const Study& study) {
  std::vector<results::PageGroup> groups;
  if (std::vector<results::Column> cranks = crank_motions(study); !cranks.empty())
    groups.push_back({.name = "crank", .columns = std::move(cranks)});
  if (study.motion() && !study.map())
    groups.push_back({.name = "study", .columns = motion_facts(study), .texts = names_of_signals(study)});
  if (study.sweep() && study.sweep()->profile)
    groups.push_back(profile_group(study, *study.sweep()->profile));
  if (study.kind() == StudyKind::tune)
    groups.push_back({.name = "study", .columns = limit_bands(study), .texts = excitation_of_optimum(study)});
  return groups;
}

}  // namespace frahm::studies
