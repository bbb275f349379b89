#include "studies/reading/element_keys.hpp"

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

std::vector<std::string> keys_of_type(std::string_view type) {
  if (type == iwan) return {"stiffnesses", "forces", "distribution", "stiffness", "force", "elements", "chi"};
  const ElementKind& kind = kind_called(type);
  std::vector<std::string> keys{kind.value.key};
  if (kind.second.exists()) keys.emplace_back(kind.second.key);
  if (kind.can_be_smoothed()) keys.insert(keys.end(), {"law", kind.slope.key});
  if (kind.cubic.exists()) keys.emplace_back(kind.cubic.key);
  if (kind.table != nullptr || kind.can_be_smoothed()) keys.emplace_back("table");
  if (kind.stop != nullptr) keys.insert(keys.end(), {"clearance", "tension"});
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
