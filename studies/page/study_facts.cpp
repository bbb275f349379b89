#include "studies/page/study_facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>

#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/rotation.hpp"
#include "studies/motion/one_motion.hpp"
#include "studies/provenance/group_columns.hpp"
#include "studies/reading/study/series_text.hpp"
#include "studies/reading/study/study_units.hpp"
#include "studies/tuning/optimum_columns.hpp"

namespace frahm::studies {
namespace {

// Whether the motion can end, and its period.
std::vector<results::Column> motion_facts(const Study& study) {
  const mechanics::NetworkValues values = motion_values(study);
  int rubbing = 0, hysteretic = 0;
  for (std::size_t e = 0; e < study.network.elements.size(); ++e) {
    constexpr double any_frequency = 1.0;
    const mechanics::ElementKind& kind = mechanics::kind_of(study.network.elements[e]);
    const auto added = kind.adds(values.element[e], mechanics::second_value(values, e), any_frequency);
    if (added.limit != 0.0) ++rubbing;
    if (kind.depends_on_frequency && added.stiffness != 0.0) ++hysteretic;
  }
  GroupColumns facts;
  facts.add_number("rubbing_elements", "1", rubbing);
  facts.add_number("hysteretic_elements", "1", hysteretic);
  facts.add_number("given_duration", "1", study.motion()->duration ? 1.0 : 0.0);
  if (study.kind() == StudyKind::decay) return facts.take();
  facts.add_number({"excitation_frequency", {}, {"as the study states it"}},
                   study.dimensionless ? "1" : "rad s-1", values.omega);
  const UsualUnit unit = frequency_unit_in_file(study);
  if (unit.si_factor != 1.0) facts.add_number("frequency_unit", unit.text, unit.si_factor);
  return facts.take();
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
  GroupColumns bands;
  for (std::size_t i = 0; i < tune.limits.size(); ++i) {
    if (!tune.limits[i].band || !tune.band) continue;
    const UsualUnit& unit = tune.band->unit;
    bands.add_number({"*_band_from", named[i].name}, unit.text, tune.limits[i].band->from / unit.si_factor);
    bands.add_number({"*_band_to", named[i].name}, unit.text, tune.limits[i].band->to / unit.si_factor);
  }
  return bands.take();
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
  const std::string& node =
      is_force ? mechanics::forced_node(network, each.node) : network.prescribed[each.node];
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
  for (std::size_t k = 0; k < start.size(); ++k) {
    components.push_back(component_text(study, k, start[k].amplitude, end[k].amplitude));
    const auto begun = std::ranges::find(study.values.series, k, &PeriodSeries::first);
    if (begun == study.values.series.end() || begun->count < 2) continue;
    components.back() += fmt::format(" and {} higher orders of its period", begun->count - 1);
    k += begun->count - 1;
  }
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

results::GroupContent study_facts(const Study& study) {
  results::GroupContent facts{.path = "page/study"};
  if (study.motion() && !study.map()) {
    facts.columns = motion_facts(study);
    facts.texts = names_of_signals(study);
  } else if (study.kind() == StudyKind::tune) {
    facts.columns = limit_bands(study);
    facts.texts = excitation_of_optimum(study);
  }
  if (!study.values.series.empty())
    facts.texts.emplace_back("series", fmt::format("{}", fmt::join(series_texts(study.values), "\n")));
  return facts;
}

}  // namespace frahm::studies
