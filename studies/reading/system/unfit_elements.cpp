#include "studies/reading/system/unfit_elements.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "solvers/mechanics/smooth_laws.hpp"
#include "studies/reading/study/characteristic.hpp"
#include "studies/reading/study/study_values.hpp"

// Elements that some kinds of study do not follow, or not together with others.
namespace frahm::studies {
namespace {

// The key by which an element's law is smooth.
struct SmoothKey {
  std::string where;
  Position position;
  const char* law;
};

SmoothKey smooth_key(const Study& study, std::size_t e) {
  const StudyValues& values = study.values;
  if (study.network.elements[e].has_cubic) return {values.cubic[e].where, values.cubic[e].position, "cubic"};
  switch (study.network.elements[e].law) {
    case mechanics::FrictionLaw::exact:
      break;  // it is not smooth
    case mechanics::FrictionLaw::arctan:
      return {values.slope[e].where, values.slope[e].position, "arctan"};
    case mechanics::FrictionLaw::stribeck:
      return {values.characteristic[e].where, values.characteristic[e].position, "stribeck"};
  }
  return {{}, {}, "exact"};
}

}  // namespace

void refuse_bends(const Study& study, const std::string& why) {
  for (const StudyCharacteristic& of : study.values.characteristic) {
    if (!of.bends()) continue;
    throw study.source.error_at(rules::unfit_for_method, of.position, "{}: {}", of.where, why);
  }
}

void refuse_smooth_laws(const Study& study, std::string_view what_is_exact) {
  for (std::size_t e = 0; e < study.network.elements.size(); ++e) {
    if (!mechanics::has_smooth_law(study.network.elements[e])) continue;
    const SmoothKey key = smooth_key(study, e);
    throw study.source.error_at(
        rules::wrong_law, key.position,
        "{}: the law \"{}\" is integrated, which is for sweeps only; {} needs exact laws", key.where, key.law,
        what_is_exact);
  }
}

void refuse_mixed_laws(const Study& study) {
  const auto& elements = study.network.elements;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    if (!mechanics::has_smooth_law(elements[e])) continue;
    const SmoothKey key = smooth_key(study, e);
    refuse_bends(study,
                 fmt::format("it can be combined with exact laws only, but element \"{}\" follows \"{}\"",
                             elements[e].name, key.law));
    for (const mechanics::Element& other : elements) {
      if (!mechanics::has_contact(other) || mechanics::has_smooth_law(other)) continue;
      throw study.source.error_at(
          rules::wrong_law, key.position,
          "{}: its motion is integrated, but element \"{}\" is followed exactly{}", key.where, other.name,
          mechanics::kind_of(other).can_be_smoothed() ? "; give that element the law \"arctan\"" : "");
    }
  }
}

void refuse_several_responses(const Study& study, const std::string& what_needs_one) {
  for (std::size_t e = 0; e < study.network.elements.size(); ++e) {
    const mechanics::Element& element = study.network.elements[e];
    const StudyCharacteristic& of = study.values.characteristic[e];
    const StudyValue& value = element.has_cubic ? study.values.cubic[e] : study.values.second[e];
    const bool has_value = element.has_cubic || element.has_static_force;
    const bool depends_on_numbers = of.kind == StudyCharacteristic::Kind::none || of.of_velocity;
    if (!has_value && depends_on_numbers) continue;
    throw study.source.error_at(rules::several_responses, has_value ? value.position : of.position,
                                "{}: with it several responses may exist, but {} needs a single one",
                                has_value ? value.where : of.where, what_needs_one);
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
  if (study.sweep()->borders) return "[output] borders";
  return study.sweep()->resonances.empty() ? "" : "[output] resonances";
}

}  // namespace frahm::studies
