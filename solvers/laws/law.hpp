#pragma once

// The properties of a contact law that the exact flow uses. A contact acts along one direction w of the
// network, on the relative displacement u = w^T q + p^T y [m] and velocity u'. At any time it is in one of
// three states: it sticks, or it slides forward (u' > 0) or backward. Within a state it is linear, so that
// the flow is exact; a guard, a polynomial over a step, ends the state.
//
// A law is one file that fills in this struct; one line of the element table (mechanics/element_table.cpp)
// gives it to an element. The flow, the events and the sensitivities read the struct and never ask which law
// it is. They know the two kinds of state below, and take every law for monotone: its force never falls as
// the velocity rises, so that two motions never move apart in the energy norm (with s^2/k of the internal
// forces), and uniqueness, contraction and the error bound hold. A law of another kind needs more than a
// file.
//
//   state    adds                                              ends when
//   sticks   holds_velocity: u' = 0, by the force lambda       |lambda| or |s| reaches the limit F
//            otherwise its internal force s: s' = k u'         (it slides in the force's direction)
//   slides   +-F: a constant force of the flow, or s = +-F     u' reaches zero. One that holds is chosen for
//            held (s' = 0) where there is an internal force    together with all contacts at rest; one with
//                                                              an internal force sticks, and unloads
namespace frahm::laws {

struct Law {
  const char* name;
  // While it sticks the relative velocity is zero; otherwise a state s [N] of the flow is its force.
  bool holds_velocity;
  // Elements of this law between the same two nodes act as one contact and share its force in proportion to
  // their limits.
  bool merges;
};

}  // namespace frahm::laws
