#pragma once

#include "solvers/nonstop/extremes.hpp"
#include "solvers/nonstop/integrals.hpp"
#include "solvers/nonstop/proof.hpp"

// One passage along the orbit: the proof that nothing sticks, and everything that is measured on the way.
namespace {

// zeta just after the first reversal, and the direction of every contact from there: that of its last
// reversal.
template <class W>
inline void start_passage(W& w) {
  const int R = w.reversals;
  const Lanes start = R > 0 ? w.sorted_phase[0] : lanes(0.0);
  for (int s = 0; s < w.modes; ++s) w.zeta[s] = {lanes(0.0), lanes(0.0)};
  for (int j = 0; j < w.contacts; ++j) w.direction[j] = lanes(0.0);
  for (int e = 0; e < R; ++e) {
    // The first one has just happened; the others did so before the span began, with its sign.
    const Lanes since = e == 0 ? lanes(0.0) : start - w.sorted_phase[e] + w.span;
    const Lanes turned = e == 0 ? w.sorted_turn[e] : w.sign * w.sorted_turn[e];
    for (int s = 0; s < w.modes; ++s) {
      Complex jump = {lanes(0.0), lanes(0.0)};
      for (int j = 0; j < w.contacts; ++j) {
        const Mask own = w.sorted_contact[e] == j;
        jump = select(own, w.jump[j * w.modes + s], jump);
      }
      Complex left = turned * (jump * w.closure[s]);
      if (e > 0) left = left * exponential({since * w.rate[s].re, since * w.rate[s].im});
      w.zeta[s] += left;
    }
  }
  // In order of time: those from before the span, then the first.
  for (int e = 1; e <= R; ++e) {
    const int p = e % R;
    const Lanes turned = p == 0 ? w.sorted_turn[0] : w.sign * w.sorted_turn[p];
    for (int j = 0; j < w.contacts; ++j)
      w.direction[j] = select(w.sorted_contact[p] == j, turned, w.direction[j]);
  }
  for (int s = 0; s < w.modes; ++s) w.first_zeta[s] = w.zeta[s];
  for (int j = 0; j < w.contacts; ++j) w.first_direction[j] = w.direction[j];
}

// How fast the motion varies within the segment: the rates of modes and harmonics, weighted by the fourth
// root of their share in its amplitude of energy, as a norm of order 8. Slight fast modes cost few steps so.
template <class W>
inline Lanes fastest_rate(const W& w) {
  Lanes total = lanes(1e-300);
  for (int s = 0; s < w.modes; ++s) total += size_of(w.zeta[s]) * view(w.pack.mode_norm)[s];
  for (int k = 0; k < w.orders; ++k) total += w.harmonic_size[k];
  const Lanes per_total = 1.0 / total;
  const auto weighted = [&](Lanes size, Lanes rate) {
    const Lanes r2 = rate * rate, r4 = r2 * r2;
    return sqrt(size * per_total) * (r4 * r4);
  };
  Lanes sum = lanes(0.0);
  for (int s = 0; s < w.modes; ++s)
    sum += weighted(size_of(w.zeta[s]) * view(w.pack.mode_norm)[s], w.rate_size[s]);
  for (int k = 0; k < w.orders; ++k) sum += weighted(w.harmonic_size[k], lanes(w.shape.order[k]));
  return sqrt(sqrt(sqrt(sum)));
}

// The reversal that ends a segment: what it misses zero by, how far its contact has come, and its jump.
// Its direction is `turned`.
template <class W>
inline void take_reversal(W& w, int p, Lanes turned, Mask sound, Passage& passage) {
  const Lanes omega = *view(w.pack.omega);
  Lanes v = lanes(0.0), a = lanes(0.0), force = v, per_speed = v, push_norm = v;
  for (int j = 0; j < w.contacts; ++j) {
    const Mask own = w.sorted_contact[p] == j;
    v = select(own, w.v0[j], v);
    a = select(own, w.a0[j], a);
    force = select(own, view(w.pack.limit)[j], force);
    per_speed = select(own, w.per_speed[j], per_speed);
    push_norm = select(own, view(w.pack.push_norm)[j], push_norm);
    if (w.shape.asks_strokes) {
      const int form = w.contacts + j;
      const Lanes u = value(w, form, w.zeta, w.osc) + w.level[form];
      // F |du| over the span adds up to -2 turn u over the reversals.
      w.slid[j] += select(own & sound, -2.0 * turned * u, 0.0);
      w.contact_reversals[j] += select(own, lanes(1.0), 0.0);
    }
    for (int s = 0; s < w.modes; ++s) w.zeta[s] += select(own, turned, 0.0) * w.jump[j * w.modes + s];
    w.direction[j] = select(own, turned, w.direction[j]);
  }
  // A velocity v, or its rounding, is a delay v / (omega a), after which friction acts by 2 F the other way.
  constexpr double kRounding = 1e-15;
  const Lanes off = abs(v) + kRounding / max(per_speed, lanes(1e-300));
  const Lanes late = off / max(abs(a), lanes(1e-300));
  passage.residual += 2.0 * force * push_norm * (late / omega);
  passage.latest_off = max(late, passage.latest_off);
  passage.at_reversals = min(passage.at_reversals, turned * a * per_speed);
  w.slope_before[p] = a;
}

template <class W>
inline void clear_measures(W& w) {
  for (int p = 0; p < w.shape.products; ++p) w.integral[p] = lanes(0.0);
  for (int p = 0; p < w.shape.powers; ++p) w.work[p] = w.work_size[p] = lanes(0.0);
  for (int j = 0; j < w.contacts; ++j)
    w.slid[j] = w.contact_reversals[j] = w.first_sign[j] = w.last_sign[j] = lanes(0.0);
  clear_extremes(w);
}

// The number and length of the segment's steps; false if no lane is left whose proof may hold.
template <class W>
inline bool lay_out_steps(const W& w, Segment& segment, double fineness, Lanes& steps_so_far,
                          Passage& passage) {
  constexpr double kStep = 0.75, kCoarseStep = 1.0;  // of the fastest rate's radian; without integrals
  constexpr double kShortest = 1e-9;                 // between two reversals [rad]
  const double steps_a_radian = fineness / (w.shape.integrated > 0 ? kStep : kCoarseStep);
  const Lanes count = max(floor(segment.length * fastest_rate(w) * steps_a_radian) + 1.0, lanes(2.0));
  segment.count = count;
  segment.h = segment.length / count;
  // A lane's own steps decide, not those that others of its group take next to it.
  steps_so_far += count;
  passage.shortest = min(passage.shortest, segment.length);
  passage.proved = passage.proved & passage.may_hold() & (segment.length > kShortest) &
                   (steps_so_far < lanes(most_steps(w.contacts)));
  return any(passage.proved);
}

// Velocities and harmonics at the segment's start.
template <class W>
inline void start_segment(W& w, const Segment& segment, Passage& passage) {
  const Lanes h = segment.h;
  set_factors(w, h);
  set_levels(w);
  for (int k = 0; k < w.orders; ++k) w.osc[k] = turn(segment.start * w.shape.order[k]);
  // The slopes are bounded from the segment's start on, as every mode decays.
  for (int j = 0; j < w.contacts; ++j) {
    const Mask reversed = w.reversals > 0 ? w.sorted_contact[segment.number] == j : none();
    w.v0[j] = select(reversed, lanes(0.0), value(w, j, w.zeta, w.osc));
    w.a0[j] = slope(w, j, w.zeta, w.osc);
    w.error[j] = fourth_derivative(w, j) * ((h * h) * (h * h)) * (1.0 / 144.0);
    if (w.reversals > 0) {
      const Lanes after = w.direction[j] * w.a0[j] * w.per_speed[j];
      passage.at_reversals = select(reversed, min(passage.at_reversals, after), passage.at_reversals);
    }
  }
}

// The largest number of steps that a lane of the group takes.
inline int steps_of(Mask group, Lanes count) {
  Lanes most = select(group, count, 0.0);
  int steps = 0;
  for (int lane = 0; lane < kLanes; ++lane)
    if (at(most, lane) > steps) steps = static_cast<int>(at(most, lane));
  return steps;
}

template <class W>
inline void pass_segment(W& w, const Segment& segment, Passage& passage) {
  start_segment(w, segment, passage);
  const int steps = steps_of(passage.proved, segment.count);
  for (int k = 0; k < steps; ++k) {
    const Mask taken = segment.count > lanes(k);
    for (int s = 0; s < w.modes; ++s) w.next_zeta[s] = w.zeta[s] * w.step_factor[s];
    for (int i = 0; i < w.orders; ++i) w.next_osc[i] = w.osc[i] * w.osc_factor[i];
    prove_step(w, segment, k, taken, passage);
    keep_step(w, taken, segment.start + segment.h * k, segment.h);
    if (w.shape.integrated > 0) integrate_step(w, select(taken, segment.h, 0.0));
    for (int s = 0; s < w.modes; ++s) w.zeta[s] = select(taken, w.next_zeta[s], w.zeta[s]);
    for (int i = 0; i < w.orders; ++i) w.osc[i] = select(taken, w.next_osc[i], w.osc[i]);
  }
  search_segment(w, passage.stands());
}

template <class W>
inline Segment segment_of(const W& w, int number) {
  const int R = w.reversals;
  const bool is_last = number + 1 >= R;
  Segment segment{number, is_last ? 0 : number + 1, is_last, lanes(0.0), lanes(w.span), {}, {}};
  if (R == 0) return segment;
  segment.start = w.sorted_phase[number];
  segment.length =
      is_last ? w.sorted_phase[0] + w.span - segment.start : w.sorted_phase[number + 1] - segment.start;
  return segment;
}

// Sweeps the orbit in the lanes of the group. fineness: factor of the number of steps.
template <class W>
inline Passage passage_along(W& w, Mask group, double fineness) {
  constexpr double kClosed = 1e-9;
  constexpr double kInOrder = 1e-2;  // of the shortest segment, by which a reversal may miss its phase
  Passage passage{group, lanes(1.0), lanes(1.0), lanes(0.0), lanes(0.0)};
  clear_measures(w);
  w.rests = w.is_released = false;
  Lanes steps_so_far = lanes(0.0);
  start_passage(w);
  for (int p = 0; p == 0 || p < w.reversals; ++p) {
    Segment segment = segment_of(w, p);
    w.segment_length[p] = segment.length;
    if (!lay_out_steps(w, segment, fineness, steps_so_far, passage)) return passage;
    pass_segment(w, segment, passage);
    if (w.reversals == 0) break;
    const Lanes turned = segment.is_last ? w.sign * w.sorted_turn[0] : w.sorted_turn[segment.next];
    take_reversal(w, segment.next, turned, passage.proved, passage);
  }
  close_signs(w);
  Lanes missed = lanes(0.0), size = lanes(1e-300);
  for (int s = 0; s < w.modes; ++s) {
    const Complex end = {w.sign * w.zeta[s].re, w.sign * w.zeta[s].im};
    missed += size_of(end - w.first_zeta[s]) * view(w.pack.mode_norm)[s];
    size += size_of(w.first_zeta[s]) * view(w.pack.mode_norm)[s];
  }
  for (int k = 0; k < w.orders; ++k) passage.parts += w.harmonic_size[k];
  passage.parts += size;
  passage.proved =
      passage.stands() & ~(missed > kClosed * size) & (passage.latest_off < kInOrder * passage.shortest);
  return passage;
}

}  // namespace
