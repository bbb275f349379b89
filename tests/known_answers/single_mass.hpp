#pragma once

#include <string>
#include <utility>
#include <vector>

#include "solvers/laws/elastic_stop.hpp"
#include "solvers/mechanics/network.hpp"

// One mass on a spring and a damper to ground under a harmonic force, and what else acts on it from there.
namespace frahm::periodic {

inline mechanics::Element on_the_mass(std::string name, mechanics::ElementType type) {
  return {std::move(name), type, mechanics::Node{}, mechanics::Node{mechanics::NodeKind::mass, 0}};
}

// Elastic stops on these sides of the mass: +1, -1.
inline mechanics::Element elastic_stops(const std::vector<double>& sides) {
  mechanics::Element stops = on_the_mass("stops", mechanics::ElementType::gap);
  for (const double side : sides) stops.bends.push_back({side, &laws::elastic_stop});
  return stops;
}

// Coulomb friction with a static force.
inline mechanics::Element static_friction(std::string name = "friction") {
  mechanics::Element friction = on_the_mass(std::move(name), mechanics::ElementType::coulomb);
  friction.has_static_force = true;
  return friction;
}

inline mechanics::Network driven_mass(const std::vector<mechanics::Element>& more) {
  using mechanics::ElementType;
  mechanics::Network network{
      .masses = {"x"},
      .elements = {on_the_mass("spring", ElementType::spring), on_the_mass("damper", ElementType::damper)},
      .excitations = {{mechanics::ExcitationKind::force, 0, 1}}};
  network.elements.insert(network.elements.end(), more.begin(), more.end());
  return network;
}

inline mechanics::Network mass_between_stops() {
  return driven_mass({elastic_stops({1.0, -1.0})});
}

// x'' + 2 zeta x' + x + f Sgn(x') = cos(r tau)
inline mechanics::Network single_mass() {
  return driven_mass({on_the_mass("friction", mechanics::ElementType::coulomb)});
}

inline mechanics::NetworkValues single_mass_values(double r, double zeta, double f) {
  return {.omega = r, .mass = {1.0}, .element = {1.0, 2.0 * zeta, f}, .excitation = {{1.0, 0.0}}};
}

}  // namespace frahm::periodic
