#include <fmt/format.h>

#include <algorithm>

#include "studies/reading/study_reading.hpp"

// Elements that some kinds of study do not follow.
namespace frahm::studies {

void refuse_bends(const Study& study, const std::string& why) {
  for (const StudyCharacteristic& of : study.values.characteristic) {
    if (of.kind == StudyCharacteristic::Kind::none) continue;
    throw study.source.error_at(rules::unfit_for_method, of.position, "{}: {}", of.where, why);
  }
}

void refuse_bends_beside_arctan(const Study& study) {
  for (const mechanics::Element& element : study.network.elements) {
    if (element.law == mechanics::FrictionLaw::arctan)
      refuse_bends(study,
                   fmt::format("it stands beside the exact law alone, and element \"{}\" follows \"arctan\"",
                               element.name));
  }
}

void refuse_several_responses(const Study& study, const std::string& what_needs_one) {
  for (std::size_t e = 0; e < study.network.elements.size(); ++e) {
    const StudyCharacteristic& of = study.values.characteristic[e];
    const bool has_static_force = study.network.elements[e].has_static_force;
    const bool depends_on_numbers = of.kind == StudyCharacteristic::Kind::none || of.of_velocity;
    if (!has_static_force && depends_on_numbers) continue;
    const StudyValue& at_rest = study.values.second[e];
    throw study.source.error_at(rules::several_responses, has_static_force ? at_rest.position : of.position,
                                "{}: with it several responses may exist, and {} needs that there is one",
                                has_static_force ? at_rest.where : of.where, what_needs_one);
  }
}

std::string needs_one_response(const Study& study) {
  if (study.tune()) return "a tuning";
  if (study.identify()) {
    const auto is_steady = [](const RecordChoice& record) {
      return record.motion == identification::MotionKind::periodic;
    };
    const auto& records = study.identify()->records;
    const auto steady = std::ranges::find_if(records, is_steady);
    return steady == records.end() ? ""
                                   : fmt::format("a fit to the steady motion of record \"{}\"", steady->name);
  }
  if (!study.sweep()) return "";
  if (study.sweep()->output.borders) return "[output] borders";
  return study.sweep()->output.resonances.empty() ? "" : "[output] resonances";
}

}  // namespace frahm::studies
