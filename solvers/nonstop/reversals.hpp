#pragma once

#include "solvers/nonstop/linear_part.hpp"

// The reversals of an orbit on which nothing sticks: one equation for each, that the contact's velocity is
// zero there, in as many phases.
namespace {

// An angle between -pi and pi to 1e-5, to start from (Abramowitz and Stegun 4.4.49).
inline Lanes rough_angle(Complex z) {
  const Lanes x = abs(z.re), y = abs(z.im);
  const Lanes t = min(x, y) / max(max(x, y), lanes(1e-300)), s = t * t;
  Lanes angle = t * (0.9998660 + s * (-0.3302995 + s * (0.1801410 + s * (-0.0851330 + s * 0.0208351))));
  angle = select(y > x, 0.5 * kPi - angle, angle);
  angle = select(z.re < lanes(0.0), kPi - angle, angle);
  return select(z.im < lanes(0.0), -angle, angle);
}

// Where one harmonic drives: Re(V e^{i phase}) crosses zero upwards at phase_0 = -pi/2 - arg V, and friction
// delays that by asin of its own share of the velocity.
template <class W>
inline void guess_single(W& w) {
  for (int j = 0; j < w.contacts; ++j) {
    const Mask rubs = view(w.pack.limit)[j] > 0.0;
    w.count[j] = select(rubs, lanes(w.shape.half_period ? 1.0 : 2.0), lanes(0.0));
    Lanes own = lanes(0.0);
    for (int s = 0; s < w.modes; ++s) own += w.own[(j * w.contacts + j) * w.modes + s].re;
    const Lanes c = min(max(-own / max(modulus(w.phasor[j * w.orders]), lanes(1e-300)), lanes(-0.95)),
                        lanes(0.95)),
                c2 = c * c;
    const Lanes delay = c * (1.0 + c2 * (1.0 / 6.0 + c2 * (0.075 + c2 * 0.12)));
    w.guess[j * kMostReversals] = delay - 0.5 * kPi - rough_angle(w.phasor[j * w.orders]);
    w.guess_turn[j] = lanes(1.0);
    if (!w.shape.half_period) w.guess[j * kMostReversals + 1] = w.guess[j * kMostReversals] + kPi;
  }
}

// cos and sin of the phases 2 pi i / count.
inline void tabulate_turns(int count, double* cosine, double* sine) {
  for (int first = 0; first < count; first += kLanes) {
    Lanes angle = lanes(0.0);
    for (int i = 0; i < kLanes; ++i) at(angle, i) = 2.0 * kPi * (first + i) / count;
    Complex u = turn(angle);
    for (int i = 0; i < kLanes; ++i) {
      cosine[first + i] = at(u.re, i);
      sine[first + i] = at(u.im, i);
    }
  }
}

// Notes a sign change in the lanes that have one, by the secant.
template <class W>
inline void note_reversal(W& w, int j, Mask changes, Lanes v, Lanes place) {
  Lanes changed = select(changes, lanes(1.0), 0.0);
  for (int lane = 0; lane < kLanes; ++lane) {
    if (at(changed, lane) == 0.0) continue;
    const int number = static_cast<int>(at(w.count[j], lane));
    at(w.count[j], lane) = number + 1;
    if (number >= kMostReversals) continue;
    if (number == 0) at(w.guess_turn[j], lane) = at(v, lane) > 0.0 ? 1.0 : -1.0;
    at(w.guess[j * kMostReversals + number], lane) = at(place, lane);
  }
}

// Several harmonics: the sign changes of the velocity without friction, on a grid. Lanes differ in their
// number.
template <class W>
inline void guess_from_samples(W& w) {
  const int turn_samples = w.shape.samples(), samples = turn_samples / (w.shape.half_period ? 2 : 1);
  tabulate_turns(turn_samples, w.cosine, w.sine);
  for (int j = 0; j < w.contacts; ++j) {
    const Mask rubs = view(w.pack.limit)[j] > 0.0;
    w.count[j] = lanes(0.0);
    w.guess_turn[j] = lanes(1.0);
    Lanes before = lanes(0.0);
    for (int i = 0; i <= samples; ++i) {
      Lanes v = lanes(0.0);
      for (int k = 0; k < w.orders; ++k) {
        const int place = static_cast<int>(static_cast<long>(w.shape.order[k]) * i % turn_samples);
        const Complex V = w.phasor[j * w.orders + k];
        v += V.re * w.cosine[place] - V.im * w.sine[place];
      }
      const Mask changes = rubs & (((v > 0.0) & ~(before > 0.0)) | (~(v > 0.0) & (before > 0.0)));
      if (i > 0 && any(changes))
        note_reversal(w, j, changes, v, (w.span / samples) * (lanes(i - 1.0) + before / (before - v)));
      before = v;
    }
  }
}

template <class W>
inline void guess_reversals(W& w) {
  if (w.orders == 1 && w.shape.order[0] == 1)
    guess_single(w);
  else
    guess_from_samples(w);
}

// Lanes with as many reversals of each contact as this one; lays them out contact after contact.
template <class W>
inline Mask lay_out_like(W& w, int lane, Mask among) {
  w.reversals = 0;
  for (int j = 0; j < w.contacts; ++j) {
    const double count = at(w.count[j], lane);
    among = among & (w.count[j] == count);
    const bool rubs = at(view(w.pack.limit)[j], lane) > 0.0;
    among = among & (rubs ? view(w.pack.limit)[j] > 0.0 : ~(view(w.pack.limit)[j] > 0.0));
    // A contact that slides one way only cannot repeat; one of too many reversals is left to others.
    const int number = static_cast<int>(count);
    const bool odd = number % 2 == 1;
    const bool serves = !rubs || (number > 0 && odd == w.shape.half_period);
    if (!serves || w.reversals + number > kMostReversals) return none();
    for (int e = 0; e < number; ++e, ++w.reversals) {
      w.contact[w.reversals] = j;
      w.phase[w.reversals] = w.guess[j * kMostReversals + e];
      w.turn[w.reversals] = e % 2 == 0 ? w.guess_turn[j] : -w.guess_turn[j];
    }
  }
  return among;
}

// A phase brought into [0, span), and the sign that the motion takes with it.
struct Folded {
  Lanes phase, sign;
};
template <class W>
FRAHM_INLINE Folded folded(const W& w, Lanes phase) {
  const Lanes spans = floor(phase * (1.0 / w.span));
  Lanes inside = phase - spans * w.span;
  inside = min(max(inside, lanes(0.0)), lanes(w.span));
  if (!w.shape.half_period) return {inside, lanes(1.0)};
  const Mask odd = ~(abs(spans * 0.5 - rounded(spans * 0.5)) < lanes(0.25));
  return {inside, select(odd, lanes(-1.0), lanes(1.0))};
}

// Adds what reversal e owes to another, which happened since[s] = exp(rate_s theta) ago, with the sign of the
// spans between.
template <class W>
inline void add_influence(W& w, int e, int other, Lanes sign) {
  const int R = w.reversals;
  const Complex* own = w.own + (w.contact[e] * w.contacts + w.contact[other]) * w.modes;
  Lanes speed = lanes(0.0), slope = lanes(0.0);
  for (int s = 0; s < w.modes; ++s) {
    const Complex left = own[s] * w.since[s];
    speed += left.re;
    slope += real_part(left, w.rate[s]);
  }
  const Lanes factor = sign * w.turn[other];
  w.defect[e] += factor * speed;
  w.jacobian[e * R + e] += factor * slope;
  w.jacobian[e * R + other] = -(factor * slope);
}

// Velocities at the reversals, and their derivatives by the phases of all.
template <class W>
inline void set_equations(W& w) {
  const int R = w.reversals;
  for (int e = 0; e < R; ++e) {
    const int i = w.contact[e];
    Lanes v = lanes(0.0), a = lanes(0.0);
    for (int k = 0; k < w.orders; ++k) {
      const Complex u = turn(w.shape.order[k] == 1 ? w.phase[e] : w.shape.order[k] * w.phase[e]);
      v += real_part(w.phasor[i * w.orders + k], u);
      a += real_part(w.slope_phasor[i * w.orders + k], u);
    }
    const Complex* own = w.own + (i * w.contacts + i) * w.modes;
    for (int s = 0; s < w.modes; ++s) v += w.turn[e] * own[s].re;
    w.defect[e] = v;
    w.jacobian[e * R + e] = a;
  }
  // What two reversals owe each other: theta after one, span - theta after the other, exp(rate (span -
  // theta)) = E / exp(rate theta).
  for (int e = 0; e < R; ++e) {
    for (int other = e + 1; other < R; ++other) {
      const Folded since = folded(w, w.phase[e] - w.phase[other]);
      for (int s = 0; s < w.modes; ++s)
        w.since[s] = exponential({since.phase * w.rate[s].re, since.phase * w.rate[s].im});
      add_influence(w, e, other, since.sign);
      const Lanes rest = w.span - since.phase;
      for (int s = 0; s < w.modes; ++s) {
        Complex next = w.over_span[s] / w.since[s];
        const Mask vanishes = w.span * w.rate[s].re < lanes(kVanishing);
        if (any(vanishes))
          next = select(vanishes, exponential({rest * w.rate[s].re, rest * w.rate[s].im}), next);
        w.since[s] = next;
      }
      // The other one follows by span - theta, a span later by its own sign.
      add_influence(w, other, e, w.sign * since.sign);
    }
  }
}

// Gauss's elimination, the diagonal as pivots: a reversal's own acceleration outweighs what others add, or
// the search fails and the point is another solver's. Leaves the solution in `defect`.
template <class W>
inline void eliminate(W& w) {
  const int R = w.reversals;
  Lanes* A = w.jacobian;
  for (int p = 0; p < R; ++p) {
    const Lanes inverse = A[p * R + p] = 1.0 / A[p * R + p];
    for (int row = p + 1; row < R; ++row) {
      const Lanes factor = A[row * R + p] * inverse;
      for (int c = p + 1; c < R; ++c) A[row * R + c] = A[row * R + c] - factor * A[p * R + c];
      w.defect[row] = w.defect[row] - factor * w.defect[p];
    }
  }
  for (int p = R - 1; p >= 0; --p) {
    Lanes sum = w.defect[p];
    for (int c = p + 1; c < R; ++c) sum = sum - A[p * R + c] * w.defect[c];
    w.defect[p] = sum * A[p * R + p];  // the inverse of the pivot stands there
  }
}

// Newton's method; a lane stops once its step is so small that the next would be rounding. Returns the lanes
// that did.
template <class W>
inline Mask find_reversals(W& w, Mask lanes_of_group) {
  constexpr int kMostIterations = 12;
  constexpr double kSmall = 1e-7, kLargest = 1.0;  // of a step [rad]
  Mask going = lanes_of_group;
  Lanes iterations = lanes(0.0);
  for (int i = 0; i < kMostIterations && w.reversals > 0 && any(going); ++i) {
    set_equations(w);
    eliminate(w);
    Lanes largest = lanes(0.0);
    for (int e = 0; e < w.reversals; ++e) {
      largest = max(abs(w.defect[e]), largest);
      const Lanes step = max(min(w.defect[e], lanes(kLargest)), lanes(-kLargest));
      w.phase[e] = select(going, w.phase[e] - step, w.phase[e]);
    }
    iterations = select(going, iterations + 1.0, iterations);
    going = going & ~(largest < lanes(kSmall));
  }
  w.iterations = iterations;
  return w.reversals == 0 ? lanes_of_group : lanes_of_group & ~going;
}

// The reversals in order of phase within the span, each lane for itself, by exchanges of neighbours.
template <class W>
inline void sort_reversals(W& w) {
  const int R = w.reversals;
  for (int e = 0; e < R; ++e) {
    const Folded place = folded(w, w.phase[e]);
    w.sorted_phase[e] = place.phase;
    w.sorted_turn[e] = w.turn[e] * place.sign;
    w.sorted_contact[e] = lanes(w.contact[e]);
  }
  for (int end = R - 1; end > 0; --end) {
    for (int e = 0; e < end; ++e) {
      const Mask swap = w.sorted_phase[e] > w.sorted_phase[e + 1];
      const auto exchange = [&](Lanes* array) {
        const Lanes first = array[e], second = array[e + 1];
        array[e] = select(swap, second, first);
        array[e + 1] = select(swap, first, second);
      };
      exchange(w.sorted_phase);
      exchange(w.sorted_turn);
      exchange(w.sorted_contact);
    }
  }
}

}  // namespace
