#include "studies/reading/keys/element_keys.hpp"

#include <algorithm>
#include <stdexcept>

namespace frahm::studies {
namespace {

using mechanics::Dimension;
using mechanics::ElementKind;

constexpr std::string_view keys_of_every_type[] = {"name", "type", "between", "along"};

}  // namespace

std::vector<std::string> element_types() {
  std::vector<std::string> types;
  for (const ElementKind& kind : mechanics::element_kinds()) types.emplace_back(kind.name);
  types.emplace_back(iwan);
  return types;
}

const ElementKind& kind_called(std::string_view type) {
  if (type == iwan) return mechanics::kind_of(mechanics::ElementType::jenkins);
  const auto kinds = mechanics::element_kinds();
  const auto found = std::ranges::find_if(kinds, [&](const ElementKind& kind) { return kind.name == type; });
  if (found == kinds.end()) throw std::logic_error("no element is of type " + std::string(type));
  return *found;
}

bool is_of_every_type(std::string_view key) {
  return std::ranges::find(keys_of_every_type, key) != std::end(keys_of_every_type);
}

std::vector<ElementForm> forms_of_type(std::string_view type) {
  if (type == iwan)
    return {{.needed = {"stiffnesses", "forces"}},
            {"distribution", "uniform", {"distribution", "stiffness", "force", "elements"}},
            {"distribution", "power", {"distribution", "stiffness", "force", "elements", "chi"}}};
  const ElementKind& kind = kind_called(type);
  const auto add_values = [&](ElementForm& form, mechanics::ForceLaw law) {
    for (const mechanics::ValueKey* value : kind.values()) {
      // A kind without a key "law" follows the law of the numbers that it is given.
      if (kind.can_be_smoothed() ? !value->exists_under(law) : !value->exists()) continue;
      (value->is_optional ? form.optional : form.needed).emplace_back(value->key);
    }
  };
  ElementForm by_value;
  add_values(by_value, mechanics::ForceLaw::exact);
  if (kind.stop != nullptr)
    by_value.needed.emplace_back("clearance"), by_value.optional.emplace_back("tension");
  if (kind.can_be_smoothed()) {
    by_value.decider = "law", by_value.word = "exact", by_value.optional.emplace_back("law");
    ElementForm arctan{"law", "arctan", {"law"}};
    add_values(arctan, mechanics::ForceLaw::arctan);
    return {by_value, arctan, {"law", "stribeck", {"law", "table"}}};
  }
  if (kind.table != nullptr) return {by_value, {.needed = {"table"}}};
  return {by_value};
}

mechanics::Range range_of_type(std::string_view type, std::string_view key) {
  const ElementKind& kind = kind_called(type);
  if (key == "stiffnesses") return kind.value.range;
  if (key == "forces") return kind.second.range;
  for (const mechanics::ValueKey* value : kind.values()) {
    if (value->exists() && key == value->key) return value->range;
  }
  return mechanics::Range::finite;
}

std::vector<std::string> keys_of_type(std::string_view type) {
  std::vector<std::string> keys;
  for (const ElementForm& form : forms_of_type(type)) {
    for (const auto* more : {&form.needed, &form.optional}) {
      for (const std::string& key : *more) {
        if (std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
      }
    }
  }
  return keys;
}

Quantity element_quantity(Dimension dimension, bool rotational) {
  switch (dimension) {
    case Dimension::number:
      break;
    case Dimension::stiffness:
      return rotational ? Quantity::torsional_stiffness : Quantity::stiffness;
    case Dimension::damping:
      return rotational ? Quantity::torsional_damping : Quantity::damping;
    case Dimension::inertance:
      return rotational ? Quantity::inertia : Quantity::inertance;
    case Dimension::force:
      return rotational ? Quantity::torque : Quantity::force;
    case Dimension::inverse_speed:
      return rotational ? Quantity::inverse_rate : Quantity::inverse_speed;
    case Dimension::cubic_stiffness:
      return rotational ? Quantity::torsional_cubic_stiffness : Quantity::cubic_stiffness;
  }
  return Quantity::number;
}

}  // namespace frahm::studies
