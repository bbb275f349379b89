#include "studies/reading/study/named_parameter.hpp"

#include <fmt/format.h>

#include "studies/reading/study/parameter_reading.hpp"
#include "studies/reading/text/spelling.hpp"

namespace frahm::studies {

std::optional<Refusal> why_not_a_number(const Parameters& parameters, std::string_view name,
                                        std::string_view need) {
  const auto index = parameters.find(name);
  if (!index) return Refusal{rules::unknown_name, none_called("parameter", name, parameters.names())};
  if (!parameters.list[*index].is_number())
    return Refusal{rules::computed_parameter,
                   fmt::format("\"{}\" is computed from other parameters; {}", name, need)};
  return std::nullopt;
}

std::size_t read_number_parameter(const TomlSection& section, const Parameters& parameters,
                                  const std::string& key, std::string_view need) {
  const std::string name = section.text(key);
  if (const auto refusal = why_not_a_number(parameters, name, need))
    section.fail(refusal->rule, key, "{}", refusal->text);
  return *parameters.find(name);
}

UsualUnit read_parameter_unit(const StudyContext& context, const TomlSection& section, Study& study,
                              std::size_t parameter) {
  Parameter& definition = study.parameters.list[parameter];
  UsualUnit usual = usual_unit(study, parameter);
  if (const TomlValue* value = section.find("unit")) {
    const auto unit = read_unit(context, section.where(), *value);
    try {
      if (unit) usual = {unit->text, si_factor(definition, *unit)};
      definition.unit_of_range = unit;
    } catch (const UnitError& error) {
      section.fail(error.rule(), "unit", "{}", error.what());
    }
  }
  if (study.dimensionless) return {"1", 1.0};
  if (usual.text.empty() && definition.quantity) usual.text = si_unit(*definition.quantity);
  return usual;
}

}  // namespace frahm::studies
