#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "solvers/flow/sizes.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/rotation.hpp"
#include "studies/reading/direction_reading.hpp"
#include "studies/reading/network_reading.hpp"
#include "studies/reading/spelling.hpp"

namespace frahm::studies {
namespace {

using mechanics::Dimension;
using mechanics::ElementKind;
using mechanics::Node;
using mechanics::NodeKind;
using mechanics::ValueKey;

Quantity quantity_of(Dimension dimension, bool rotational) {
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
  }
  return Quantity::number;
}

// The keys of elements beside name, type and between, each once: values, then the choice of a law and its
// slope.
std::vector<std::string> keys_of_kinds() {
  std::vector<std::string> keys;
  const auto add = [&](const std::string& key) {
    if (!key.empty() && std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  };
  for (const ElementKind& kind : mechanics::element_kinds()) add(kind.value.key);
  for (const ElementKind& kind : mechanics::element_kinds()) add(kind.second.key);
  add("law");
  for (const ElementKind& kind : mechanics::element_kinds()) add(kind.smoothed.key);
  for (const char* key : {"table", "clearance", "tension"}) add(key);
  return keys;
}

const ElementKind& read_kind(const TomlSection& section) {
  const std::string type = section.text("type");
  std::vector<std::string> known;
  for (const ElementKind& kind : mechanics::element_kinds()) {
    if (kind.name == type) return kind;
    known.push_back(kind.name);
  }
  section.fail(rules::unknown_name, "type", "no element is of type \"{}\"{}", type, suggestion(type, known));
}

// Each type has its values and no key of another type.
void check_keys_of_kind(const TomlSection& section, const ElementKind& kind) {
  for (const std::string& key : keys_of_kinds()) {
    const bool of_law = kind.can_be_smoothed() && (key == "law" || key == kind.smoothed.key);
    const bool of_table = kind.table != nullptr && key == "table";
    const bool of_stops = kind.stop != nullptr && (key == "clearance" || key == "tension");
    if (of_law || of_table || of_stops || key == kind.value.key || key == kind.second.key ||
        !section.find(key))
      continue;
    const std::string second = kind.second.exists() ? fmt::format(" and a {}", kind.second.key) : "";
    section.fail(rules::unknown_key, key, "a {} has a {}{}, no {}", kind.name, kind.value.key, second, key);
  }
}

mechanics::FrictionLaw read_law(const TomlSection& section, const ElementKind& kind) {
  if (!kind.can_be_smoothed()) return mechanics::FrictionLaw::exact;
  if (section.choice_or("law", {"exact", "arctan"}) == "arctan") {
    if (section.find(kind.second.key))
      section.fail(rules::key_without_use, kind.second.key, "only the law \"exact\" has a {}",
                   kind.second.key);
    return mechanics::FrictionLaw::arctan;
  }
  if (section.find(kind.smoothed.key))
    section.fail(rules::key_without_use, kind.smoothed.key, "only the law \"arctan\" has a {}",
                 kind.smoothed.key);
  return mechanics::FrictionLaw::exact;
}

// All contacts follow their law exactly, or all are smoothed.
void check_one_law(const NetworkReading& reading, const TomlSection& section, const ElementKind& kind,
                   mechanics::FrictionLaw law) {
  const auto& elements = reading.result.network.elements;
  const auto other = std::find_if(elements.begin(), elements.end(), [&](const auto& element) {
    return mechanics::has_contact(element) && element.law != law;
  });
  if (other == elements.end()) return;
  const ElementKind& other_kind = mechanics::kind_of(*other);
  if (!kind.can_be_smoothed() || !other_kind.can_be_smoothed()) {
    const bool own = !kind.can_be_smoothed();
    section.fail_here(rules::wrong_law, "a {} has no arctan law, which {} follows",
                      own ? kind.name : other_kind.name,
                      own ? fmt::format("element \"{}\"", other->name) : "this element");
  }
  const bool arctan = law == mechanics::FrictionLaw::arctan;
  const std::string message = fmt::format(
      "\"{}\"{}, but element \"{}\" follows \"{}\"; all coulomb elements of a study follow one law",
      arctan ? "arctan" : "exact", section.find("law") ? "" : " by default", other->name,
      arctan ? "exact" : "arctan");
  section.find("law") ? section.fail(rules::wrong_law, "law", "{}", message)
                      : section.fail_here(rules::wrong_law, "{}", message);
}

std::array<Node, 2> read_between(const NetworkReading& reading, const TomlSection& section) {
  const TomlValue& value = section.require("between");
  const auto* ends = value.as<TomlArray>();
  if (!ends || ends->size() != 2)
    section.fail(rules::wrong_type, "between", "two nodes are expected: between = [\"ground\", \"main\"]");
  std::array<Node, 2> nodes;
  std::array<std::string, 2> names;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string where = fmt::format("{}: between", section.where());
    names[i] = read_text(section.source(), where, (*ends)[i]);
    const auto node = find_node(reading.result.network, names[i]);
    if (!node) {
      throw section.source().error_at(rules::unknown_name, (*ends)[i].position,
                                      "{}: no node is called \"{}\"{}", where, names[i],
                                      suggestion(names[i], node_names(reading.result.network)));
    }
    nodes[i] = *node;
  }
  if (nodes[0] == nodes[1]) section.fail(rules::wrong_node, "between", "both ends are at \"{}\"", names[0]);
  if (nodes[0].kind != NodeKind::mass && nodes[1].kind != NodeKind::mass) {
    section.fail(rules::wrong_node, "between",
                 "neither \"{}\" nor \"{}\" is a mass, so nothing moves the element freely", names[0],
                 names[1]);
  }
  return nodes;
}

// What it rotates by, of two nodes: both rotate, or one does and the other is fixed.
bool is_rotational(const NetworkReading& reading, const TomlSection& section,
                   const std::array<Node, 2>& ends) {
  const mechanics::Network& network = reading.result.network;
  const auto rotates = [&](const Node& node) {
    return node.kind == NodeKind::mass && mechanics::rotates(network, node.index);
  };
  const auto is_free = [](const Node& node) { return node.kind != NodeKind::ground; };
  const bool any = rotates(ends[0]) || rotates(ends[1]);
  for (std::size_t i = 0; i < 2; ++i) {
    if (!any || rotates(ends[i]) || !is_free(ends[i])) continue;
    const std::size_t turning = ends[1 - i].index;
    section.fail(rules::wrong_node, "between",
                 "\"{0}\" turns and the other end moves along; join them by the radius at which they meet: "
                 "along = {{ {0} = {{ value = 0.1, unit = \"m\" }}, ... }}",
                 network.masses[turning]);
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
  if (section.find("between") && section.find("along"))
    section.fail(rules::one_of_two_keys, "along",
                 "the element is between two nodes already; give one of the two");
  if (!section.find("between") && !section.find("along"))
    section.fail_here(rules::one_of_two_keys,
                      "the key \"between\" is missing (or \"along\", for a combination of coordinates)");
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

bool join_the_same_nodes(const mechanics::Direction& a, const mechanics::Direction& b) {
  if (!mechanics::is_between_two_nodes(a) || !mechanics::is_between_two_nodes(b)) return a == b;
  return (a[0].node == b[0].node && a[1].node == b[1].node) ||
         (a[0].node == b[1].node && a[1].node == b[0].node);
}

// Elements along one direction whose law merges are one contact.
std::size_t number_of_contacts(const mechanics::Network& network) {
  std::size_t contacts = 0;
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    const mechanics::Element& element = network.elements[e];
    const ElementKind& kind = mechanics::kind_of(element);
    const auto is_the_same = [&](const mechanics::Element& other) {
      return other.type == element.type && join_the_same_nodes(other.along, element.along);
    };
    const auto own = network.elements.begin() + static_cast<std::ptrdiff_t>(e);
    const bool joins =
        kind.law != nullptr && kind.law->merges && std::any_of(network.elements.begin(), own, is_the_same);
    contacts += kind.law != nullptr && !joins;
  }
  return contacts;
}

// The exact law knows which contacts stick by the bits of a word.
void check_number_of_contacts(const NetworkReading& reading, const TomlSection& section,
                              const mechanics::Element& element) {
  if (!mechanics::has_contact(element) || element.law != mechanics::FrictionLaw::exact) return;
  const std::size_t contacts = number_of_contacts(reading.result.network);
  if (contacts <= periodic::kMostContacts) return;
  section.fail_here(
      rules::too_large,
      "the {}th friction contact; at most {} are followed exactly (law = \"arctan\" has no limit)", contacts,
      periodic::kMostContacts);
}

// The value of an element with a table follows from its points.
StudyValue value_of_table(const StudyCharacteristic& table) {
  return {.where = table.where, .position = table.position};
}

}  // namespace

void read_element(NetworkReading& reading, const TomlValue& table, std::size_t number) {
  std::vector<std::string> keys{"name", "type", "between", "along"};
  for (std::string& key : keys_of_kinds()) keys.push_back(std::move(key));
  const TomlSection section(reading.context.source, table, label(table, "element", "name", "element", number),
                            keys);
  const std::string name = section.identifier("name");
  take_name(reading, section, name, section.where());
  const ElementKind& kind = read_kind(section);
  check_keys_of_kind(section, kind);
  auto [direction, given, rotational] = read_ends(reading, section);
  const mechanics::FrictionLaw law = read_law(section, kind);
  if (kind.law != nullptr) check_one_law(reading, section, kind, law);
  mechanics::Element element{name, kind.type, std::move(direction), law};
  element.rotational = rotational;
  element.twists_ground = given.is_given() ? given.twists_ground : rotational;
  StudyCharacteristic characteristic = read_characteristic(reading, section, rotational, element);
  element.has_static_force = kind.can_be_smoothed() && section.find(kind.second.key) != nullptr;
  reading.result.network.elements.push_back(element);
  check_number_of_contacts(reading, section, element);
  const auto read = [&](const ValueKey& value) {
    const bool may_be_absent = kind.second_is_optional && std::string(value.key) == kind.second.key;
    return read_value(reading, section, value.key, quantity_of(value.dimension, rotational), value.range,
                      may_be_absent ? std::optional(0.0) : std::nullopt);
  };
  const ValueKey& second = mechanics::second_key(element);
  const bool has_table = characteristic.kind == StudyCharacteristic::Kind::table;
  reading.result.values.element.push_back(has_table ? value_of_table(characteristic) : read(kind.value));
  reading.result.values.second.push_back(second.exists() ? read(second) : StudyValue{});
  reading.result.values.along.push_back(std::move(given));
  reading.result.values.characteristic.push_back(std::move(characteristic));
}

}  // namespace frahm::studies
