#include "studies/reading/study/study_units.hpp"

#include <fmt/format.h>

#include "studies/reading/quantities/unit_words.hpp"

namespace frahm::studies {

SpokenValue spoken_value(const Study& study, std::size_t parameter, double si) {
  const UsualUnit usual = usual_unit(study, parameter);
  SpokenValue spoken{si / usual.si_factor, usual.text};
  const Parameter& definition = study.parameters.list[parameter];
  const bool is_si =
      definition.quantity && (spoken.unit.empty() || spoken.unit == si_unit(*definition.quantity));
  if (is_si) spoken.unit = written_si_unit(*definition.quantity);
  if (study.dimensionless || is_pure_number(spoken.unit)) spoken.unit.clear();
  return spoken;
}

std::string spoken_text(const Study& study, std::size_t parameter, double si) {
  const SpokenValue spoken = spoken_value(study, parameter, si);
  return fmt::format("{:.12g}{}{}", spoken.value, spoken.unit.empty() ? "" : " ", spoken.unit);
}

UsualUnit frequency_unit(const Study& study) {
  for (std::size_t i = 0; i < study.parameters.list.size(); ++i) {
    const Parameter& parameter = study.parameters.list[i];
    if (parameter.in_frequency && parameter.quantity == Quantity::angular_frequency)
      return usual_unit(study, i);
  }
  if (!study.values.omega.unit.text.empty()) return study.values.omega.unit;
  for (const StudyValue* value : study.values_of_its_kind()) {
    if (value->quantity == Quantity::angular_frequency && !value->unit.text.empty()) return value->unit;
  }
  return {};
}

UsualUnit frequency_unit_in_file(const Study& study) {
  if (study.dimensionless) return {"1", 1.0};
  const UsualUnit unit = frequency_unit(study);
  return unit.text.empty() ? UsualUnit{"rad s-1", 1.0} : unit;
}

SpokenValue spoken_frequency(const Study& study, double omega) {
  if (study.dimensionless) return {omega, ""};
  const UsualUnit unit = frequency_unit(study);
  const bool is_si = unit.text.empty() || unit.text == si_unit(Quantity::angular_frequency);
  return {omega / unit.si_factor, is_si ? "rad/s" : unit.text};
}

std::string unit_in_file(const Study& study, std::size_t parameter) {
  const Parameter& definition = study.parameters.list[parameter];
  if (study.dimensionless) return "1";
  if (definition.quantity) return std::string(si_unit(*definition.quantity));
  return definition.unit ? coherent_unit(*definition.unit) : "1";
}

}  // namespace frahm::studies
