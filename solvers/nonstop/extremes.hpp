#pragma once

#include "solvers/nonstop/forms.hpp"

// The extremes of the traces, segment after segment: the passage keeps a segment's steps; once they are
// proved stationary points are solved, and both limits where the friction turns.
namespace {

template <class W>
inline void clear_extremes(W& w) {
  w.steps = 0;
  w.unsure = none();
  for (int i = 0; i < 2 * w.shape.traces; ++i) w.extreme[i] = {lanes(-1e300), lanes(-1e300), lanes(0.0)};
}

// What the search needs of the next step of a segment, in the lanes that take it. Where a step ends the next
// one begins.
template <class W>
inline void keep_step(W& w, Mask taken, Lanes phase, Lanes h) {
  const int step = w.steps++, T = w.shape.traces;
  if (T == 0) return;
  w.phase_at[step] = phase;
  w.length[step] = select(taken, h, 0.0);
  for (int s = 0; s < w.modes; ++s) w.zeta_at[step * w.modes + s] = w.zeta[s];
  for (int k = 0; k < w.orders; ++k) w.osc_at[step * w.orders + k] = w.osc[k];
  Lanes* kept = w.trace_at + step * T * 2;
  for (int t = 0; t < T; ++t, kept += 2) {
    const int form = w.shape.first_trace() + t;
    if (step == 0) {
      w.bend[t] = fourth_derivative(w, form) * ((h * h) * (h * h)) * (1.0 / 144.0);
      kept[0] = value(w, form, w.zeta, w.osc) + w.level[form];
      kept[1] = slope(w, form, w.zeta, w.osc);
    }
    kept[2 * T] = value(w, form, w.next_zeta, w.next_osc) + w.level[form];
    kept[2 * T + 1] = slope(w, form, w.next_zeta, w.next_osc);
  }
}

// The larger of two candidates; if phases are asked for, of equal ones (to 1e-12) the earlier that is
// reached.
template <class W>
FRAHM_INLINE void consider(const W& w, Extreme& best, Mask where, Mask reached, Lanes value, Lanes phase) {
  best.value = select(where & (value > best.value), value, best.value);
  if (!w.shape.asks_phases) return;
  constexpr double kEqual = 1e-12;
  const Lanes tie = kEqual * abs(value);
  const Mask larger = value > best.reached + tie;
  const Mask earlier = ~(value < best.reached - tie) & (phase < best.phase);
  best.phase = select(where & reached & (larger | earlier), phase, best.phase);
  best.reached = select(where & reached & (value > best.reached), value, best.reached);
}

// A trace within a step of the passage.
template <class W>
struct TraceStep {
  const W& w;
  int form, step;
  Lanes level, facing;  // +1, or -1 where the least value is sought

  struct Slopes {
    Lanes value, d, e, f;  // and the first three derivatives
  };
  Slopes at(Lanes place) const {
    const Complex* zeta = w.zeta_at + step * w.modes;
    const Complex* osc = w.osc_at + step * w.orders;
    const Complex* c = complex_view(w.pack.form_modal) + form * w.modes;
    const Complex* X = w.phasors() + form * w.orders;
    Slopes x{level, lanes(0.0), lanes(0.0), lanes(0.0)};
    for (int s = 0; s < w.modes; ++s) {
      Complex part = c[s] * (zeta[s] * exponential({place * w.rate[s].re, place * w.rate[s].im}));
      x.value += part.re;
      part = part * w.rate[s];
      x.d += part.re;
      part = part * w.rate[s];
      x.e += part.re;
      x.f += real_part(part, w.rate[s]);
    }
    for (int k = 0; k < w.orders; ++k) {
      const double n = w.shape.order[k];
      const Complex part = X[k] * (osc[k] * turn(place * n));
      x.value += part.re;
      x.d = x.d - n * part.im;
      x.e = x.e - (n * n) * part.re;
      x.f += (n * n * n) * part.im;
    }
    return {facing * x.value, facing * x.d, facing * x.e, facing * x.f};
  }
};

// A part of a step: value and slope at both ends, and what a cubic through them can be wrong by
// (least_coefficient()).
struct Part {
  Lanes from, to;
  Lanes x0, d0, x1, d1, error;
};

// The stationary point near `place`, within the part, and its value: with the slope's own slopes there,
// d + e c + f c^2 / 2 = 0 is solved for the correction c, again where it is not slight.
// A lane stops by itself: its value does not depend on the others.
template <class W>
inline Lanes stationary_value(const TraceStep<W>& trace, const Part& part, Mask going, Lanes& place) {
  constexpr int kMostIterations = 6;
  // [rad]; the error of the value is its fourth power over 24, that of the phase its third.
  const double slight = trace.w.shape.asks_phases ? 1e-5 : 1e-3;
  Lanes value = lanes(0.0);
  for (int i = 0; i < kMostIterations; ++i) {
    const auto [x, d, e, f] = trace.at(place);
    const Lanes newton = -d / e;
    const Lanes full = newton / (1.0 + 0.5 * newton * (f / e));  // Halley's step
    const Lanes correction = max(min(full, part.to - place), part.from - place);
    const Lanes corrected = x + correction * (d + correction * (0.5 * e + correction * ((1.0 / 6.0) * f)));
    value = select(going, corrected, value);
    place = select(going, place + correction, place);
    going = going & (abs(correction) > slight);
    if (!any(going)) break;
  }
  return value;
}

// The phase at which the trace itself, not its opposite, has the value: half a period later for that.
template <class W>
FRAHM_INLINE Lanes side_phase(const TraceStep<W>& trace, Lanes phase) {
  if (!trace.w.shape.asks_phases) return phase;
  const Lanes shifted = trace.w.shape.half_period ? select(trace.facing < 0.0, phase + kPi, phase) : phase;
  return shifted - floor(shifted * (0.5 / kPi)) * (2.0 * kPi);
}

// Searches a part for values above the best, in the lanes where there may be any: Bernstein coefficients
// bound it. Where the cubic has a maximum within, that of the trace is solved and the parts next to it are
// looked at again; where it has none, the part is halved. Returns the lanes in which neither ends.
template <class W>
inline Mask search_part(const TraceStep<W>& trace, const Part& part, Mask among, int depth, Extreme& best) {
  constexpr int kDeepest = 6;
  constexpr double kEqual = 3e-13;
  const Lanes h = part.to - part.from, d0 = part.d0 * h, d1 = part.d1 * h;
  const Lanes b1 = part.x0 + d0 * (1.0 / 3.0), b2 = part.x1 - d1 * (1.0 / 3.0);
  const Lanes highest =
      max(max(0.25 * part.x0 + 0.75 * b1, 0.5 * (b1 + b2) + part.error), 0.75 * b2 + 0.25 * part.x1);
  const Mask may = among & (h > 0.0) & (highest > best.value + kEqual * abs(best.value));
  if (!any(may)) return none();
  if (depth == kDeepest) return may;
  // The slope of the cubic in s: d0 + 2 q s + 3 r s^2. Its falling zero is (-q - root) / (3 r) = d0 / (root -
  // q).
  const Lanes rise = part.x1 - part.x0, q = 3.0 * rise - 2.0 * d0 - d1, r = d0 + d1 - 2.0 * rise;
  const Lanes under = q * q - 3.0 * r * d0, root = sqrt(max(under, lanes(0.0)));
  const Lanes falling = select(q < lanes(0.0), d0 / (root - q), (-q - root) / (3.0 * r));
  // A release begins with a slope of zero, which is no extreme that is reached, and which the cubic, wrong by
  // its error, crosses next to it: the part there is cut short until such a crossing is out of it.
  const bool is_release = trace.w.is_released && trace.step == 0;
  const Lanes cut = is_release ? select(part.from > 0.0, lanes(0.5), 0.125) : lanes(0.5);
  const Lanes first = is_release ? select(part.from > 0.0, lanes(0.0), 0.125) : lanes(0.0);
  const Mask inside = may & ~(under < lanes(0.0)) & (falling > first) & (falling < lanes(1.0));
  Lanes place = part.from + select(inside, falling, cut) * h;
  Lanes value, slope = lanes(0.0);
  if (any(inside)) {
    value = stationary_value(trace, part, inside, place);
    const Mask reached = inside & (place > (is_release ? 1e-4 : 0.0));
    const Lanes phase = trace.w.phase_at[trace.step] + place;
    consider(trace.w, best, inside, reached, value, side_phase(trace, phase));
  }
  if (any(may & ~inside)) {
    const auto middle = trace.at(place);
    value = any(inside) ? select(inside, value, middle.value) : middle.value;
    slope = select(inside, 0.0 * h, middle.d);
  }
  const auto shrunk = [&](Lanes length) {
    const Lanes share = length / h, share2 = share * share;
    return part.error * (share2 * share2);
  };
  const Part left{part.from, place, part.x0, part.d0, value, slope, shrunk(place - part.from)};
  const Part right{place, part.to, value, slope, part.x1, part.d1, shrunk(part.to - place)};
  return search_part(trace, left, may, depth + 1, best) | search_part(trace, right, may, depth + 1, best);
}

// The largest value of `side` times a trace, in the segment as before it; side 0: of its magnitude.
// Returns the lanes in which the search did not end.
template <class W>
inline Mask search_trace(const W& w, int t, double side, Mask among, Extreme& best) {
  const int T = w.shape.traces, form = w.shape.first_trace() + t;
  const auto trace_in = [&](int step, const Lanes* at_left, const Lanes* at_right) {
    const Lanes facing =
        side != 0.0 ? lanes(side) : select(at_left[0] + at_right[0] < 0.0, lanes(-1.0), lanes(1.0));
    return TraceStep<W>{w, form, step, w.level[form], facing};
  };
  for (int step = 0; step < w.steps; ++step) {
    const Lanes *left = w.trace_at + (step * T + t) * 2, *right = left + 2 * T;
    const Lanes h = w.length[step];
    const auto trace = trace_in(step, left, right);
    const Mask taken = among & (h > 0.0), moves = abs(right[0] - left[0]) > 1e-13 * abs(right[0]);
    consider(w, best, taken, none(), trace.facing * left[0], lanes(0.0));
    consider(w, best, taken, moves, trace.facing * right[0], side_phase(trace, w.phase_at[step] + h));
  }
  Mask unsure = none();
  for (int step = 0; step < w.steps; ++step) {
    const Lanes *left = w.trace_at + (step * T + t) * 2, *right = left + 2 * T;
    const auto trace = trace_in(step, left, right);
    const Lanes f = trace.facing;
    const Part whole{lanes(0.0),   w.length[step], f * left[0], f * left[1],
                     f * right[0], f * right[1],   w.bend[t]};
    unsure = unsure | search_part(trace, whole, among, 0, best);
  }
  return unsure;
}

// Searches the segment whose steps are kept, in the lanes given, and forgets them.
template <class W>
inline void search_segment(W& w, Mask among) {
  for (int t = 0; t < w.shape.traces && any(among); ++t) {
    Extreme* best = w.extreme + 2 * t;
    if (w.shape.half_period) {
      w.unsure = w.unsure | search_trace(w, t, 0.0, among, best[0]);
      continue;
    }
    w.unsure = w.unsure | search_trace(w, t, 1.0, among, best[0]);
    w.unsure = w.unsure | search_trace(w, t, -1.0, among, best[1]);
  }
  w.steps = 0;
}

// In the lanes told.
template <class W>
inline void tell_extremes(const W& w, Mask mask) {
  for (int t = 0; t < w.shape.traces; ++t) {
    const auto tell = [&](double* array, Lanes x) { view(array)[t] = select(mask, x, view(array)[t]); };
    const Extreme &most = w.extreme[2 * t], &least = w.extreme[2 * t + 1];
    tell(w.pack.most, most.value);
    tell(w.pack.most_at, most.phase);
    // A motion that repeats with the opposite sign is as far on either side.
    tell(w.pack.least, w.shape.half_period ? -most.value : -least.value);
    if (!w.shape.half_period) tell(w.pack.least_at, least.phase);
  }
}

}  // namespace
