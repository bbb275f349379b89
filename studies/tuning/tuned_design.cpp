#include "studies/tuning/tuned_design.hpp"

#include <algorithm>
#include <cmath>

namespace frahm::studies {

std::optional<Jump> jump_of(const DesignChoice& choice, const DesignCourse& course) {
  if (!choice.may_leap || course.knots.size() != choice.count()) return std::nullopt;
  // Both sides of the jump are the knots that the study does not have.
  const auto i =
      static_cast<std::size_t>(std::ranges::mismatch(course.knots, choice.knots).in1 - course.knots.begin());
  return Jump{0.5 * (course.knots[i] + course.knots[i + 1]), course.values[i], course.values[i + 1]};
}

DesignValues design_values(const tuning::Optimum& optimum) {
  DesignValues values;
  for (const tuning::TunedParameter& parameter : optimum.parameters)
    values.push_back({parameter.value, parameter.knots});
  return values;
}

double value_at(const DesignCourse& course, double band) {
  const auto& [values, knots] = course;
  if (knots.empty()) return values.front();
  const auto right = std::upper_bound(knots.begin() + 1, knots.end() - 1, band);
  const auto i = static_cast<std::size_t>(right - knots.begin());
  const double part = std::clamp((band - knots[i - 1]) / (knots[i] - knots[i - 1]), 0.0, 1.0);
  return std::lerp(values[i - 1], values[i], part);
}

std::vector<double> parameters_in_scenario(const Study& study, std::size_t scenario) {
  std::vector<double> parameters = study.parameters.nominal();
  const auto& scenarios = study.tune()->scenarios;
  if (scenarios.empty()) return parameters;
  for (const Assignment& assignment : scenarios[scenario].set)
    parameters[assignment.parameter] = assignment.value;
  return parameters;
}

std::vector<double> parameters_of(const Study& study, const DesignValues& design, std::size_t scenario,
                                  double band) {
  const TuneChoice& tune = *study.tune();
  std::vector<double> parameters = parameters_in_scenario(study, scenario);
  if (tune.band) parameters[tune.band->parameter] = band;
  for (std::size_t i = 0; i < tune.designs.size(); ++i)
    parameters[tune.designs[i].parameter] = value_at(design[i], band);
  study.parameters.complete(std::span<double>(parameters));
  return parameters;
}

std::vector<tuning::Rule> rules_of(const Study& study) {
  std::vector<tuning::Rule> rules;
  for (const DesignChoice& choice : study.tune()->designs) {
    rules.emplace_back();
    if (!choice.rule) continue;
    rules.back() = [&study, &choice](double band) {
      std::vector<double> parameters = parameters_in_scenario(study, 0);
      parameters[study.tune()->band->parameter] = band;
      study.parameters.complete(std::span<double>(parameters));
      const double value = choice.rule->expression.evaluate(std::span<const double>(parameters));
      return std::clamp(value, choice.lower, choice.upper);
    };
  }
  return rules;
}

std::vector<std::string> scenario_names(const Study& study) {
  if (study.tune()->scenarios.empty()) return {"study"};
  std::vector<std::string> names;
  for (const ScenarioChoice& scenario : study.tune()->scenarios) names.push_back(scenario.name);
  return names;
}

}  // namespace frahm::studies
