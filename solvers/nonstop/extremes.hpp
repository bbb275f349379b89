#pragma once

#include "solvers/nonstop/sweep.hpp"

// The extremes of the traces, over the steps that the sweep has kept: stationary points solved, and both limits
// where the friction turns.
namespace {

struct Extreme {
  Lanes value;
  Lanes reached, phase;  // the largest value that is reached somewhere, not held from before, and where
};

// The larger of two candidates; if phases are asked for, of equal ones (to 1e-12) the earlier that is reached.
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

// The stationary point of a trace near `place` within a step, and its value: with the slope's own slopes there,
// d + e c + f c^2 / 2 = 0 is solved for the correction c, again where it is not slight.
template <class W>
inline Lanes stationary_value(const W& w, int form, int step, Lanes h, Lanes level, Lanes& place) {
  constexpr int kMostIterations = 6;
  // [rad]; the error of the value is its fourth power over 24, that of the phase its third.
  const double slight = w.shape.asks_phases ? 1e-5 : 1e-3;
  const Complex* zeta = w.zeta_at + step * w.modes;
  const Complex* osc = w.osc_at + step * w.orders;
  const Complex* c = complex_view(w.pack.form_modal) + form * w.modes;
  const Complex* X = (w.is_rest_at[step] ? w.rest_phasor : w.phasor) + form * w.orders;
  Lanes x = lanes(0.0);
  for (int i = 0; i < kMostIterations; ++i) {
    x = level;
    Lanes d = lanes(0.0), e = lanes(0.0), f = lanes(0.0);
    for (int s = 0; s < w.modes; ++s) {
      Complex part = c[s] * (zeta[s] * exponential({place * w.rate[s].re, place * w.rate[s].im}));
      x += part.re;
      part = part * w.rate[s];
      d += part.re;
      part = part * w.rate[s];
      e += part.re;
      f += real_part(part, w.rate[s]);
    }
    for (int k = 0; k < w.orders; ++k) {
      const double n = w.shape.order[k];
      const Complex part = X[k] * (osc[k] * turn(place * n));
      x += part.re;
      d = d - n * part.im;
      e = e - (n * n) * part.re;
      f += (n * n * n) * part.im;
    }
    // Halley's step; within the step of the sweep.
    const Lanes newton = -d / e;
    const Lanes full = newton / (1.0 + 0.5 * newton * (f / e));
    const Lanes correction = max(min(full, h - place), -place);
    x += correction * (d + correction * (0.5 * e + correction * ((1.0 / 6.0) * f)));
    place = place + correction;
    if (!any(abs(correction) > slight)) break;
  }
  return x;
}

// The largest value of `side` times a trace; side 0: of its magnitude.
template <class W>
inline Extreme largest(const W& w, int t, double side) {
  const int T = w.shape.traces, form = w.shape.first_trace() + t;
  Extreme best{lanes(-1e300), lanes(-1e300), lanes(0.0)};
  const auto facing = [&](const Lanes* kept) {
    return side != 0.0 ? lanes(side) : select(kept[0] + kept[2] < 0.0, lanes(-1.0), lanes(1.0));
  };
  const auto phase_of = [&](Lanes phase, Lanes faced) {
    if (!w.shape.asks_phases) return phase;
    const Lanes shifted = side == 0.0 ? select(faced < 0.0, phase + kPi, phase) : phase;
    const Lanes turns = floor(shifted * (0.5 / kPi));
    return shifted - turns * (2.0 * kPi);
  };
  for (int step = 0; step < w.steps; ++step) {
    const Lanes* kept = w.left + (step * T + t) * 5;
    const Lanes h = w.length[step], f = facing(kept);
    const Mask moves = abs(kept[2] - kept[0]) > 1e-13 * abs(kept[2]);
    consider(w, best, h > 0.0, none(), f * kept[0], lanes(0.0));
    consider(w, best, h > 0.0, moves, f * kept[2], phase_of(w.phase_at[step] + h, f));
  }
  for (int step = 0; step < w.steps; ++step) {
    const Lanes* kept = w.left + (step * T + t) * 5;
    const Lanes h = w.length[step], f = facing(kept);
    const Lanes x0 = f * kept[0], d0 = f * kept[1] * h, x1 = f * kept[2], d1 = f * kept[3] * h;
    // Bernstein coefficients as in the proof; the fourth derivative adds less than the slack.
    const Lanes b1 = x0 + d0 * (1.0 / 3.0), b2 = x1 - d1 * (1.0 / 3.0);
    const Lanes slack = 0.02 * (abs(d0) + abs(d1));
    const Lanes highest = max(max(0.25 * x0 + 0.75 * b1, 0.5 * (b1 + b2) + slack), 0.75 * b2 + 0.25 * x1);
    // The derivative of the cubic Hermite interpolant in s: d0 + 2 q s + 3 r s^2; its falling zero.
    const Lanes rise = x1 - x0, q = 3.0 * rise - 2.0 * d0 - d1, r = d0 + d1 - 2.0 * rise;
    const Lanes under = q * q - 3.0 * r * d0;
    const Mask may = (h > 0.0) & (highest > best.value + 1e-14 * abs(best.value)) & ~(under < lanes(0.0));
    if (!any(may)) continue;
    // The falling zero of d0 + 2 q s + 3 r s^2 is (-q - root) / (3 r) = d0 / (root - q).
    const Lanes root = sqrt(max(under, lanes(0.0)));
    const Lanes falling = select(q < lanes(0.0), d0 / (root - q), (-q - root) / (3.0 * r));
    // A release begins with a slope of zero, which is no extreme that is reached.
    const Mask inside = may & (falling > (w.is_release_at[step] ? 1e-4 : 0.0)) & (falling < lanes(1.0));
    if (!any(inside)) continue;
    Lanes place = select(inside, falling * h, 0.0);
    const Lanes x = f * stationary_value(w, form, step, h, kept[4], place);
    consider(w, best, inside, inside, x, phase_of(w.phase_at[step] + place, f));
  }
  return best;
}

// In the lanes told.
template <class W>
inline void tell_extremes(const W& w, Mask told) {
  for (int t = 0; t < w.shape.traces; ++t) {
    const auto tell = [&](double* array, Lanes x) { view(array)[t] = select(told, x, view(array)[t]); };
    if (w.shape.half_period) {
      const Extreme most = largest(w, t, 0.0);
      tell(w.pack.most, most.value);
      tell(w.pack.least, -most.value);
      tell(w.pack.most_at, most.phase);
      continue;
    }
    const Extreme most = largest(w, t, 1.0), least = largest(w, t, -1.0);
    tell(w.pack.most, most.value);
    tell(w.pack.least, -least.value);
    tell(w.pack.most_at, most.phase);
    tell(w.pack.least_at, least.phase);
  }
}

}  // namespace
