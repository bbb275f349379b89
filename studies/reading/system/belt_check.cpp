#include "studies/reading/system/belt_check.hpp"

#include <fmt/format.h>

#include "solvers/mechanics/element_table.hpp"
#include "studies/reading/system/network_reading.hpp"

namespace frahm::studies {
namespace {

// Whether the element's force depends on its displacement, not on its rate alone.
bool asks_for_displacement(const mechanics::Element& element) {
  const mechanics::ElementKind& kind = mechanics::kind_of(element);
  return kind.holds || kind.stop != nullptr;
}

bool is_on_belt(const mechanics::Network& network, const mechanics::Node& node) {
  return mechanics::is_on_belt(network, {{node, 1.0}});
}

}  // namespace

void check_belts(const NetworkReading& reading, StudyKind kind) {
  const mechanics::Network& network = reading.result.network;
  const auto& values = reading.result.values;
  if (!mechanics::has_belt(network) || kind == StudyKind::transient) return;
  const StudySource& source = reading.context.source;
  const auto name = [&](const mechanics::Node& node) { return network.prescribed[node.index]; };
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    const mechanics::Element& element = network.elements[e];
    if (!asks_for_displacement(element)) continue;
    for (const mechanics::Share& share : element.along) {
      if (!is_on_belt(network, share.node)) continue;
      throw source.error_at(
          rules::wrong_node, values.value(e).position,
          "{}: \"{}\" moves for ever at a constant velocity, so the force of a {} would grow with its "
          "displacement; only coulomb, damper, inerter, maxwell and jenkins elements may touch it (in a "
          "transient any element)",
          values.value(e).where, name(share.node), mechanics::kind_of(element).name);
    }
  }
  for (std::size_t i = 0; i < values.signals.size(); ++i) {
    for (const mechanics::Node& node : values.signals[i].nodes) {
      if (!is_on_belt(network, node)) continue;
      throw source.error_at(
          rules::wrong_node, values.signals[i].position,
          "signal \"{}\": \"{}\" moves for ever at a constant velocity, and so would the signal (a transient "
          "may have it)",
          network.signals[i].name, name(node));
    }
  }
}

}  // namespace frahm::studies
