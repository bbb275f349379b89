#include "solvers/mechanics/rotation.hpp"

#include <algorithm>
#include <utility>

namespace frahm::mechanics {
namespace {

constexpr std::pair<std::string_view, std::string_view> kUnits[] = {
    {"m", "rad"}, {"m s-1", "rad s-1"}, {"m s-2", "rad s-2"}, {"N", "N m"}};

bool stands_on_ground(const Element& element) {
  return std::ranges::any_of(element.along,
                             [](const Share& share) { return share.node.kind == NodeKind::ground; });
}

}  // namespace

bool joint_rotates(const Network& network, std::size_t joint) {
  return joint < network.joint_rotation.size() && network.joint_rotation[joint];
}

bool rotates(const Network& network, std::size_t mass) {
  if (mass >= network.masses.size()) return joint_rotates(network, mass - network.masses.size());
  return mass < network.rotation.size() && network.rotation[mass];
}

bool turns(const Network& network, const Node& node) {
  return (node.kind == NodeKind::mass && rotates(network, node.index)) ||
         (node.kind == NodeKind::joint && joint_rotates(network, node.index));
}

bool ground_takes_torque(const Network& network) {
  bool torque = false;
  for (const Element& element : network.elements) {
    if (!stands_on_ground(element)) continue;
    if (!element.twists_ground) return false;
    torque = true;
  }
  return torque;
}

double share_in_force(const Element& element, const Node& node, bool takes_torque) {
  if (node.kind == NodeKind::ground && element.twists_ground != takes_torque) return 0.0;
  const auto share = std::ranges::find(element.along, node, &Share::node);
  return share == element.along.end() ? 0.0 : share->factor;
}

std::string_view unit_of_rotation(std::string_view unit) {
  const auto* const row = std::ranges::find(kUnits, unit, [](const auto& each) { return each.first; });
  return row == std::end(kUnits) ? unit : row->second;
}

std::string_view unit_of_mass(const Network& network, std::size_t mass, std::string_view unit) {
  return rotates(network, mass) ? unit_of_rotation(unit) : unit;
}

std::string_view unit_of_element(const Element& element, std::string_view unit) {
  return element.rotational ? unit_of_rotation(unit) : unit;
}

}  // namespace frahm::mechanics
