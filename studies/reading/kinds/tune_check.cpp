#include "studies/reading/kinds/tune_check.hpp"

#include <fmt/format.h>

#include <cmath>

#include "studies/reading/map/corners.hpp"
#include "studies/reading/map/grid_check.hpp"
#include "studies/reading/quantities/unit_words.hpp"
#include "studies/reading/study/study_values.hpp"

namespace frahm::studies {
namespace {

constexpr std::size_t places_over_band = 9;
constexpr std::size_t places_of_weight = 1001;

// SI values of all parameters in each scenario of the study.
std::vector<std::vector<double>> scenarios_of(const Study& study) {
  const std::vector<double> nominal = study.parameters.nominal();
  if (study.tune()->scenarios.empty()) return {nominal};
  std::vector<std::vector<double>> scenarios;
  for (const ScenarioChoice& scenario : study.tune()->scenarios) {
    scenarios.push_back(nominal);
    for (const Assignment& assignment : scenario.set)
      scenarios.back()[assignment.parameter] = assignment.value;
  }
  return scenarios;
}

std::vector<double> places_of(const TuneChoice& tune, std::size_t count) {
  if (!tune.band) return {};
  const tuning::Band& range = tune.band->range;
  if (range.from == range.to) return {range.from};
  std::vector<double> places(count);
  for (std::size_t i = 0; i < count; ++i)
    places[i] = std::lerp(range.from, range.to, static_cast<double>(i) / static_cast<double>(count - 1));
  return places;
}

// Checks each sampled value of the band.
void check_over_band(Study& study, std::vector<double>& parameters, const std::string& origin) {
  const auto check = [&] {
    check_point(study, parameters, origin);
    add_crank_orders_at(study, parameters);
  };
  std::vector<double> places = places_of(*study.tune(), places_over_band);
  for (const LimitChoice& limit : study.tune()->limits) {
    if (limit.band) places.insert(places.end(), {limit.band->from, limit.band->to});
  }
  if (places.empty()) check();
  for (const double place : places) {
    parameters[study.tune()->band->parameter] = place;
    check();
  }
}

[[noreturn]] void refuse(const Study& study, const StudyValue& value, double found, double at,
                         const char* rule) {
  const BandChoice& band = *study.tune()->band;
  throw study.source.error_at(
      rules::beyond_schema(rules::out_of_range), value.position, "{}: {} at {} = {}; {}", value.where,
      std::isfinite(found) ? fmt::format("is {:.6g}", found) : "has no value",
      study.parameters.list[band.parameter].name,
      with_unit(fmt::format("{:.6g}", at / band.unit.si_factor), band.unit.text), rule);
}

void check_weight_and_rules(const Study& study, std::vector<double> parameters) {
  const TuneChoice& tune = *study.tune();
  const auto at = [&](const StudyValue& value, double place) {
    parameters[tune.band->parameter] = place;
    study.parameters.complete(std::span<double>(parameters));
    return value.expression.evaluate(std::span<const double>(parameters));
  };
  for (const double place : places_of(tune, places_of_weight)) {
    if (tune.weight) {
      const double weight = at(*tune.weight, place);
      if (!(weight > 0.0 && std::isfinite(weight)))
        refuse(study, *tune.weight, weight, place, "a weight must be positive over the band");
    }
    for (const DesignChoice& design : tune.designs) {
      if (!design.rule) continue;
      const double value = at(*design.rule, place);
      if (!std::isfinite(value))
        refuse(study, *design.rule, value, place, "must be a finite number over the band");
    }
  }
}

}  // namespace

void check_tuning(Study& study) {
  const TuneChoice& tune = *study.tune();
  const std::vector<std::vector<double>> scenarios = scenarios_of(study);
  for (std::size_t s = 0; s < scenarios.size(); ++s) {
    const std::vector<double>& scenario = scenarios[s];
    const std::string origin = tune.scenarios.empty() ? std::string("within [tune] and [[design]]")
                               : !tune.drawn.empty()  ? fmt::format("sample {}", s)
                                                     : fmt::format("scenario \"{}\"", tune.scenarios[s].name);
    for (const std::vector<bool>& corner : corners(tune.designs.size())) {
      std::vector<double> parameters = scenario;
      for (std::size_t i = 0; i < corner.size(); ++i)
        parameters[tune.designs[i].parameter] = corner[i] ? tune.designs[i].upper : tune.designs[i].lower;
      check_over_band(study, parameters, origin);
    }
    check_weight_and_rules(study, scenario);
  }
}

}  // namespace frahm::studies
