#pragma once

#include "solvers/mechanics/network.hpp"

// The rig of DESIGN section 11: a tuned mass damper with an inerter on a main mass shaken through a spring by
//   a(t) = 0.02955 sin(omega t)  [m].
namespace frahm::periodic {

inline constexpr double kRigSpring = 8181.0;  // K [N/m], one of seven
inline constexpr double kRigCrank = 0.02955;  // A [m]

// With `with_absorber` the tuned mass, its spring, damper, inerter and friction.
inline mechanics::Network rig(bool with_absorber = true) {
  using namespace mechanics;
  const Node ground{}, main{NodeKind::mass, 0}, tmd{NodeKind::mass, 1}, exciter{NodeKind::prescribed, 0};
  Network network{.masses = {"main"},
                  .prescribed = {"exciter"},
                  .elements = {{"suspension", ElementType::spring, ground, main},
                               {"drive", ElementType::spring, exciter, main},
                               {"guide_damper", ElementType::damper, ground, main},
                               {"guide", ElementType::coulomb, ground, main}},
                  .excitations = {{ExcitationKind::motion, 0, 1}}};
  if (!with_absorber) return network;
  network.masses.push_back("tmd");
  for (const Element& element : {Element{"tmd_spring", ElementType::spring, tmd, main},
                                 Element{"tmd_damper", ElementType::damper, tmd, main},
                                 Element{"inerter", ElementType::inerter, tmd, main},
                                 Element{"tmd_friction", ElementType::coulomb, tmd, main}}) {
    network.elements.push_back(element);
  }
  return network;
}

// I: inertance [kg]; share: friction of the main guide, D / (K A); d: friction of the absorber's guide [N].
inline mechanics::NetworkValues rig_values(double omega, double I, double share, double d = 15.0109) {
  const double phase = -1.5707963267948966;  // cos(omega t - pi/2) = sin(omega t)
  return {.omega = omega,
          .mass = {102.66, 12.82},
          .element = {6.0 * kRigSpring, kRigSpring, 1.7688, share * kRigSpring * kRigCrank, 10985.1,
                      26.5104 + 0.4811 * I, I, d},
          .excitation = {{kRigCrank, phase}}};
}

// The main mass by itself.
inline mechanics::NetworkValues bare_rig_values(double omega, double share) {
  mechanics::NetworkValues values = rig_values(omega, 0.0, share);
  values.mass.resize(1);
  values.element.resize(4);
  return values;
}

}  // namespace frahm::periodic
