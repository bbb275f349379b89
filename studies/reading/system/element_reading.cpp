#include "studies/reading/system/element_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/rotation.hpp"
#include "studies/reading/keys/element_keys.hpp"
#include "studies/reading/keys/study_keys.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/study/characteristic.hpp"
#include "studies/reading/study/study_values.hpp"
#include "studies/reading/system/characteristic_reading.hpp"
#include "studies/reading/system/direction_reading.hpp"
#include "studies/reading/system/friction_law_reading.hpp"
#include "studies/reading/system/iwan_reading.hpp"
#include "studies/reading/system/network_limits.hpp"
#include "studies/reading/system/network_reading.hpp"
#include "studies/reading/text/spelling.hpp"

namespace frahm::studies {
namespace {

using mechanics::ElementKind;
using mechanics::Node;
using mechanics::NodeKind;
using mechanics::ValueKey;

// The type that is written, and that it has the keys next to it.
std::string read_type(const TomlSection& section) {
  const std::string type = section.text("type");
  const std::vector<std::string> known = element_types();
  if (std::ranges::find(known, type) == known.end())
    section.fail(rules::unknown_name, "type", "no element is of type \"{}\"{}", type,
                 suggestion(type, known));
  return type;
}

// Each type has its values and no key of another type.
void check_keys_of_type(const TomlSection& section, const std::string& type) {
  const std::vector<std::string> own = keys_of_type(type);
  for (const std::string& key : keys_of("element")) {
    if (is_of_every_type(key) || !section.find(key) || std::ranges::find(own, key) != own.end()) continue;
    if (type == iwan) section.fail(rules::unknown_key, key, "an iwan has sliders, not {}", key);
    const ElementKind& kind = kind_called(type);
    const std::string second = kind.second.exists() ? fmt::format(" and a {}", kind.second.key) : "";
    section.fail(rules::unknown_key, key, "a {} has a {}{}, not {}", type, kind.value.key, second, key);
  }
}

std::array<Node, 2> read_between(const NetworkReading& reading, const TomlSection& section) {
  const TomlValue& value = section.require("between");
  const auto* ends = value.as<TomlArray>();
  if (!ends || ends->size() != 2)
    section.fail(rules::wrong_type, "between", "expected two nodes: between = [\"ground\", \"main\"]");
  std::array<Node, 2> nodes;
  std::array<std::string, 2> names;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string where = fmt::format("{}: between", section.where());
    names[i] = read_text(section.source(), where, (*ends)[i]);
    const auto node = find_node(reading.result.network, names[i]);
    if (!node) {
      throw section.source().error_at(rules::unknown_name, (*ends)[i].position, "{}: {}", where,
                                      none_called("node", names[i], node_names(reading.result.network)));
    }
    nodes[i] = *node;
  }
  if (nodes[0] == nodes[1]) section.fail(rules::wrong_node, "between", "both ends are at \"{}\"", names[0]);
  const auto moves = [](const Node& node) {
    return node.kind == NodeKind::mass || node.kind == NodeKind::joint;
  };
  if (!moves(nodes[0]) && !moves(nodes[1])) {
    section.fail(rules::wrong_node, "between",
                 "neither \"{}\" nor \"{}\" is a mass; at least one end must be a mass", names[0], names[1]);
  }
  return nodes;
}

// What it rotates by, of two nodes: both rotate, or one does and the other is fixed.
bool is_rotational(const NetworkReading& reading, const TomlSection& section,
                   const std::array<Node, 2>& ends) {
  const mechanics::Network& network = reading.result.network;
  const auto rotates = [&](const Node& node) { return mechanics::turns(network, node); };
  const auto is_free = [](const Node& node) { return node.kind != NodeKind::ground; };
  const bool any = rotates(ends[0]) || rotates(ends[1]);
  for (std::size_t i = 0; i < 2; ++i) {
    if (!any || rotates(ends[i]) || !is_free(ends[i])) continue;
    section.fail(rules::wrong_node, "between",
                 "\"{0}\" turns but the other end moves in a line; join them by the radius at which they "
                 "meet: along = {{ {0} = {{ value = 0.1, unit = \"m\" }}, ... }}",
                 mechanics::node_name(network, ends[1 - i]));
  }
  return any;
}

// What the element acts along: `between` two nodes or `along` any combination of them.
struct ReadDirection {
  mechanics::Direction direction;  // of a combination with the factors still to come: set_directions()
  StudyDirection given;
  bool rotational = false;
};

ReadDirection read_ends(const NetworkReading& reading, const TomlSection& section) {
  if (section.find("between")) {
    const std::array<Node, 2> ends = read_between(reading, section);
    return {mechanics::between(ends[0], ends[1]), {}, is_rotational(reading, section, ends)};
  }
  ReadDirection read;
  read.given = read_direction(reading.context, reading.parameters, reading.result.network, section);
  read.rotational = read.given.rotational;
  for (const Node& node : read.given.nodes) read.direction.push_back({node});
  return read;
}

// The value of an element with a table follows from its points.
StudyValue value_of_table(const StudyCharacteristic& table) {
  return {.where = table.where, .position = table.position};
}

// numbers: in the order of ElementKind::values().
void add_element(NetworkReading& reading, const TomlSection& section, mechanics::Element element,
                 const StudyDirection& along,
                 std::array<StudyValue, mechanics::numbers_of_an_element> numbers) {
  StudyValues& values = reading.result.values;
  reading.result.network.elements.push_back(std::move(element));
  check_number_of_contacts(reading, section, reading.result.network.elements.back());
  if (mechanics::kind_of(reading.result.network.elements.back()).has_internal_force)
    check_number_of_states(reading, section);
  for (std::size_t i = 0; i < numbers.size(); ++i) values.elements[i].push_back(std::move(numbers[i]));
  values.along.push_back(along);
  values.characteristic.emplace_back();
}

// The first of its sliders stands for all.
void add_iwan(NetworkReading& reading, const TomlSection& section, mechanics::Element element,
              const StudyDirection& along) {
  check_keys_of_type(section, iwan);
  const std::vector<StudySlider> sliders = read_sliders(reading, section, element.rotational);
  check_one_law(reading, section, mechanics::kind_of(element), element.law);
  element.parts = sliders.size();
  for (const StudySlider& slider : sliders) {
    add_element(reading, section, element, along, {slider.stiffness, slider.force});
    element.parts = 0;
  }
}

// The numbers that the element has under its law; its table stands in place of its first.
std::array<StudyValue, mechanics::numbers_of_an_element> read_numbers(
    NetworkReading& reading, const TomlSection& section, const mechanics::Element& element,
    const StudyCharacteristic& characteristic) {
  using Kind = StudyCharacteristic::Kind;
  const auto keys = mechanics::kind_of(element).values();
  const bool has_table = characteristic.kind == Kind::table || characteristic.kind == Kind::curve;
  std::array<StudyValue, mechanics::numbers_of_an_element> numbers;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const ValueKey& value = *keys[i];
    if (!value.exists_under(element.law)) continue;
    if (value.is_optional && !section.find(value.key)) continue;
    numbers[i] = has_table && i == 0
                     ? value_of_table(characteristic)
                     : read_value(reading, section, value.key,
                                  element_quantity(value.dimension, element.rotational), value.range);
  }
  return numbers;
}

void add_of_kind(NetworkReading& reading, const TomlSection& section, const ElementKind& kind,
                 mechanics::Element element, const StudyDirection& along) {
  check_keys_of_type(section, kind.name);
  element.law = read_law(section, kind);
  if (kind.law != nullptr) check_one_law(reading, section, kind, element.law);
  StudyCharacteristic characteristic = read_characteristic(reading, section, element.rotational, element);
  std::array<StudyValue, mechanics::numbers_of_an_element> numbers =
      read_numbers(reading, section, element, characteristic);
  element.has_static_force = kind.can_be_smoothed() && section.find(kind.second.key) != nullptr;
  const std::vector<std::string> names = reading.parameters.names();
  const auto text = [&](const StudyValue& value) { return value.expression.canonical_text(names); };
  // static_force = "F" next to force = "F" is the kinetic force itself.
  if (element.has_static_force && text(numbers[0]) == text(numbers[1])) {
    element.has_static_force = false;
    numbers[1] = {};
  }
  add_element(reading, section, std::move(element), along, std::move(numbers));
  reading.result.values.characteristic.back() = std::move(characteristic);
}

}  // namespace

void read_element(NetworkReading& reading, const TomlValue& table, std::size_t number) {
  const TomlSection section(reading.context.source, table, label(table, "element", "name", "element", number),
                            "element");
  const std::string name = section.identifier("name");
  take_name(reading, section, name, section.where());
  const std::string type = read_type(section);
  const ElementKind& kind = kind_called(type);
  auto [direction, given, rotational] = read_ends(reading, section);
  mechanics::Element element{name, kind.type, std::move(direction)};
  element.rotational = rotational;
  element.twists_ground = given.is_given() ? given.twists_ground : rotational;
  if (type == iwan) return add_iwan(reading, section, std::move(element), given);
  add_of_kind(reading, section, kind, std::move(element), given);
}

}  // namespace frahm::studies
