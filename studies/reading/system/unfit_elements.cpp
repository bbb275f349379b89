#include "studies/reading/system/unfit_elements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "solvers/mechanics/smooth_laws.hpp"
#include "studies/reading/keys/study_keys.hpp"
#include "studies/reading/study/characteristic.hpp"
#include "studies/reading/study/study_values.hpp"

// Elements that some kinds of study do not follow, or not together with others.
namespace frahm::studies {

SmoothKey smooth_key(const Study& study, std::size_t element) {
  const mechanics::Element& of = study.network.elements[element];
  const bool is_chosen = mechanics::kind_of(of).can_be_smoothed();
  const char* const law =
      is_chosen ? study_key("element", "law").words[static_cast<std::size_t>(of.law)].word : "";
  const auto keys = mechanics::kind_of(of).values();
  for (std::size_t k = mechanics::first_smooth_number; k < keys.size(); ++k) {
    const StudyValue& value = study.values.elements[k][element];
    if (value.is_given()) return {value.where, value.position, keys[k]->key, is_chosen ? law : keys[k]->key};
  }
  const StudyCharacteristic& curve = study.values.characteristic[element];
  return {curve.where, curve.position, "table", law};
}

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
    if (const auto& joints = study.network.joints; !joints.empty())
      throw study.source.error_at(
          rules::wrong_law, key.position,
          "{}: its motion is integrated, which takes a mass at every node, but \"{}\" is "
          "a joint without mass; give it one",
          key.where, joints.front());
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
    const bool depends_on_numbers = of.kind == StudyCharacteristic::Kind::none || of.of_velocity;
    const bool is_smooth_spring = mechanics::is_of_displacement(element.law);
    if (!is_smooth_spring && !element.has_static_force && depends_on_numbers) continue;
    const StudyValue& at_rest = study.values.second(e);
    const SmoothKey spring = smooth_key(study, e);
    const auto [where, position] = is_smooth_spring           ? std::pair(spring.where, spring.position)
                                   : element.has_static_force ? std::pair(at_rest.where, at_rest.position)
                                                              : std::pair(of.where, of.position);
    throw study.source.error_at(rules::several_responses, position,
                                "{}: with it several responses may exist, but {} needs a single one", where,
                                what_needs_one);
  }
}

std::string only_one_response() {
  std::string springs;
  for (const mechanics::ElementKind& kind : mechanics::element_kinds()) {
    const auto keys = kind.values();
    for (const mechanics::ValueKey* key : std::span(keys).subspan(mechanics::first_smooth_number))
      if (key->law && mechanics::is_of_displacement(*key->law)) springs += fmt::format(", a {}", key->key);
  }
  return fmt::format(
      "has no effect: only one response exists here; several are searched for only if an element is a gap, "
      "or has a table{} or a static_force",
      springs);
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
