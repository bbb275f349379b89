#include "studies/reading/study/assignment_reading.hpp"

#include <fmt/format.h>

#include "studies/reading/study/named_parameter.hpp"
#include "studies/reading/study/parameter_reading.hpp"

namespace frahm::studies {

Assignment read_assignment(const StudyContext& context, const Study& study, const std::string& where,
                           const TomlEntry& entry, const WhyNot& why_not) {
  const auto fail = [&](Rule rule, Position position, const std::string& message) {
    throw context.source.error_at(rule, position, "{}: {}: {}", where, entry.key, message);
  };
  if (const auto refusal = why_not_a_number(study.parameters, entry.key, "set those instead"))
    fail(refusal->rule, entry.position, refusal->text);
  const std::size_t index = *study.parameters.find(entry.key);
  const Parameter& parameter = study.parameters.list[index];
  if (why_not) {
    if (const std::string reason = why_not(index); !reason.empty())
      fail(rules::beyond_schema(rules::key_without_use), entry.position, reason);
  }
  if (entry.value.as<std::string>())
    fail(rules::wrong_type, entry.value.position,
         fmt::format("expected a number, found {}", described(entry.value)));
  const NumberWithUnit number =
      read_number_with_unit(context, fmt::format("{}: {}", where, entry.key), entry.value);
  double factor = usual_unit(study, index).si_factor;
  try {
    if (number.unit) factor = si_factor(parameter, *number.unit);
  } catch (const UnitError& error) {
    fail(error.rule(), number.unit_position, error.what());
  }
  return {index, number.value * factor};
}

}  // namespace frahm::studies
