#include "studies/reading/system/excitation_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include "solvers/mechanics/rotation.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/quantities/expression.hpp"
#include "studies/reading/study/study_values.hpp"
#include "studies/reading/system/corner_reading.hpp"
#include "studies/reading/system/network_reading.hpp"
#include "studies/reading/system/period_file.hpp"
#include "studies/reading/system/recorded_excitation.hpp"

namespace frahm::studies {
namespace {

using mechanics::Excitation;
using mechanics::ExcitationKind;
using mechanics::Node;
using mechanics::NodeKind;

// Each order has two oscillators in the flow: a hundred take about 15 ms an orbit, 200 about 80 ms and 200
// MB.
constexpr std::size_t most_orders = 200;

const std::string force_path = "excitation.force";
const std::string motion_path = "excitation.motion";

int read_order(const TomlSection& section, const std::string& key) {
  return static_cast<int>(section.integer(key));
}

// "harmonic", "crank" or "file", and no key of the others.
std::string read_profile(const TomlSection& section) {
  std::string profile = section.choice("profile");
  section.keep_to(profile);
  return profile;
}

// The amplitude of a motion is that of its displacement, velocity or acceleration.
std::string key_of_amplitude(const TomlSection& section) {
  for (const char* key : {"velocity", "acceleration"})
    if (section.find(key)) return key;
  return "amplitude";
}

// A motion of order 0 that has a velocity moves on for ever: V cos(phase) t.
bool is_belt(const std::string& key, const Excitation& component) {
  return component.kind == ExcitationKind::motion && key == "velocity" && component.order == 0;
}

// v cos(w t + p) is the velocity of  v/w cos(w t + p - pi/2), a cos(w t + p) the acceleration of
// a/w^2 cos(w t + p + pi), w = order x frequency.
void read_rate(NetworkReading& reading, const TomlSection& section, const std::string& key, int order,
               StudyValue& amplitude, StudyValue& phase) {
  const bool is_velocity = key == "velocity";
  if (order == 0)
    section.fail(rules::beyond_schema(rules::key_without_use), key,
                 "a motion of order 0 has a constant displacement, or a constant velocity");
  amplitude = read_value(reading, section, key, is_velocity ? Quantity::speed : Quantity::acceleration);
  const Expression rate = Expression(order) * reading.result.values.omega.expression;
  amplitude.expression = is_velocity ? amplitude.expression / rate : amplitude.expression / rate / rate;
  amplitude.quantity = Quantity::length;
  constexpr double pi = std::numbers::pi;
  phase.expression = phase.expression + Expression(is_velocity ? -0.5 * pi : pi);
}

// What belongs to corners alone.
void refuse_keys_of_corners(const TomlSection& section) {
  for (const char* key : {"scale", "orders"}) {
    if (section.find(key))
      section.fail(rules::beyond_schema(rules::key_without_use), key,
                   "belongs to a list of corners, not to a harmonic");
  }
}

void read_component(NetworkReading& reading, const TomlSection& section, Excitation component) {
  if (const auto key = corner_key(section)) {
    const NodeKind kind = component.kind == ExcitationKind::force ? NodeKind::mass : NodeKind::prescribed;
    return read_corners(reading, section, *key, {kind, component.node});
  }
  refuse_keys_of_corners(section);
  auto& [network, values, driving] = reading.result;
  const bool is_force = component.kind == ExcitationKind::force;
  component.order = read_order(section, "order");
  const std::string key = is_force ? "amplitude" : key_of_amplitude(section);
  if (is_belt(key, component)) component.kind = ExcitationKind::belt;
  network.excitations.push_back(component);
  StudyValue amplitude, phase = read_value(reading, section, "phase", Quantity::angle, 0.0);
  if (key == "amplitude") {
    const bool is_torque = is_force && mechanics::rotates(network, component.node);
    const Quantity quantity = is_torque ? Quantity::torque : is_force ? Quantity::force : Quantity::length;
    amplitude = read_value(reading, section, key, quantity);
  } else if (component.kind == ExcitationKind::belt) {
    amplitude = read_value(reading, section, key, Quantity::speed);
  } else {
    read_rate(reading, section, key, component.order, amplitude, phase);
  }
  values.amplitude.push_back(std::move(amplitude));
  values.phase.push_back(std::move(phase));
  values.rod.push_back({});
}

// The number of its even orders depends on crank/rod over the whole study: set_crank_orders().
void read_crank(NetworkReading& reading, const TomlSection& section, Excitation component) {
  auto& [network, values, driving] = reading.result;
  const std::int64_t taylor_order = section.find("taylor_order") ? section.integer("taylor_order") : 0;
  component.taylor_order = static_cast<int>(taylor_order);
  component.even_orders = component.taylor_order / 2;
  network.excitations.push_back(component);
  values.amplitude.push_back(read_value(reading, section, "crank", Quantity::length));
  values.rod.push_back(read_value(reading, section, "rod", Quantity::length));
  values.phase.push_back(read_value(reading, section, "phase", Quantity::angle, 0.0));
}

void read_force(NetworkReading& reading, const TomlValue& table, std::size_t number) {
  const std::string named = find_entry(table, "node") ? "node" : "on";
  const TomlSection section(reading.context.source, table,
                            label(table, "force on", named, force_path, number), force_path);
  const std::size_t node = read_forced_node(section, reading.result.network, named);
  if (read_profile(section) == "file") return read_period_file(reading, section, {NodeKind::mass, node});
  read_component(reading, section, {ExcitationKind::force, node});
}

TomlSection motion_section(const NetworkReading& reading, const TomlValue& table, std::size_t number) {
  return {reading.context.source, table, label(table, "motion of", "node", motion_path, number), motion_path};
}

void read_motion(NetworkReading& reading, const TomlValue& table, std::size_t number) {
  const TomlSection section = motion_section(reading, table, number);
  const auto node = find_node(reading.result.network, section.identifier("node"));
  const std::string profile = read_profile(section);
  if (profile == "file") {
    read_period_file(reading, section, *node);
  } else if (profile == "crank") {
    read_crank(reading, section, {ExcitationKind::crank, node->index});
  } else {
    read_component(reading, section, {ExcitationKind::motion, node->index});
  }
}

// A node of prescribed motion, perhaps named before: its motions add up.
void name_support(NetworkReading& reading, const TomlSection& section, const std::string& key,
                  const std::string& name) {
  auto& network = reading.result.network;
  const auto node = find_node(network, name);
  if (!node) {
    network.prescribed.push_back(name);
    reading.names.push_back({name, fmt::format("the node \"{}\" of prescribed motion", name)});
  } else if (node->kind == NodeKind::ground) {
    section.fail(rules::wrong_node, key, "\"ground\" is fixed; give the moving support a different name");
  } else if (node->kind == NodeKind::mass || node->kind == NodeKind::joint) {
    section.fail(
        rules::wrong_node, key,
        "\"{}\" is a mass, whose motion is unknown; give the node of prescribed motion a different name",
        name);
  }
}

// Whether something needs the frequency: a harmonic, or a hysteretic element, whose damping is at one.
bool needs_frequency(const mechanics::Network& network) {
  return mechanics::frequency_dependent_element(network) ||
         std::ranges::any_of(network.excitations, [](const Excitation& each) { return each.order > 0; });
}

// The lowest order above 0; 1 for constant forces alone, where these are allowed.
int lowest_order(const NetworkReading& reading, const TomlSection& section, bool constant_will_do) {
  int lowest = std::numeric_limits<int>::max();
  for (const Excitation& component : reading.result.network.excitations) {
    if (component.order > 0) lowest = std::min(lowest, component.order);
  }
  if (lowest == std::numeric_limits<int>::max()) {
    if (constant_will_do && !reading.result.network.excitations.empty()) return 1;
    section.fail_here(rules::beyond_schema(rules::missing_section),
                      "nothing excites the system: it needs an [[excitation.force]] or [[excitation.motion]] "
                      "of order 1 or more");
  }
  return lowest;
}

void check_number_of_orders(const NetworkReading& reading, const TomlSection& section) {
  std::set<int> orders;
  for (const Excitation& component : reading.result.network.excitations) orders.insert(component.order);
  if (orders.size() <= most_orders) return;
  section.fail_here(rules::too_large, "its components have {} orders: at most {}", orders.size(),
                    most_orders);
}

// A hysteretic element has its damping at one frequency only, omega_h.
void check_hysteretic_frequency(const NetworkReading& reading, const TomlSection& section) {
  const auto& network = reading.result.network;
  const mechanics::Element* hysteretic = mechanics::frequency_dependent_element(network);
  if (!hysteretic || section.find("reference_order")) return;
  std::vector<int> orders;
  for (const Excitation& component : network.excitations) {
    if (component.order > 0) orders.push_back(component.order);
    if (component.kind == ExcitationKind::crank && component.taylor_order != 1) orders.push_back(2);
  }
  if (std::all_of(orders.begin(), orders.end(), [&](int order) { return order == orders.front(); })) return;
  section.fail_here(rules::missing_key,
                    "the key \"reference_order\" is missing: the excitation has several orders, and the loss "
                    "factor of the hysteretic element \"{}\" holds at reference_order x frequency",
                    hysteretic->name);
}

}  // namespace

void read_prescribed_nodes(NetworkReading& reading, const TomlValue& excitation) {
  std::size_t number = 0;
  for (const TomlValue* table : read_tables(reading.context.source, excitation, motion_path)) {
    const TomlSection section = motion_section(reading, *table, ++number);
    name_support(reading, section, "node", section.identifier("node"));
  }
  for (const TomlSection& section : record_sections(reading.context.source, excitation)) {
    const RecordedPlace place = place_of(section);
    if (place.of == transient::RecordOf::force) continue;
    name_support(reading, section, place.key, section.identifier(place.key));
  }
}

void read_excitation(NetworkReading& reading, const TomlValue& excitation, bool constant_will_do) {
  const TomlSection section(reading.context.source, excitation, "[excitation]", "excitation");
  reading.result.values.omega = read_value(reading, section, "frequency", Quantity::angular_frequency, 1.0);
  std::size_t number = 0;
  for (const TomlValue* table : read_tables(section.source(), excitation, force_path)) {
    read_force(reading, *table, ++number);
  }
  number = 0;
  for (const TomlValue* table : read_tables(section.source(), excitation, motion_path)) {
    read_motion(reading, *table, ++number);
  }
  read_recorded_components(reading, excitation);
  if (!section.find("frequency") && (!constant_will_do || needs_frequency(reading.result.network)))
    section.fail_here(rules::beyond_schema(rules::missing_key),
                      "the key \"frequency\" is missing (an angular frequency, rad/s)");
  check_number_of_orders(reading, section);
  const int lowest = lowest_order(reading, section, constant_will_do);
  auto& reference = reading.result.network.reference_order;
  reference = section.find("reference_order") ? read_order(section, "reference_order") : lowest;
  check_hysteretic_frequency(reading, section);
}

}  // namespace frahm::studies
