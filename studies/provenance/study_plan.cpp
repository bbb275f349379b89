#include "studies/provenance/study_plan.hpp"

#include <fmt/format.h>

#include "studies/provenance/fingerprint.hpp"
#include "studies/reading/study/assignment.hpp"

namespace frahm::studies {
namespace {

std::string overruled_by_measurements(const IdentifyChoice& choice, std::size_t parameter) {
  if (of_parameter(choice.parameters, parameter))
    return "is identified; set the start value of the fit in [parameters]";
  if (of_parameter(choice.fixed, parameter)) return "has its value from fixed_from; leave out that file";
  for (const RecordChoice& record : choice.records) {
    if (of_parameter(record.set, parameter))
      return fmt::format("is set by the record \"{}\"; change the record", record.name);
  }
  return "";
}

// The part of the study that overrides a parameter, so that a command-line value has no effect; empty if
// none.
std::string overruled_by(const Study& study, std::size_t parameter) {
  if (study.map() && has_axis(study, parameter)) return "runs along an axis of the map; change the axis";
  if (study.identify()) return overruled_by_measurements(*study.identify(), parameter);
  if (!study.tune()) return "";
  if (has_axis(study, parameter)) return "runs over the band of the tuning; change the band";
  for (const ScenarioChoice& scenario : study.tune()->scenarios) {
    if (!of_parameter(scenario.set, parameter)) continue;
    return study.tune()->drawn.empty()
               ? fmt::format("is set by the scenario \"{}\"; change the scenario", scenario.name)
               : "scatters over samples; change their distribution";
  }
  return "";
}

}  // namespace

engine::LogHeader StudyPlan::header_of_logs(const std::string& identity) const {
  return {.fingerprint = identity.empty() ? fingerprint : grown_fingerprint(fingerprint, identity),
          .tiles = tiles};
}

void refuse_overruled(const Study& study, const std::vector<std::string>& set) {
  for (const std::string& text : set) {
    for (const Assignment& assignment : parse_assignments(study, "--set", text)) {
      const std::string why = overruled_by(study, assignment.parameter);
      if (why.empty()) continue;
      throw StudyError(rules::wrong_option, "--set \"{}\": \"{}\" {}", text,
                       study.parameters.list[assignment.parameter].name, why);
    }
  }
}

StudyPlan plan_without_map(Study study, std::vector<std::string> set) {
  refuse_overruled(study, set);
  StudyPlan plan{.study = std::move(study), .set = std::move(set)};
  plan.fingerprint = fingerprint(plan.study);
  return plan;
}

}  // namespace frahm::studies
