#pragma once

#include <vector>

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/mechanics/rotation.hpp"
#include "solvers/mechanics/structural_damping.hpp"

// Forces of elements as linear forms, of whatever the motion is given by: `Forms` makes the forms of an
// incidence's displacement, velocity and acceleration, the latter in a mode where it depends on one.
namespace frahm::mechanics {

// k u + c u' + b u'' [N] of an element, without its friction.
template <class Forms, class... Mode>
auto smooth_force(const Forms& forms, const Incidence& at, const ElementCoefficients& law,
                  const Mode&... mode) {
  auto form = forms.zero();
  if (law.stiffness != 0.0) form.add(law.stiffness, forms.displacement(at));
  if (law.damping != 0.0) form.add(law.damping, forms.velocity(at));
  if (law.inertance != 0.0) form.add(law.inertance, forms.acceleration(at, mode...));
  return form;
}

// The force [N] that drives `node` (ground or prescribed): the sum that all elements need there, each by its
// factor, and the damping of the structure. (The ground of a network that only turns: a torque [N m].)
template <class Forms, class... Mode>
auto force_on_node(const Forms& forms, const Network& network, const Node& node, const LinearSystem& system,
                   const Mode&... mode) {
  auto sum = forms.zero();
  const bool takes_torque = ground_takes_torque(network);
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    const double share = share_in_force(network.elements[e], node, takes_torque);
    if (share != 0.0) sum.add(share, forms.element_force(e, system.coefficients[e], mode...));
  }
  if (system.structural_damping.size() > 0) sum.add(+1.0, forms.velocity(structural_reaction(system, node)));
  return sum;
}

}  // namespace frahm::mechanics
