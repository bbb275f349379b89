#pragma once

// What a law of contact is to the exact flow. A contact acts along one direction w of the network, on the
// relative displacement u = w^T q + p^T y [m] and velocity u'. At any time it is in one of three states: it
// sticks, or it slides forward (u' > 0) or backward. Within a state it is linear, so that the flow is exact;
// a guard, a polynomial over a step, ends the state.
//
// A law is one file that fills in this struct; one line of the element table (mechanics/element_table.cpp)
// gives it to an element. The flow, the events and the sensitivities read the struct and never ask which law
// it is.
//
//   state    adds                                              ends when
//   sticks   holds_velocity: u' = 0, by the force lambda       |lambda| or |s| reaches the limit F
//            otherwise its internal force s: s' = k u'         (it slides in the force's direction)
//   slides   +-F: a constant force of the flow, or s = +-F     u' reaches zero; then `at_rest` says
//            held (s' = 0) where there is an internal force    what follows
namespace frahm::laws {

// What follows when a sliding contact's velocity reaches zero.
enum class AtRest {
  joint_choice,  // its force may be anything within the limit: chosen together with all contacts at rest
  sticks,        // its force is continuous: it sticks, and unloads
};

struct Law {
  const char* name;
  bool holds_velocity;      // while it sticks the relative velocity is zero
  bool has_internal_force;  // a state s [N] of the flow is its force; with holds_velocity: false
  AtRest at_rest;
  // Force never falls as the velocity rises: two motions never move apart in the energy norm (with s^2/k of
  // the internal forces), so that uniqueness, contraction and the error bound hold.
  bool monotone;
  // Elements of this law between the same two nodes act as one contact and share its force in proportion to
  // their limits.
  bool merges;
};

}  // namespace frahm::laws
