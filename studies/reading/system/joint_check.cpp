#include "studies/reading/system/joint_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <vector>

#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/joints.hpp"
#include "studies/reading/study/study_values.hpp"

namespace frahm::studies {
namespace {

using mechanics::Element;
using mechanics::NodeKind;

const mechanics::Share* joint_of(const Element& element) {
  const auto joint = std::ranges::find_if(
      element.along, [](const mechanics::Share& share) { return share.node.kind == NodeKind::joint; });
  return joint == element.along.end() ? nullptr : &*joint;
}

// Joints that springs join to a mass, to the ground or to a support, be it through other joints.
std::vector<bool> held_joints(const NetworkReading& reading) {
  const mechanics::Network& network = reading.result.network;
  const auto is_absent = [](const StudyValue& stiffness) {
    return stiffness.is_given() && stiffness.expression.is_constant() &&
           stiffness.expression.evaluate(std::span<const double>{}) == 0.0;
  };
  std::vector<bool> held(network.joints.size(), false);
  const auto is_held = [&](const mechanics::Share& share) {
    return share.node.kind != NodeKind::joint || held[share.node.index];
  };
  for (std::size_t round = 0; round < held.size(); ++round) {
    for (std::size_t e = 0; e < network.elements.size(); ++e) {
      const Element& element = network.elements[e];
      if (!mechanics::kind_of(element).holds || is_absent(reading.result.values.value(e))) continue;
      if (std::ranges::none_of(element.along, is_held)) continue;
      for (const mechanics::Share& share : element.along)
        if (share.node.kind == NodeKind::joint) held[share.node.index] = true;
    }
  }
  return held;
}

}  // namespace

void check_joints(const NetworkReading& reading) {
  const mechanics::Network& network = reading.result.network;
  if (network.joints.empty()) return;
  const StudySource& source = reading.context.source;
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    const Element& element = network.elements[e];
    const mechanics::Share* joint = joint_of(element);
    if (joint == nullptr) continue;
    const std::string instead = mechanics::instead_at_joint(element);
    if (instead.empty()) continue;
    throw source.error_at(rules::wrong_node, reading.result.values.value(e).position,
                          "element \"{}\": \"{}\" is a joint without mass, at which a {} cannot end; {}",
                          element.name, network.joints[joint->node.index], mechanics::kind_of(element).name,
                          instead);
  }
  if (!reading.context.is_whole) return;
  const std::vector<bool> held = held_joints(reading);
  for (std::size_t j = 0; j < held.size(); ++j) {
    if (held[j]) continue;
    throw source.error_at(
        rules::floating_mass, reading.joints[j].position,
        "{}: a joint without mass that no spring holds; add a spring to a mass, to the ground "
        "or to a node of prescribed motion, or give the joint a mass or an inerter",
        reading.joints[j].where);
  }
}

}  // namespace frahm::studies
