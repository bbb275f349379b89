#pragma once

// Points that are solved side by side, one a lane, as plain numbers: what the kernel is given and what it
// tells. It is the only thing that the kernel shares with the rest of the program, since the kernel is
// compiled for several instruction sets.
//
// A value is kLanes doubles, one a lane; a complex value is two of these, real parts first.
namespace frahm::periodic::nonstop {

inline constexpr int kLanes = 16;

// An integral over a period of a product of two forms.
struct Product {
  int a = 0;
  int b = 0;  // b < 0: the oscillator -1 - b, of 1, cos(order_1 phase), sin(order_1 phase), cos(order_2 ...
};

// What all points of a pack have in common. A form is a quantity that is linear in the state, the forcing and
// the friction forces: of the contacts first their relative velocities, then their relative displacements;
// then the traces, of which extremes are asked; then those that are integrated.
struct Shape {
  int modes = 0;   // of the system with all contacts sliding; a conjugate pair counts once
  int states = 0;  // 2 for each pair, 1 for each real mode
  int contacts = 0;
  int orders = 0;
  int inputs = 0;  // outside forces on masses, and motions of supports
  int traces = 0;
  int integrated = 0;
  int products = 0;
  int powers = 0;
  bool may_stop_once = false;        // one mass on springs and dampers, one contact to the ground, one order
  bool half_period = false;          // x(t + T/2) = -x(t)
  bool asks_phases = false;          // of the extremes
  bool asks_strokes = false;         // and reversals of the contacts
  bool is_judged = false;            // norm of the state, residual, multipliers and contraction
  const char* is_pair = nullptr;     // of each mode: whether it stands for a conjugate pair
  const char* is_direct = nullptr;   // of each form: whether inputs act on it directly
  const int* order = nullptr;        // of each harmonic
  const Product* product = nullptr;  // of integrated forms, counted from the first of these
  const Product* power = nullptr;    // a force and the velocity it works at

  int samples() const {
    return 32 * order[orders - 1];
  }  // over a period, to find the sign changes of velocities
  int forms() const { return 2 * contacts + traces + integrated; }
  int first_trace() const { return 2 * contacts; }
  int first_integrated() const { return 2 * contacts + traces; }
};

struct Pack {
  const Shape* shape = nullptr;

  // Given.
  double* is_there = nullptr;   // 1, or 0 in a lane without a point
  double* omega = nullptr;      // [rad/s]
  double* lambda = nullptr;     // [modes] complex [1/s]
  double* mode_norm = nullptr;  // [modes] energy norm of the mode's vector [sqrt(J)]
  double* push = nullptr;  // [contacts][modes] complex: a contact's unit force in modal coordinates [1/(N s)]
  double* unit_jump = nullptr;       // [contacts][modes] complex: -2 push / lambda [1/N]
  double* push_norm = nullptr;       // [contacts] its energy norm [sqrt(J)/(N s)]
  double* limit = nullptr;           // [contacts] friction force [N]
  double* input = nullptr;           // [inputs][orders] complex amplitudes of what drives [N or m]
  double* constant_input = nullptr;  // [inputs] its constant part
  double* mode_input = nullptr;  // [modes][inputs][3] complex: of an input, its rate and the rate of that, in
                                 // modal coordinates; half of it of a pair
  double* form_modal = nullptr;  // [forms][modes] complex: factors of the modal coordinates
  double* form_input = nullptr;  // [forms][inputs][3] of inputs and rates that do not go through the state
  double* form_constant_input = nullptr;  // [forms][inputs] of the constant part, that by the state included
  double* form_friction = nullptr;  // [forms][contacts] of F sigma of a contact, that by the state included
  double* form_own_friction = nullptr;  // [forms][contacts] of sigma: friction of single elements
  double* to_energy = nullptr;          // [states][states] real modal coordinates to those of the energy norm
  double* from_energy = nullptr;        // [states][states] its inverse

  // Told.
  double* is_found = nullptr;  // 1: nothing sticks, proved; 0: all below is void
  double* newton_iterations = nullptr;
  double* reversals = nullptr;  // against friction, over the period or half of it
  double* margin = nullptr;     // least relative distance of the proof from failing
  double* most = nullptr;      // [traces] largest value over a period; in a half period the largest magnitude
  double* least = nullptr;     // [traces]
  double* most_at = nullptr;   // [traces] phases [rad]
  double* least_at = nullptr;  // [traces]
  double* integral = nullptr;  // [products] over a period [units x s]
  double* work = nullptr;      // [powers] over a period [J]
  double* work_size = nullptr;          // [powers] of the power's magnitude
  double* slid = nullptr;               // [contacts] distance over a period [m]
  double* contact_reversals = nullptr;  // [contacts] in a period
  double* slides = nullptr;             // share of the period; 1: nothing stops
  double* state_norm = nullptr;         // energy norm there [sqrt(J)]
  double* residual = nullptr;     // energy norm by which the motion misses itself after the period [sqrt(J)]
  double* parts = nullptr;        // energy norms of what the motion is the sum of [sqrt(J)]
  double* multiplier = nullptr;   // largest modulus of the Floquet multipliers of a period
  double* contraction = nullptr;  // energy norm of the derivative of the map
};

}  // namespace frahm::periodic::nonstop
