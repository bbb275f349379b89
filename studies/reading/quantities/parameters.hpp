#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "studies/reading/quantities/expression.hpp"
#include "studies/reading/quantities/lookup_table.hpp"
#include "studies/reading/quantities/units.hpp"
#include "studies/reading/text/study_source.hpp"

namespace frahm::studies {

// A parameter read from a table of another parameter.
struct TableOf {
  std::string file;  // as the study names it
  LookupTable table;
  std::size_t of = 0;  // index of the other parameter
  std::optional<Unit> of_unit = std::nullopt,
                      unit = std::nullopt;  // of the columns, as the file's header says
};

// A named parameter of a study: a number [SI], an expression of others, or a table over one.
struct Parameter {
  std::string name;
  Position position;  // of its value in the study
  std::variant<double, Expression, TableOf> definition = 0.0;

  // For numbers only:
  std::optional<Unit> unit;  // as the study gives it
  Position unit_position;
  std::optional<Unit> unit_of_range;  // as its axis, band or bounds give it
  std::optional<Quantity> quantity;   // known if a network value is this parameter alone:
  std::string used_as;                // that value, for messages
  bool in_frequency = false;          // the excitation frequency depends on it: its 1/s, Hz are cycles

  bool is_number() const { return std::holds_alternative<double>(definition); }
};

// A parameter set to a value: part of a point of the map, or an override of the study.
struct Assignment {
  std::size_t parameter = 0;  // index in Parameters::list, of a number
  double value = 0.0;         // SI
};

// The one of a list (axes, designs, assignments) that is of this parameter; nullptr if there is none.
template <class List>
const typename List::value_type* of_parameter(const List& list, std::size_t parameter) {
  const auto found = std::ranges::find(list, parameter, &List::value_type::parameter);
  return found == list.end() ? nullptr : &*found;
}

// The unit of a parameter or quantity in the study and in messages.
struct UsualUnit {
  std::string text;        // in a form UDUNITS reads; "" for SI
  double si_factor = 1.0;  // SI value = si_factor x value
};

struct Parameters {
  std::vector<Parameter> list;       // in the order of the file
  std::vector<std::size_t> derived;  // the expressions and tables, each after everything it reads

  std::optional<std::size_t> find(std::string_view name) const;
  std::vector<std::string> names() const;

  // SI values of all parameters as the study states them, in the order of `list`.
  std::vector<double> nominal() const;

  // Indices (ascending) of the number parameters that determine these parameters, through expressions and
  // tables.
  std::vector<std::size_t> inputs_of(std::span<const std::size_t> reads) const;

  // Recomputes the expressions and tables. values: SI, one per parameter, in the order of `list`; the entries
  // of `derived` are overwritten (NaN outside a table). No allocation.
  template <class Number>
  void complete(std::span<Number> values) const;
};

template <class Number>
void Parameters::complete(std::span<Number> values) const {
  for (const std::size_t i : derived) {
    if (const auto* expression = std::get_if<Expression>(&list[i].definition)) {
      values[i] = expression->evaluate(std::span<const Number>(values));
    } else {
      const auto& lookup = std::get<TableOf>(list[i].definition);
      values[i] = lookup.table.at(values[lookup.of]);
    }
  }
}

// Factor from a unit given for a number parameter (in [parameters], on an axis or on the command line) to SI.
// Throws UnitError for a wrong dimension, if the parameter's is known, and where it is unclear whether 1/s,
// Hz or 1/min count cycles.
double si_factor(const Parameter& parameter, const Unit& unit);

// The same for a value that is written out in a unit, text: as the study has it. 1 but where it is a
// parameter alone whose dimension is known: an expression may have converted its number already, as
// omega/(2*pi) in Hz.
double factor_of_label(const Parameters& parameters, const std::string& text, const Unit& unit);

}  // namespace frahm::studies
