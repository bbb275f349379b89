#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "solvers/mechanics/element_table.hpp"
#include "studies/reading/quantities/units.hpp"

// Which keys of an [[element]] a type of element has: decided here alone, from the table of elements.
namespace frahm::studies {

inline constexpr const char* iwan = "iwan";  // jenkins elements side by side, and no row of the table

// The names of the types, as a study writes them.
std::vector<std::string> element_types();

// The row of a type; of an iwan that of its sliders.
const mechanics::ElementKind& kind_called(std::string_view type);

// Whether every type has the key: name, type, and what the element acts along.
bool is_of_every_type(std::string_view key);

// A form of a type by its other keys: a coulomb by its law, a spring by its stiffness or its table.
struct ElementForm {
  const char* decider = "";  // the key whose word gives the form, if one does
  const char* word = "";
  std::vector<std::string> needed{}, optional{};
};
std::vector<ElementForm> forms_of_type(std::string_view type);

// The range of a value of a type, which has it.
mechanics::Range range_of_type(std::string_view type, std::string_view key);

// The other keys of a type, of all its forms.
std::vector<std::string> keys_of_type(std::string_view type);

// What a value of an element is, of one that turns too.
Quantity element_quantity(mechanics::Dimension dimension, bool rotational);

}  // namespace frahm::studies
