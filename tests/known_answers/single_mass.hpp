#pragma once

#include "solvers/mechanics/network.hpp"

// x'' + 2 zeta x' + x + f Sgn(x') = cos(r tau) as a network: one mass of 1 on a spring of 1, force of
// amplitude 1.
namespace frahm::periodic {

inline mechanics::Network single_mass() {
  using namespace mechanics;
  const Node ground{}, mass{NodeKind::mass, 0};
  return {.masses = {"x"},
          .prescribed = {},
          .elements = {{"spring", ElementType::spring, ground, mass},
                       {"damper", ElementType::damper, ground, mass},
                       {"friction", ElementType::coulomb, ground, mass}},
          .excitations = {{ExcitationKind::force, 0, 1}}};
}

inline mechanics::NetworkValues single_mass_values(double r, double zeta, double f) {
  return {.omega = r, .mass = {1.0}, .element = {1.0, 2.0 * zeta, f}, .excitation = {{1.0, 0.0}}};
}

}  // namespace frahm::periodic
