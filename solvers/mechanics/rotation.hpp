#pragma once

#include <string_view>

#include "solvers/mechanics/network.hpp"

// What turns in a network, and what follows from it for units and for sums of forces: a torque is no force.
namespace frahm::mechanics {

// Of a mass, or, after them, of a joint.
bool rotates(const Network& network, std::size_t mass);
bool turns(const Network& network, const Node& node);  // of a mass or joint
bool joint_rotates(const Network& network, std::size_t joint);

// Whether what the elements exert on the ground is a torque: where none pushes it, and some twist it.
bool ground_takes_torque(const Network& network);

// The share of an element's force in the force that `node` (ground or prescribed) takes, 0 where it takes
// none. takes_torque: ground_takes_torque() of the network; the ground adds up either forces or torques.
double share_in_force(const Element& element, const Node& node, bool takes_torque);

// The unit of a rotation's quantity by that of a translation's, in UDUNITS form: "rad" for "m", "N m" for
// "N".
std::string_view unit_of_rotation(std::string_view unit);

// The unit of a mass's or element's quantity by that of a translation's.
std::string_view unit_of_mass(const Network& network, std::size_t mass, std::string_view unit);
std::string_view unit_of_element(const Element& element, std::string_view unit);

}  // namespace frahm::mechanics
