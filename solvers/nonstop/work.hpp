#pragma once

#include "solvers/nonstop/kernel.hpp"
#include "solvers/nonstop/lanes.hpp"

// The kernel's workspace, and what all its steps share. Times are phases omega t [rad], rates are per radian.
namespace {

using frahm::periodic::nonstop::kLanes;
using frahm::periodic::nonstop::kMostReversals;
using frahm::periodic::nonstop::most_steps;
using frahm::periodic::nonstop::Pack;
using frahm::periodic::nonstop::Product;
using frahm::periodic::nonstop::Shape;

constexpr double kVanishing = -200.0;  // an exponent, of which the square is still a number
constexpr double kPi = 3.141592653589793;

FRAHM_INLINE const Lanes* view(const double* p) {
  return reinterpret_cast<const Lanes*>(p);
}
FRAHM_INLINE Lanes* view(double* p) {
  return reinterpret_cast<Lanes*>(p);
}
FRAHM_INLINE const Complex* complex_view(const double* p) {
  return reinterpret_cast<const Complex*>(p);
}

// Hands out parts of the workspace; without a start it only counts.
class Arena {
 public:
  explicit Arena(double* start) : start_(start) {}
  template <class T>
  T* take(int count) {
    double* from = start_ == nullptr ? nullptr : start_ + used_;
    used_ += static_cast<unsigned long>(count) * sizeof(T) / sizeof(double);
    return reinterpret_cast<T*>(from);
  }
  unsigned long used() const { return used_; }

 private:
  double* start_;
  unsigned long used_ = 0;
};

// Counts that are known as the program runs, or as it is compiled: then short loops are unrolled.
struct AnyCounts {
  explicit AnyCounts(const Shape& shape)
      : modes(shape.modes), states(shape.states), orders(shape.orders), contacts(shape.contacts) {}
  const int modes, states, orders, contacts;
};
// M modes, conjugate pairs all of them.
template <int M, int H, int C>
struct Counts {
  explicit Counts(const Shape&) {}
  static bool fit(const Shape& shape) {
    return shape.modes == M && shape.states == 2 * M && shape.orders == H && shape.contacts == C;
  }
  static constexpr int modes = M, states = 2 * M, orders = H, contacts = C;
};

// The largest value of a trace so far.
struct Extreme {
  Lanes value;
  Lanes reached, phase;  // the largest value that is reached somewhere, not held from before, and where
};

template <class C>
struct Work : C {
  using C::contacts;
  using C::modes;
  using C::orders;
  using C::states;

  const Shape& shape;
  const Pack& pack;
  const int inputs;
  const double span;  // the period, or half of it
  const double sign;  // of the motion after it

  // For the linear part.
  Complex* rate;                // [modes] lambda / omega
  Lanes* rate_size;             // [modes] its size
  Complex* over_span;           // [modes] exp(rate span)
  Complex* since;               // [modes]
  Complex* closure;             // [modes] 1 / (1 - sign exp(rate span))
  Complex* response;            // [orders][modes] modal response to the forcing ...
  Complex* conjugate_response;  // ... and the conjugate mode's
  Complex* phasor;              // [forms][orders]
  Lanes* constant;              // [forms]
  Lanes* friction;              // [forms][contacts] of the direction of each contact
  Complex* slope_modal;         // [forms before the integrated][modes]: of the form's derivative by the phase
  Complex* slope_phasor;        // [forms before the integrated][orders]
  Complex* jump;                // [contacts][modes] by which friction that turns up moves modal coordinates
  Complex* own;          // [contacts][contacts][modes] velocity of a contact owed to a reversal of another
  Lanes* speed;          // [contacts] sum of the sizes of the velocity's harmonics
  Lanes* per_speed;      // [contacts] 1 / speed
  Lanes* harmonic_size;  // [orders] bound of the energy norm

  // Reversals, a contact's in their order, contact after contact.
  Lanes* count;                      // [contacts] of reversals
  Lanes* guess;                      // [contacts][kMostReversals]
  Lanes* guess_turn;                 // [contacts] direction of the first
  double *cosine, *sine;             // [samples] over a turn
  Lanes* phase;                      // [reversals]
  Lanes* turn;                       // +1: from then on it slides forward
  int contact[kMostReversals] = {};  // of each reversal
  int reversals = 0;                 // of the lanes in hand
  Lanes iterations;                  // of Newton's method
  // The same in order of phase, within the span.
  Lanes* sorted_phase;
  Lanes* sorted_turn;
  Lanes* sorted_contact;
  Lanes* slope_before;  // of the contact's velocity
  // Newton's method.
  Lanes* defect;    // [reversals]
  Lanes* jacobian;  // [reversals][reversals]

  // The passage.
  Complex* zeta;  // [modes] what the reversals leave of the modal coordinates
  Complex* next_zeta;
  Complex* first_zeta;
  Complex* osc;  // [orders]
  Complex* next_osc;
  Complex* step_factor;             // [modes]
  Complex* osc_factor;              // [orders]
  Complex* node_factor;             // [nodes][modes]
  Complex* node_osc;                // [nodes][orders]
  Complex* at_node;                 // [modes]
  Complex* osc_at_node;             // [orders]
  Lanes* form_value;                // [integrated]
  Lanes* integral;                  // [products]
  Lanes *work, *work_size;          // [powers]
  Lanes *slid, *contact_reversals;  // [contacts]
  Lanes* direction;                 // [contacts] +1 or -1
  Lanes* first_direction;           // [contacts] in the first segment
  Lanes* level;                     // [forms] constant part in the segment
  Lanes *v0, *a0;                   // [contacts] at the start of a step
  Lanes* error;                     // [contacts] of the middle coefficient of the proof
  Lanes *first_sign, *last_sign;    // [contacts] of the velocity without friction, 0 before it moves

  // What the passage of a segment leaves for the search of extremes.
  Complex* zeta_at;          // [steps][modes]
  Complex* osc_at;           // [steps][orders]
  Lanes* phase_at;           // [steps]
  Lanes* length;             // [steps], 0 in lanes that have no such step
  Lanes* trace_at;           // [steps + 1][traces] value and slope at the steps' ends
  Lanes* bend;               // [traces] what a cubic over a step can be wrong by
  int steps = 0;             // in hand
  bool is_released = false;  // the mass begins to slide from rest with the segment
  Extreme* extreme;          // [traces] of the largest, and of the opposite's
  Mask unsure;               // a larger one may be missed

  // For a mass at rest, one contact and one order (one_stop.hpp).
  bool rests = false;
  Complex* direct;       // [forms][orders] the part of the phasor that does not go through the state
  Complex* rest_phasor;  // [forms]
  Complex* rest_slope;   // [forms before the integrated]
  const Complex* phasors() const { return rests ? rest_phasor : phasor; }
  const Complex* slope_phasors() const { return rests ? rest_slope : slope_phasor; }

  // Stability.
  Lanes* flow;            // [states][states]
  Lanes* square;          // [states][states]
  Lanes* scratch;         // [states][states]
  Lanes* segment_length;  // [reversals]
  Complex* state;         // [modes] at the section
  Lanes* turned_push;     // [states]
  Lanes* velocity_of;     // [states]

  // For the contacts, whose slopes nobody needs; and if their strokes are not asked for, nor do they.
  bool is_displacement(int form) const { return form >= contacts && form < 2 * contacts; }
  bool is_unused(int form) const {
    return !shape.asks_strokes && !shape.may_stop_once && is_displacement(form);
  }

  Work(const Pack& given, Arena& arena)
      : C(*given.shape),
        shape(*given.shape),
        pack(given),
        inputs(shape.inputs),
        span(shape.half_period ? kPi : 2.0 * kPi),
        sign(shape.half_period ? -1.0 : 1.0) {
    const int most = most_steps(contacts);
    const int M = modes, H = orders, m = contacts, R = kMostReversals, sloped = 2 * m + shape.traces;
    rate = arena.take<Complex>(M);
    rate_size = arena.take<Lanes>(M);
    over_span = arena.take<Complex>(M);
    since = arena.take<Complex>(M);
    closure = arena.take<Complex>(M);
    response = arena.take<Complex>(H * M);
    conjugate_response = arena.take<Complex>(H * M);
    phasor = arena.take<Complex>(shape.forms() * H);
    direct = arena.take<Complex>(shape.forms() * H);
    rest_phasor = arena.take<Complex>(shape.forms() * H);
    rest_slope = arena.take<Complex>(sloped * H);
    constant = arena.take<Lanes>(shape.forms());
    friction = arena.take<Lanes>(shape.forms() * m);
    slope_modal = arena.take<Complex>(sloped * M);
    slope_phasor = arena.take<Complex>(sloped * H);
    jump = arena.take<Complex>(m * M);
    own = arena.take<Complex>(m * m * M);
    speed = arena.take<Lanes>(m);
    per_speed = arena.take<Lanes>(m);
    harmonic_size = arena.take<Lanes>(H);
    count = arena.take<Lanes>(m);
    guess = arena.take<Lanes>(m * R);
    guess_turn = arena.take<Lanes>(m);
    cosine = arena.take<double>(shape.samples());
    sine = arena.take<double>(shape.samples());
    phase = arena.take<Lanes>(R);
    turn = arena.take<Lanes>(R);
    sorted_phase = arena.take<Lanes>(R);
    sorted_turn = arena.take<Lanes>(R);
    sorted_contact = arena.take<Lanes>(R);
    slope_before = arena.take<Lanes>(R);
    defect = arena.take<Lanes>(R);
    jacobian = arena.take<Lanes>(R * R);
    zeta = arena.take<Complex>(M);
    next_zeta = arena.take<Complex>(M);
    first_zeta = arena.take<Complex>(M);
    osc = arena.take<Complex>(H);
    next_osc = arena.take<Complex>(H);
    step_factor = arena.take<Complex>(M);
    osc_factor = arena.take<Complex>(H);
    node_factor = arena.take<Complex>(6 * M);
    node_osc = arena.take<Complex>(6 * H);
    at_node = arena.take<Complex>(M);
    osc_at_node = arena.take<Complex>(H);
    form_value = arena.take<Lanes>(shape.integrated);
    integral = arena.take<Lanes>(shape.products);
    work = arena.take<Lanes>(shape.powers);
    work_size = arena.take<Lanes>(shape.powers);
    slid = arena.take<Lanes>(m);
    contact_reversals = arena.take<Lanes>(m);
    direction = arena.take<Lanes>(m);
    first_direction = arena.take<Lanes>(m);
    level = arena.take<Lanes>(shape.forms());
    v0 = arena.take<Lanes>(m);
    a0 = arena.take<Lanes>(m);
    error = arena.take<Lanes>(m);
    bend = arena.take<Lanes>(shape.traces);
    first_sign = arena.take<Lanes>(m);
    last_sign = arena.take<Lanes>(m);
    zeta_at = arena.take<Complex>(most * M);
    osc_at = arena.take<Complex>(most * H);
    phase_at = arena.take<Lanes>(most);
    length = arena.take<Lanes>(most);
    trace_at = arena.take<Lanes>((most + 1) * shape.traces * 2);
    extreme = arena.take<Extreme>(2 * shape.traces);
    const int D = states;
    flow = arena.take<Lanes>(D * D);
    square = arena.take<Lanes>(D * D);
    scratch = arena.take<Lanes>(D * D);
    segment_length = arena.take<Lanes>(R + 1);
    state = arena.take<Complex>(M);
    turned_push = arena.take<Lanes>(D);
    velocity_of = arena.take<Lanes>(D);
  }
};

}  // namespace
