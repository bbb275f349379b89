#include "studies/reading/network_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "solvers/mechanics/element_table.hpp"
#include "studies/reading/spelling.hpp"

namespace frahm::studies {
namespace {

using mechanics::Dimension;
using mechanics::ElementKind;
using mechanics::Node;
using mechanics::NodeKind;
using mechanics::ValueKey;

Quantity quantity_of(Dimension dimension) {
  switch (dimension) {
    case Dimension::number:
      break;
    case Dimension::stiffness:
      return Quantity::stiffness;
    case Dimension::damping:
      return Quantity::damping;
    case Dimension::inertance:
      return Quantity::inertance;
    case Dimension::force:
      return Quantity::force;
    case Dimension::inverse_speed:
      return Quantity::inverse_speed;
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
    if (of_law || key == kind.value.key || key == kind.second.key || !section.find(key)) continue;
    const std::string second = kind.second.exists() ? fmt::format(" and a {}", kind.second.key) : "";
    section.fail(rules::unknown_key, key, "a {} has a {}{}, no {}", kind.name, kind.value.key, second, key);
  }
}

mechanics::FrictionLaw read_law(const TomlSection& section, const ElementKind& kind) {
  if (!kind.can_be_smoothed()) return mechanics::FrictionLaw::exact;
  if (section.choice_or("law", {"exact", "arctan"}) == "arctan") return mechanics::FrictionLaw::arctan;
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

void read_mass(NetworkReading& reading, const TomlValue& table, std::size_t number) {
  const TomlSection section(reading.context.source, table, label(table, "mass", "name", "mass", number),
                            {"name", "mass"});
  const std::string name = section.identifier("name");
  take_name(reading, section, name, section.where());
  reading.result.network.masses.push_back(name);
  reading.masses.push_back(section.position());
  reading.result.values.mass.push_back(
      read_value(reading, section, "mass", Quantity::mass, Range::not_negative));
}

void read_element(NetworkReading& reading, const TomlValue& table, std::size_t number) {
  std::vector<std::string> keys{"name", "type", "between"};
  for (std::string& key : keys_of_kinds()) keys.push_back(std::move(key));
  const TomlSection section(reading.context.source, table, label(table, "element", "name", "element", number),
                            keys);
  const std::string name = section.identifier("name");
  take_name(reading, section, name, section.where());
  const ElementKind& kind = read_kind(section);
  check_keys_of_kind(section, kind);
  const auto [a, b] = read_between(reading, section);
  const mechanics::FrictionLaw law = read_law(section, kind);
  if (kind.law != nullptr) check_one_law(reading, section, kind, law);
  const mechanics::Element element{name, kind.type, a, b, law};
  reading.result.network.elements.push_back(element);
  const auto read = [&](const ValueKey& value) {
    return read_value(reading, section, value.key, quantity_of(value.dimension), value.range);
  };
  const ValueKey& second = mechanics::second_key(element);
  reading.result.values.element.push_back(read(kind.value));
  reading.result.values.second.push_back(second.exists() ? read(second) : StudyValue{});
}

// A value that is a parameter alone, perhaps through other names, determines that parameter's quantity.
void note_quantity(Parameters& parameters, const StudyValue& value) {
  auto parameter = value.expression.sole_parameter();
  for (std::size_t steps = 0; parameter && steps <= parameters.list.size(); ++steps) {
    Parameter& named = parameters.list[*parameter];
    if (named.is_number()) {
      if (named.quantity) return;
      named.quantity = value.quantity;
      named.used_as = value.where;
      return;
    }
    const auto* expression = std::get_if<Expression>(&named.definition);
    parameter = expression ? expression->sole_parameter() : std::nullopt;
  }
}

void check_every_motion_is_felt(const NetworkReading& reading, const TomlValue& excitation) {
  const auto& network = reading.result.network;
  for (const TomlValue* table : read_tables(reading.context.source, excitation, "excitation.motion")) {
    const std::string& name = *find_entry(*table, "node")->value.as<std::string>();
    const Node node = *find_node(network, name);
    const bool felt = std::any_of(network.elements.begin(), network.elements.end(), [&](const auto& element) {
      return element.a == node || element.b == node;
    });
    if (felt) continue;
    throw reading.context.source.error_at(rules::wrong_node, table->position,
                                          "motion of \"{0}\": no element is attached to the node \"{0}\"",
                                          name);
  }
}

}  // namespace

void take_name(NetworkReading& reading, const TomlSection& section, const std::string& name,
               const std::string& owner) {
  for (const auto& taken : reading.names) {
    if (taken.name != name) continue;
    section.fail(rules::name_taken, "name",
                 "the name is taken by {}; nodes and elements need different names", taken.owner);
  }
  reading.names.push_back({name, owner});
}

std::optional<Node> find_node(const mechanics::Network& network, const std::string& name) {
  if (name == "ground") return Node{NodeKind::ground, 0};
  const auto index_in = [&](const std::vector<std::string>& names) -> std::optional<std::size_t> {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) return std::nullopt;
    return static_cast<std::size_t>(found - names.begin());
  };
  if (const auto index = index_in(network.masses)) return Node{NodeKind::mass, *index};
  if (const auto index = index_in(network.prescribed)) return Node{NodeKind::prescribed, *index};
  return std::nullopt;
}

std::vector<std::string> node_names(const mechanics::Network& network) {
  std::vector<std::string> names{"ground"};
  names.insert(names.end(), network.masses.begin(), network.masses.end());
  names.insert(names.end(), network.prescribed.begin(), network.prescribed.end());
  return names;
}

StudyValue read_value(NetworkReading& reading, const TomlSection& section, const std::string& key,
                      Quantity quantity, Range range, std::optional<double> otherwise) {
  StudyValue result;
  result.quantity = quantity;
  result.range = range;
  result.where = fmt::format("{}: {}", section.where(), key);
  result.position = section.position();
  const TomlValue* value = section.find(key);
  if (!value && otherwise) {
    result.expression = Expression(*otherwise);
    return result;
  }
  if (!value) {
    const bool pure = quantity == Quantity::number;
    section.fail_here(rules::missing_key, "the key \"{}\" is missing ({}{}{})", key, quantity_name(quantity),
                      pure ? "" : ", ", pure ? "" : written_si_unit(quantity));
  }
  result.position = value->position;
  if (value->as<std::string>()) {
    result.expression =
        read_expression(reading.context, reading.parameters, result.where, *value, wanted_by_key(quantity));
    note_quantity(reading.parameters, result);
    if (quantity != Quantity::angular_frequency) return result;
    for (const std::size_t i : reading.parameters.inputs_of(result.expression.reads())) {
      reading.parameters.list[i].in_frequency = true;
    }
    return result;
  }
  const NumberWithUnit number = read_number_with_unit(reading.context, result.where, *value);
  try {
    result.expression = Expression(number.value * (number.unit ? si_factor(*number.unit, quantity) : 1.0));
  } catch (const UnitError& error) {
    throw section.source().error_at(error.rule(), number.unit_position, "{}: {}", result.where, error.what());
  }
  return result;
}

std::optional<StudyValue> read_optional(NetworkReading& reading, const TomlSection& section,
                                        const std::string& key, Quantity quantity, Range range) {
  if (!section.find(key)) return std::nullopt;
  return read_value(reading, section, key, quantity, range);
}

NetworkOfStudy read_network(const StudyContext& context, const TomlValue& root, Parameters& parameters,
                            StudyKind kind) {
  const TomlEntry* excitation = find_entry(root, "excitation");
  const bool is_forced = kind == StudyKind::identify ? excitation != nullptr : kind != StudyKind::decay;
  NetworkReading reading(context, parameters);
  std::size_t number = 0;
  for (const TomlValue* table : read_tables(context.source, root, "mass"))
    read_mass(reading, *table, ++number);
  if (number == 0)
    throw context.source.error_at(
        rules::missing_section, root.position, "the study has no [[mass]]: nothing moves{}",
        kind == StudyKind::identify ? "; leave out all of the system, or add its masses" : "");
  if (is_forced && !excitation)
    throw context.source.error_at(rules::missing_section, root.position, "the study has no [excitation]");
  if (is_forced) read_prescribed_nodes(reading, excitation->value);
  number = 0;
  for (const TomlValue* table : read_tables(context.source, root, "element"))
    read_element(reading, *table, ++number);
  if (is_forced) {
    read_excitation(reading, excitation->value, kind == StudyKind::transient || kind == StudyKind::identify);
    check_every_motion_is_felt(reading, excitation->value);
  }
  check_masses_are_held(context, reading.result, reading.masses);
  return std::move(reading.result);
}

}  // namespace frahm::studies
