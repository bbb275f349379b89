#include "studies/reading/study/assignment.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "studies/reading/quantities/units.hpp"
#include "studies/reading/study/named_parameter.hpp"
#include "studies/reading/text/trimmed.hpp"

namespace frahm::studies {
namespace {

class AssignmentReading {
 public:
  AssignmentReading(const Study& study, std::string_view option, std::string_view text)
      : study_(study), option_(option), text_(trimmed(text)) {}

  Assignment read() const {
    const std::size_t equals = text_.find('=');
    if (equals == std::string_view::npos)
      fail(rules::wrong_option, "write name=value, such as omega=250 or \"omega=250 rpm\"");
    const std::size_t parameter = named(trimmed(text_.substr(0, equals)));
    return {parameter,
            value(study_.parameters.list[parameter], parameter, trimmed(text_.substr(equals + 1)))};
  }

 private:
  [[noreturn]] void fail(Rule rule, std::string_view message) const {
    throw StudyError(rule, "{} \"{}\": {}", option_, text_, message);
  }

  std::size_t named(std::string_view name) const {
    if (const auto refusal = why_not_a_number(study_.parameters, name, "set those instead"))
      fail(refusal->rule, refusal->text);
    return *study_.parameters.find(name);
  }

  // value: a number, with or without a unit after it. Result: SI.
  double value(const Parameter& parameter, std::size_t index, std::string_view value) const {
    double number = 0.0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (error != std::errc{} || !std::isfinite(number))
      fail(rules::not_finite, fmt::format("\"{}\" is not a finite number", value));
    const std::string_view unit = trimmed(value.substr(static_cast<std::size_t>(end - value.data())));
    const double si = number * (unit.empty() ? usual_unit(study_, index).si_factor : factor(parameter, unit));
    if (!std::isfinite(si)) fail(rules::not_finite, "the value in SI units is out of range");
    return si;
  }

  double factor(const Parameter& parameter, std::string_view unit) const {
    if (study_.dimensionless) {
      if (unit == "1") return 1.0;
      if (const auto pure = UnitSystem().pure_factor(unit)) return *pure;
      fail(rules::unit_in_dimensionless,
           fmt::format("the unit \"{}\" has no meaning in a dimensionless study", unit));
    }
    try {
      return si_factor(parameter, UnitSystem().parse(unit));
    } catch (const UnitError& error) {
      fail(error.rule(), error.what());
    }
  }

  const Study& study_;
  std::string_view option_, text_;
};

}  // namespace

std::vector<Assignment> parse_assignments(const Study& study, std::string_view option,
                                          std::string_view text) {
  std::vector<Assignment> assignments;
  for (bool more = true; more;) {
    const std::size_t comma = text.find(',');
    const Assignment assignment = AssignmentReading(study, option, text.substr(0, comma)).read();
    if (of_parameter(assignments, assignment.parameter)) {
      throw StudyError(rules::given_twice, "{}: \"{}\" is given twice", option,
                       study.parameters.list[assignment.parameter].name);
    }
    assignments.push_back(assignment);
    more = comma != std::string_view::npos;
    if (more) text.remove_prefix(comma + 1);
  }
  return assignments;
}

}  // namespace frahm::studies
