#include "studies/reading/system/network_reading.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "studies/reading/keys/study_keys.hpp"
#include "studies/reading/quantities/expression.hpp"
#include "studies/reading/study/dimension_check.hpp"
#include "studies/reading/study/parameter_reading.hpp"
#include "studies/reading/system/belt_check.hpp"
#include "studies/reading/system/connectivity.hpp"
#include "studies/reading/system/corner_reading.hpp"
#include "studies/reading/system/damping_reading.hpp"
#include "studies/reading/system/element_reading.hpp"
#include "studies/reading/system/excitation_reading.hpp"
#include "studies/reading/system/joint_check.hpp"
#include "studies/reading/system/matrices_reading.hpp"
#include "studies/reading/system/network_limits.hpp"
#include "studies/reading/system/recorded_excitation.hpp"
#include "studies/reading/system/signal_reading.hpp"
#include "studies/reading/text/spelling.hpp"

namespace frahm::studies {
namespace {

using mechanics::Node;
using mechanics::NodeKind;

// Whether an inerter ends at the node.
bool has_inerter(const StudyContext& context, const TomlValue& root, const std::string& node) {
  const auto ends_there = [&](const TomlValue* element) {
    const TomlEntry *type = find_entry(*element, "type"), *between = find_entry(*element, "between"),
                    *along = find_entry(*element, "along");
    const auto is = [](const TomlValue& value, std::string_view text) {
      return value.as<std::string>() && *value.as<std::string>() == text;
    };
    if (!type || !is(type->value, "inerter")) return false;
    if (along && along->value.as<TomlTable>()) return find_entry(along->value, node) != nullptr;
    const auto* ends = between ? between->value.as<TomlArray>() : nullptr;
    return ends && std::ranges::any_of(*ends, [&](const TomlValue& end) { return is(end, node); });
  };
  return std::ranges::any_of(read_tables(context.source, root, "element"), ends_there);
}

// A mass of zero without an inerter is a joint, where springs and dampers meet.
void read_mass(NetworkReading& reading, const TomlValue& root, const TomlValue& table, std::size_t number) {
  const TomlSection section(reading.context.source, table, label(table, "mass", "name", "mass", number),
                            "mass");
  const std::string name = section.identifier("name");
  take_name(reading, section, name, section.where());
  const bool rotates = section.find("inertia") != nullptr;
  StudyValue mass = rotates ? read_value(reading, section, "inertia", Quantity::inertia)
                            : read_value(reading, section, "mass", Quantity::mass);
  mechanics::Network& network = reading.result.network;
  if (mass.expression.is_constant() && mass.expression.evaluate(std::span<const double>{}) == 0.0 &&
      !has_inerter(reading.context, root, name)) {
    network.joints.push_back(name);
    network.joint_rotation.push_back(rotates);
    reading.joints.push_back({section.position(), section.where()});
  } else {
    network.masses.push_back(name);
    network.rotation.push_back(rotates);
    reading.masses.push_back(section.position());
    reading.result.values.mass.push_back(std::move(mass));
  }
  check_number_of_states(reading, section);
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
  const auto check = [&](const std::string& name, const Position& position, const std::string& where) {
    const Node node = *find_node(network, name);
    const bool felt = std::any_of(network.elements.begin(), network.elements.end(), [&](const auto& element) {
      return std::ranges::find(element.along, node, &mechanics::Share::node) != element.along.end();
    });
    if (felt) return;
    throw reading.context.source.error_at(rules::wrong_node, position,
                                          "{}: no element is attached to the node \"{}\"", where, name);
  };
  for (const TomlValue* table : read_tables(reading.context.source, excitation, "excitation.motion")) {
    const std::string& name = *find_entry(*table, "node")->value.as<std::string>();
    check(name, table->position, fmt::format("motion of \"{}\"", name));
  }
  for (const TomlSection& section : record_sections(reading.context.source, excitation)) {
    const RecordedPlace place = place_of(section);
    if (place.of != transient::RecordOf::force) check(place.node, section.position(), section.where());
  }
}

}  // namespace

void keep_name_of_damping(NetworkReading& reading) {
  reading.names.push_back({"damping", "the damping of the structure"});
}

void take_name(NetworkReading& reading, const TomlSection& section, const std::string& name,
               const std::string& owner) {
  for (const auto& taken : reading.names) {
    if (taken.name != name) continue;
    section.fail(rules::name_taken, "name",
                 "the name is already that of {}; nodes, elements and signals need different names",
                 taken.owner);
  }
  reading.names.push_back({name, owner});
}

std::optional<Node> find_node(const mechanics::Network& network, const std::string& name) {
  if (name == "ground") return Node{NodeKind::ground, 0};
  if (const auto mass = place_among(network.masses, name)) return Node{NodeKind::mass, *mass};
  if (const auto support = place_among(network.prescribed, name)) return Node{NodeKind::prescribed, *support};
  if (const auto joint = place_among(network.joints, name)) return Node{NodeKind::joint, *joint};
  return std::nullopt;
}

mechanics::Node read_mass(const TomlSection& section, const mechanics::Network& network,
                          const std::string& key, std::string_view need) {
  const std::string name = section.text(key);
  const auto node = find_node(network, name);
  if (!node) section.fail(rules::unknown_name, key, "{}", none_called("mass", name, network.masses));
  if (node->kind != NodeKind::mass)
    section.fail(rules::wrong_node, key, "\"{}\" is {}; {}", name,
                 node->kind == NodeKind::ground ? "fixed"
                 : node->kind == NodeKind::joint
                     ? "a joint without mass, which starts where its springs balance"
                     : "a node of prescribed motion",
                 need);
  return *node;
}

std::size_t read_forced_node(const TomlSection& section, const mechanics::Network& network,
                             const std::string& key) {
  if (const auto joint = place_among(network.joints, section.text(key)))
    return network.masses.size() + *joint;
  return read_mass(section, network, key, "a force must act on a mass").index;
}

std::vector<std::string> node_names(const mechanics::Network& network) {
  std::vector<std::string> names{"ground"};
  names.insert(names.end(), network.masses.begin(), network.masses.end());
  names.insert(names.end(), network.joints.begin(), network.joints.end());
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
    section.fail_here(rules::missing_key_of_table, "the key \"{}\" is missing ({}{}{})", key,
                      quantity_name(quantity), pure ? "" : ", ", pure ? "" : written_si_unit(quantity));
  }
  return read_value_at(reading, result.where, *value, quantity, range);
}

StudyValue read_value(NetworkReading& reading, const TomlSection& section, const std::string& key,
                      Quantity quantity, std::optional<double> otherwise) {
  return read_value(reading, section, key, quantity, range_in(section, key), otherwise);
}

Range range_in(const TomlSection& section, std::string_view key) {
  const Limits& limits = section.limits(key);
  if (limits.least != 0.0) return Range::finite;
  return limits.above ? Range::positive : Range::not_negative;
}

StudyValue read_value_at(NetworkReading& reading, const std::string& where, const TomlValue& value,
                         Quantity quantity, Range range) {
  StudyValue result{.quantity = quantity, .range = range, .where = where, .position = value.position};
  if (value.as<std::string>()) {
    result.expression =
        read_expression(reading.context, reading.parameters, result.where, value, wanted_by_key(quantity));
    note_quantity(reading.parameters, result);
    if (quantity != Quantity::angular_frequency) return result;
    for (const std::size_t i : reading.parameters.inputs_of(result.expression.reads())) {
      reading.parameters.list[i].in_frequency = true;
    }
    return result;
  }
  const NumberWithUnit number = read_number_with_unit(reading.context, result.where, value);
  try {
    if (number.unit) result.unit = {number.unit->text, si_factor(*number.unit, quantity)};
    result.expression = Expression(number.value * result.unit.si_factor);
  } catch (const UnitError& error) {
    throw reading.context.source.error_at(error.rule(), number.unit_position, "{}: {}", result.where,
                                          error.what());
  }
  return result;
}

std::optional<StudyValue> read_optional(NetworkReading& reading, const TomlSection& section,
                                        const std::string& key, Quantity quantity) {
  if (!section.find(key)) return std::nullopt;
  return read_value(reading, section, key, quantity);
}

NetworkOfStudy read_network(const StudyContext& context, const TomlValue& root,
                            const std::filesystem::path& folder, Parameters& parameters, StudyKind kind) {
  const TomlEntry* excitation = find_entry(root, "excitation");
  const bool is_forced = excitation != nullptr;  // the table of keys says which kinds need or have one
  NetworkReading reading(context, parameters);
  reading.folder = folder;
  if (find_entry(root, "damping")) keep_name_of_damping(reading);
  std::size_t number = 0;
  for (const TomlValue* table : read_tables(context.source, root, "mass"))
    read_mass(reading, root, *table, ++number);
  read_matrices(reading, root, folder);
  if (reading.result.network.masses.empty() && !reading.joints.empty())
    throw context.source.error_at(
        rules::beyond_schema(rules::missing_section), reading.joints.front().position,
        "{}: every mass is 0: nothing has a motion of its own", reading.joints.front().where);
  if (reading.result.network.masses.empty())
    throw context.source.error_at(
        rules::beyond_schema(rules::missing_section), root.position,
        "the study has no [[mass]] and no [[matrices]]: nothing moves{}",
        kind == StudyKind::identify ? "; leave out the whole system, or add its masses" : "");
  const bool has_record = is_forced && find_entry(excitation->value, "record");
  reading.follows_time = kind == StudyKind::transient || (kind == StudyKind::tune && has_record);
  if (is_forced) refuse_records(context, excitation->value, kind);
  if (is_forced) read_prescribed_nodes(reading, excitation->value);
  number = 0;
  for (const TomlValue* table : read_tables(context.source, root, "element"))
    read_element(reading, *table, ++number);
  check_joints(reading);
  read_damping(reading, root);
  if (is_forced) {
    const bool may_be_constant = reading.follows_time || kind == StudyKind::identify;
    read_excitation(reading, excitation->value, may_be_constant);
    check_jumps(reading);
    check_every_motion_is_felt(reading, excitation->value);
  }
  read_signals(reading, root);
  check_belts(reading, kind);
  check_masses_are_held(context, reading.result, reading.masses, kind);
  return std::move(reading.result);
}

}  // namespace frahm::studies
