#include "studies/reading/kinds/identified_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "studies/reading/data_files/identify_methods.hpp"
#include "studies/reading/keys/study_keys.hpp"
#include "studies/reading/kinds/identify_reading.hpp"
#include "studies/reading/quantities/parameters.hpp"
#include "studies/reading/study/named_parameter.hpp"
#include "studies/reading/study/parameter_reading.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_values.hpp"
#include "studies/reading/text/spelling.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {
namespace {

bool reads(const Study& study, const StudyValue& value, std::size_t parameter) {
  const auto inputs = study.parameters.inputs_of(value.expression.reads());
  return std::find(inputs.begin(), inputs.end(), parameter) != inputs.end();
}

// Whether the network or its initial values depend on a parameter.
bool system_depends_on(const Study& study, std::size_t parameter) {
  if (reads(study, study.values.omega, parameter)) return true;
  for (const auto* list : study.values.lists()) {
    for (const StudyValue& value : *list) {
      if (reads(study, value, parameter)) return true;
    }
  }
  const auto of_factors = study.parameters.inputs_of(study.values.read_by_factors());
  if (std::ranges::find(of_factors, parameter) != of_factors.end()) return true;  // refused by direction_of()
  return std::ranges::any_of(study.initial(), [&](const InitialValues& of_mass) {
    return reads(study, of_mass.displacement, parameter) || reads(study, of_mass.velocity, parameter);
  });
}

std::size_t read_parameter(const IdentifyReading& reading, const TomlSection& section) {
  const std::size_t index = read_number_parameter(section, reading.study.parameters, "parameter",
                                                  "only one that is a number can be identified");
  const std::string& name = reading.study.parameters.list[index].name;
  if (const auto* other = of_parameter(reading.choice.parameters, index))
    section.fail(rules::given_twice, "parameter", "\"{}\" is already identified (line {})", name,
                 other->position.line);
  if (!system_depends_on(reading.study, index))
    section.fail(rules::wrong_dependence, "parameter",
                 "no value of the system or of its start depends on \"{}\"", name);
  return index;
}

// Whether a network value that may not be negative is this parameter.
bool cannot_be_negative(const Study& study, std::size_t parameter) {
  for (const auto* list : study.values.lists()) {
    for (const StudyValue& value : *list) {
      if (value.range != Range::finite && value.expression.sole_parameter() == parameter) return true;
    }
  }
  return false;
}

void read_bounds(const Study& study, const TomlSection& section, IdentifiedParameter& fitted) {
  const double factor = fitted.unit.si_factor;
  if (cannot_be_negative(study, fitted.parameter)) fitted.lower = 0.0;
  if (section.find("lower")) fitted.lower = section.number("lower") * factor;
  if (section.find("upper")) fitted.upper = section.number("upper") * factor;
  if (!(fitted.lower < fitted.upper))
    section.fail(rules::wrong_order, "upper",
                 "{} is not above \"lower\" = {}; the upper bound must be above the lower",
                 section.number("upper"), fitted.lower / factor);
  const double start = std::get<double>(study.parameters.list[fitted.parameter].definition);
  if (start >= fitted.lower && start <= fitted.upper) return;
  section.fail(rules::beyond_schema(rules::out_of_range), start < fitted.lower ? "lower" : "upper",
               "the fit starts from {:.6g} of [parameters], outside its bounds {:.6g} to {:.6g}{}{}",
               start / factor, fitted.lower / factor, fitted.upper / factor,
               fitted.unit.text.empty() ? "" : " ", fitted.unit.text);
}

// Reads a formula's estimate for a parameter.
void read_estimate(const IdentifyReading& reading, const TomlSection& section, IdentifiedParameter& taken) {
  const std::string method = method_name(reading.choice.method);
  section.keep_to(method);
  const std::vector<std::string> known = separated(method_row(reading.study).estimates);
  taken.estimate = section.text("estimate");
  if (reading.data == DataFiles::leave) return;  // the estimates depend on the data
  if (std::find(known.begin(), known.end(), taken.estimate) == known.end())
    section.fail(
        rules::unknown_name, "estimate",
        "the method \"{}\" gives no estimate \"{}\" with what [identify] states{}", method, taken.estimate,
        known.empty() ? ", as each row of its table has its own answer" : suggestion(taken.estimate, known));
}

}  // namespace

void read_identified_parameters(IdentifyReading& reading, const TomlSection& section) {
  IdentifiedParameter identified;
  identified.position = section.position();
  identified.parameter = read_parameter(reading, section);
  identified.unit = read_parameter_unit(reading.context, section, reading.study, identified.parameter);
  if (reading.choice.method == IdentifyMethod::grey_box) {
    if (section.find("estimate"))
      section.fail(rules::key_without_use, "estimate",
                   "a grey box estimates the parameters themselves; leave out this key");
    read_bounds(reading.study, section, identified);
    identified.each_record = section.boolean("each_record");
  } else {
    read_estimate(reading, section, identified);
  }
  reading.choice.parameters.push_back(std::move(identified));
}

}  // namespace frahm::studies
