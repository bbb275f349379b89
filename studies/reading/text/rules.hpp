#pragma once

#include <string_view>

namespace frahm::studies {

// A rule that a study, its data or a command line can break. Its key is stable: messages are reworded, keys
// are not. Tests of refusals name the key, the position and the offending name.
struct Rule {
  // What shows that it is broken.
  enum class By {
    itself,  // the key or value alone
    table,   // and the table it is in, or the names of the study
    study,   // several parts of the study together
  };

  std::string_view key;
  By by = By::study;
  bool is_in_schema = false;  // the JSON Schema of `frahm schema` refuses it too

  friend bool operator==(const Rule& a, const Rule& b) { return a.key == b.key; }
};

namespace rules {

inline constexpr bool in_schema = true;

// A rule of the schema where this mistake is beyond it: it takes other sections, files, units or expressions.
constexpr Rule beyond_schema(Rule rule) {
  rule.is_in_schema = false;
  return rule;
}

// The text.
inline constexpr Rule not_text{"not_text"};  // control characters, an open quote
inline constexpr Rule not_toml{"not_toml"};
inline constexpr Rule too_large{"too_large"};  // the text, its nesting, a grid, a count of contacts

// Sections and keys.
inline constexpr Rule unknown_section{"unknown_section", Rule::By::itself, in_schema};
inline constexpr Rule missing_section{"missing_section", Rule::By::study, in_schema};
inline constexpr Rule other_kind{"other_kind", Rule::By::study,
                                 in_schema};  // belongs to another kind of study
inline constexpr Rule unknown_key{"unknown_key", Rule::By::itself, in_schema};
inline constexpr Rule missing_key{"missing_key", Rule::By::study, in_schema};
inline constexpr Rule missing_key_of_table{"missing_key", Rule::By::table,
                                           in_schema};  // whatever else the study says
inline constexpr Rule one_of_two_keys{"one_of_two_keys", Rule::By::table,
                                      in_schema};  // one is needed, or they exclude each other
inline constexpr Rule key_without_use{"key_without_use", Rule::By::study,
                                      in_schema};  // without effect with the other choices

// Values.
inline constexpr Rule wrong_type{"wrong_type", Rule::By::itself, in_schema};
inline constexpr Rule empty{"empty", Rule::By::itself, in_schema};
inline constexpr Rule not_a_name{"not_a_name", Rule::By::itself, in_schema};
inline constexpr Rule not_a_choice{"not_a_choice", Rule::By::itself,
                                   in_schema};  // not one of the words that a key allows
inline constexpr Rule not_finite{"not_finite", Rule::By::itself};
inline constexpr Rule out_of_range{"out_of_range", Rule::By::table, in_schema};
inline constexpr Rule wrong_order{"wrong_order",
                                  Rule::By::table};  // bounds, bands, knots and rows that do not rise
inline constexpr Rule wrong_length{"wrong_length", Rule::By::study,
                                   in_schema};  // of lists that belong together

// Names.
inline constexpr Rule unknown_name{"unknown_name", Rule::By::table};
inline constexpr Rule name_taken{"name_taken", Rule::By::table};
inline constexpr Rule given_twice{"given_twice", Rule::By::table};
inline constexpr Rule computed_parameter{"computed_parameter", Rule::By::table};  // where a number is needed
inline constexpr Rule wrong_dependence{"wrong_dependence"};  // of a value on a parameter, or none

// Units and expressions.
inline constexpr Rule unknown_unit{"unknown_unit", Rule::By::itself};
inline constexpr Rule wrong_dimension{"wrong_dimension", Rule::By::table};
inline constexpr Rule missing_unit{"missing_unit", Rule::By::table};
inline constexpr Rule ambiguous_unit{"ambiguous_unit", Rule::By::table};  // radians or cycles
inline constexpr Rule two_units{"two_units", Rule::By::table};            // of one thing
inline constexpr Rule unit_in_dimensionless{"unit_in_dimensionless", Rule::By::table};
inline constexpr Rule wrong_expression{"wrong_expression", Rule::By::itself};
inline constexpr Rule circular_definition{"circular_definition", Rule::By::table};

// The system and the requested results.
inline constexpr Rule floating_mass{"floating_mass"};
inline constexpr Rule wrong_node{"wrong_node"};
inline constexpr Rule wrong_matrix{"wrong_matrix"};            // not square, symmetric or definite
inline constexpr Rule wrong_law{"wrong_law"};                  // friction laws that do not go together
inline constexpr Rule no_contact{"no_contact"};                // where friction is asked for
inline constexpr Rule several_responses{"several_responses"};  // may exist where there must be one
inline constexpr Rule unfit_quantity{"unfit_quantity"};
inline constexpr Rule unfit_axis{"unfit_axis"};
inline constexpr Rule unfit_for_method{"unfit_for_method"};

// Data and earlier results.
inline constexpr Rule unreadable_file{"unreadable_file"};
inline constexpr Rule wrong_file{"wrong_file"};  // of another kind than needed
inline constexpr Rule changed_data{"changed_data"};  // since a result was made of it
inline constexpr Rule no_header{"no_header"};
inline constexpr Rule unknown_column{"unknown_column"};
inline constexpr Rule wrong_row{"wrong_row"};
inline constexpr Rule doubtful_row{"doubtful_row"};  // where every row is needed
inline constexpr Rule too_few{"too_few"};            // rows

// The program.
inline constexpr Rule wrong_option{"wrong_option"};
inline constexpr Rule not_installed{"not_installed"};
inline constexpr Rule not_computed{"not_computed"};  // the text is valid, but there is no result

}  // namespace rules
}  // namespace frahm::studies
