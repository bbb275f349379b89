#pragma once

#include "solvers/nonstop/forms.hpp"

// The proof that nothing sticks: between its reversals every contact goes on in its direction, step by step.
namespace {

constexpr double kSafe = 1e-7;  // a margin that is certainly not grazing

// What the passage finds of all lanes.
struct Passage {
  Mask proved;                    // nothing sticks
  Lanes at_reversals;             // least relative acceleration there, on either side
  Lanes between;                  // least coefficient of the proof, relative
  Lanes residual;                 // [sqrt(J)]
  Lanes parts;                    // energy norms of what the motion is the sum of [sqrt(J)]
  Lanes shortest = lanes(1.0);    // least phase between two reversals [rad]
  Lanes latest_off = lanes(0.0);  // most by which a reversal misses its phase [rad]

  // The proof stands so far.
  Mask stands() const { return proved & (at_reversals > kSafe) & (between > kSafe); }
  // Proved so far, or with finer steps.
  Mask may_hold() const {
    constexpr double kClose = -0.1;
    return (at_reversals > kSafe) & (between > kClose);
  }
};

// From one reversal to the next one; without any, the span.
struct Segment {
  int number, next;  // of the reversals at its ends
  bool is_last;
  Lanes start, length;  // [rad]
  Lanes count, h;       // of steps, and their length [rad]
};

// Whether a velocity stays positive over a step of length h: the Bernstein coefficients of the quartic that
// the cubic Hermite interpolant, less what it can be wrong by, is at least. |error| <= B t^2 (h-t)^2 / 24
// lowers the middle coefficient alone, by B h^4 / 144. v: at both ends, exactly zero where the contact
// reverses; a: its slopes. Returns the least coefficient that is not zero by itself.
FRAHM_INLINE Lanes least_coefficient(Lanes v0, Lanes a0, Lanes v1, Lanes a1, Lanes h, Lanes error,
                                     Mask starts, Mask ends) {
  const Lanes b1 = v0 + a0 * h * (1.0 / 3.0), b2 = v1 - a1 * h * (1.0 / 3.0);
  const Lanes c1 = 0.25 * v0 + 0.75 * b1, c2 = 0.5 * (b1 + b2) - error, c3 = 0.75 * b2 + 0.25 * v1;
  Lanes least = min(min(c1, c2), c3);
  least = select(starts, least, min(least, v0));
  return select(ends, least, min(least, v1));
}

// A coefficient of a velocity, relative to its size, that is small: next to the contact's own reversal it is
// as small as that is near, and so is reported relative to the distance [rad]. What may be rounding is left
// out; the velocity is the sum of modes that were multiplied step by step.
template <class W>
inline Lanes beside_reversal(const W& w, const Segment& segment, int k, int j, Lanes least) {
  constexpr double kRounding = 1e-12;
  const auto folded_once = [&](Lanes phase) { return select(phase < 0.0, phase + w.span, phase); };
  const Lanes end = w.sorted_phase[segment.next];
  Lanes distance = lanes(1.0);
  for (int e = 0; e < w.reversals; ++e) {
    const Lanes since = folded_once(segment.start - w.sorted_phase[e]) + segment.h * (k + 1.0);
    const Lanes until = folded_once(w.sorted_phase[e] - end) + segment.h * (segment.count - k);
    distance = select(w.sorted_contact[e] == j, min(distance, min(since, until)), distance);
  }
  Lanes size = w.speed[j];
  for (int s = 0; s < w.modes; ++s)
    size += size_of(load(w.pack.form_modal, j * w.modes + s)) * size_of(w.zeta[s]);
  const Lanes sound = least - kRounding * size * w.per_speed[j];
  return select(sound > 0.0, sound / distance, least);
}

// Counts a frictionless contact's changes of direction; a velocity of zero is of no direction.
template <class W>
inline void note_sign(W& w, int j, Mask where, Lanes v) {
  const Mask moves = where & ((v > 0.0) | (v < lanes(0.0)));
  const Lanes sign = select(v > 0.0, lanes(1.0), lanes(-1.0));
  const Mask known = abs(w.last_sign[j]) > 0.5;
  const Mask reverses = moves & known & ~(sign == w.last_sign[j]);
  w.contact_reversals[j] += select(reverses, lanes(1.0), 0.0);
  w.first_sign[j] = select(moves & ~known, sign, w.first_sign[j]);
  w.last_sign[j] = select(moves, sign, w.last_sign[j]);
}
// The first direction comes again after the span, with its sign.
template <class W>
inline void close_signs(W& w) {
  for (int j = 0; j < w.contacts; ++j) {
    const Mask reverses = (abs(w.last_sign[j]) > 0.5) & ~(w.last_sign[j] == w.sign * w.first_sign[j]);
    w.contact_reversals[j] += select(reverses & ~(view(w.pack.limit)[j] > 0.0), lanes(1.0), 0.0);
  }
}

// Whether every contact keeps its direction over step k of the segment, in the lanes that take it.
template <class W>
inline void prove_step(W& w, const Segment& segment, int k, Mask taken, Passage& passage) {
  const Mask ends_segment = taken & ~(segment.count > lanes(k + 1.0));
  for (int j = 0; j < w.contacts; ++j) {
    const Mask rubs = view(w.pack.limit)[j] > 0.0;
    const Lanes v = value(w, j, w.next_zeta, w.next_osc), a = slope(w, j, w.next_zeta, w.next_osc);
    const bool reverses = w.reversals > 0;
    const Mask starts = k == 0 && reverses ? w.sorted_contact[segment.number] == j : none();
    const Mask ends = reverses ? ends_segment & (w.sorted_contact[segment.next] == j) : none();
    const Lanes d = w.direction[j];
    const Lanes at_end = select(ends, lanes(0.0), v);
    Lanes least =
        least_coefficient(d * w.v0[j], d * w.a0[j], d * at_end, d * a, segment.h, w.error[j], starts, ends) *
        w.per_speed[j];
    const Mask small = taken & rubs & (least > 0.0) & ~(least > kSafe);
    if (any(small)) least = select(small, beside_reversal(w, segment, k, j, least), least);
    passage.between = select(taken & rubs, min(passage.between, least), passage.between);
    if (w.shape.asks_strokes) {  // without friction a contact reverses as it likes
      note_sign(w, j, taken & ~rubs, v);
    }
    w.v0[j] = select(taken, v, w.v0[j]);
    w.a0[j] = select(taken, a, w.a0[j]);
  }
}

}  // namespace
