#pragma once

#include "solvers/nonstop/passage.hpp"

// The state at a section amid the first segment, and the derivative of the map from there: flows of the
// modes, and at each reversal a change of rank one (saltation). Its largest multiplier and its norm in
// energy.
namespace {

// rows: of the real modal coordinates (a, b) of each mode, of which the motion is Re(vector (a + i b)).
template <class W>
inline void flow_rows(const W& w, Lanes length, Lanes* rows, int columns) {
  int row = 0;
  for (int s = 0; s < w.modes; ++s) {
    if (!w.shape.is_pair[s]) {
      const Lanes e = exp(length * w.rate[s].re);
      for (int c = 0; c < columns; ++c) rows[row * columns + c] = e * rows[row * columns + c];
      ++row;
      continue;
    }
    const Complex e = exponential({length * w.rate[s].re, length * w.rate[s].im});
    for (int c = 0; c < columns; ++c) {
      const Complex x = e * Complex{rows[row * columns + c], rows[(row + 1) * columns + c]};
      rows[row * columns + c] = x.re;
      rows[(row + 1) * columns + c] = x.im;
    }
    row += 2;
  }
}

// A reversal at u' = 0 with the acceleration a before it: dz+ = dz- - (2 turn F / a) b (w^T dz-), b = M^-1 w.
template <class W>
inline void cross_reversal(W& w, int p) {
  const int D = w.states;
  const Lanes acceleration = *view(w.pack.omega) * w.slope_before[p];
  const Lanes turned = select(acceleration > 0.0, lanes(1.0), lanes(-1.0));
  for (int row = 0; row < D; ++row) w.turned_push[row] = w.velocity_of[row] = lanes(0.0);
  for (int j = 0; j < w.contacts; ++j) {
    const Mask own = w.sorted_contact[p] == j;
    const Lanes gain = 2.0 * turned * view(w.pack.limit)[j] / acceleration;
    int row = 0;
    for (int s = 0; s < w.modes; ++s) {
      const Complex push = load(w.pack.push, j * w.modes + s);
      const Complex velocity = load(w.pack.form_modal, j * w.modes + s);
      w.turned_push[row] = select(own, gain * push.re, w.turned_push[row]);
      w.velocity_of[row] = select(own, velocity.re, w.velocity_of[row]);
      ++row;
      if (!w.shape.is_pair[s]) continue;
      w.turned_push[row] = select(own, gain * push.im, w.turned_push[row]);
      w.velocity_of[row] = select(own, -velocity.im, w.velocity_of[row]);
      ++row;
    }
  }
  for (int c = 0; c < D; ++c) {
    Lanes along = lanes(0.0);
    for (int row = 0; row < D; ++row) along += w.velocity_of[row] * w.flow[row * D + c];
    for (int row = 0; row < D; ++row) w.flow[row * D + c] = w.flow[row * D + c] - w.turned_push[row] * along;
  }
}

template <class W>
inline void differentiate_map(W& w) {
  const int D = w.states, R = w.reversals;
  for (int i = 0; i < D * D; ++i) w.flow[i] = lanes(i / D == i % D ? 1.0 : 0.0);
  if (R == 0) return flow_rows(w, lanes(w.span), w.flow, D);
  const Lanes half = 0.5 * w.segment_length[0];
  flow_rows(w, half, w.flow, D);
  for (int p = 1; p <= R; ++p) {
    cross_reversal(w, p % R);
    flow_rows(w, p < R ? w.segment_length[p] : half, w.flow, D);
  }
}

// Adds the terms k of `from` to `to` to some rows and columns of result = a b, all D x D; the sums stay in
// registers.
template <int Rows, int Columns>
FRAHM_INLINE void multiply_tile(int D, int from, int to, const Lanes* a, const Lanes* b, Lanes* result) {
  Lanes sum[Rows][Columns];
  for (int r = 0; r < Rows; ++r) {
    for (int c = 0; c < Columns; ++c) sum[r][c] = from == 0 ? a[r * D] * b[c] : result[r * D + c];
  }
  for (int k = from == 0 ? 1 : from; k < to; ++k) {
    for (int r = 0; r < Rows; ++r) {
      for (int c = 0; c < Columns; ++c) sum[r][c] += a[r * D + k] * b[k * D + c];
    }
  }
  for (int r = 0; r < Rows; ++r) {
    for (int c = 0; c < Columns; ++c) result[r * D + c] = sum[r][c];
  }
}

// result = a b, all of the size of the states. Terms are added by portions of which the rows of b stay in the
// cache, always in the same order.  symmetric: the result is, so that half of it is enough.
template <class W>
inline void multiply(const W& w, const Lanes* a, const Lanes* b, Lanes* result, bool symmetric = false) {
  constexpr int kRows = 4, kColumns = 2, kPortion = 32;
  const int D = w.states;
  for (int from = 0; from < D; from += kPortion) {
    const int to = from + kPortion < D ? from + kPortion : D;
    int i = 0;
    for (; i + kRows <= D; i += kRows) {
      int j = symmetric ? i : 0;
      for (; j + kColumns <= D; j += kColumns)
        multiply_tile<kRows, kColumns>(D, from, to, a + i * D, b + j, result + i * D + j);
      if (j < D) multiply_tile<kRows, 1>(D, from, to, a + i * D, b + j, result + i * D + j);
    }
    for (; i < D; ++i) {
      for (int j = symmetric ? i : 0; j < D; ++j)
        multiply_tile<1, 1>(D, from, to, a + i * D, b + j, result + i * D + j);
    }
  }
  if (!symmetric) return;
  for (int i = 1; i < D; ++i) {
    for (int j = 0; j < i; ++j) result[i * D + j] = result[j * D + i];
  }
}

// The largest modulus of the eigenvalues of A, which is overwritten: of A^m, m = 2^k, two eigenvalues of
// largest modulus have the trace and half of trace^2 - trace(A^2m) as their sum and product. What others add
// dies out as m grows, and the m-th root leaves 1/m of it. Ends when `accuracy` is reached in every lane.
// symmetric: A is.
template <class W>
inline Lanes largest_modulus(const W& w, Lanes* A, Lanes* scratch, double accuracy, bool symmetric = false) {
  const int D = w.states;
  constexpr int kMostSquarings = 40;
  Lanes exponent = lanes(0.0), estimate = lanes(1e300);
  Mask going = estimate > 0.0;
  double share = 1.0;
  for (int k = 0; k < kMostSquarings; ++k, share *= 0.5) {
    Lanes size = lanes(1e-290);
    for (int i = 0; i < D * D; ++i) size = max(abs(A[i]), size);
    const Lanes inverse = 1.0 / size;
    for (int i = 0; i < D * D; ++i) A[i] = A[i] * inverse;
    exponent = exponent + share * log(size);
    multiply(w, A, A, scratch, symmetric);
    Lanes trace = lanes(0.0), trace_of_square = lanes(0.0);
    for (int i = 0; i < D; ++i) {
      trace += A[i * D + i];
      trace_of_square += scratch[i * D + i];
    }
    const Lanes half = 0.5 * trace, product = 0.5 * (trace * trace - trace_of_square);
    const Lanes under = half * half - product;
    const Lanes of_pair = sqrt(max(product, lanes(0.0)));
    const Lanes largest = select(under < 0.0, of_pair, abs(half) + sqrt(max(under, lanes(0.0))));
    const Lanes next = exponent + share * log(max(largest, lanes(1e-290)));
    // One agreement may be chance while the first powers still turn.
    const Mask agrees = abs(next - estimate) < lanes(accuracy);
    estimate = select(going, next, estimate);
    if (k > 3) going = going & ~agrees;
    if (!any(going)) break;
    for (int i = 0; i < D * D; ++i) A[i] = scratch[i];
  }
  return exp(estimate);
}

// The largest multiplier. Without a reversal the map is the modes' own flow, and it is exp(Re lambda T) of
// one.
template <class W>
inline Lanes largest_multiplier(W& w) {
  if (w.reversals > 0) {
    for (int i = 0; i < w.states * w.states; ++i) w.square[i] = w.flow[i];
    return largest_modulus(w, w.square, w.scratch, 1e-14);
  }
  Lanes largest = w.rate[0].re;
  for (int s = 1; s < w.modes; ++s) largest = max(largest, w.rate[s].re);
  return exp(w.span * largest);
}

// Modal coordinates amid the first segment: what the reversals left, the harmonics, and the rest positions
// under friction and constant forces.
template <class W>
inline void find_state(W& w, Lanes section) {
  const Lanes half = 0.5 * w.segment_length[0];
  for (int s = 0; s < w.modes; ++s) {
    const Complex lambda = load(w.pack.lambda, s);
    Complex sum = w.first_zeta[s] * exponential({half * w.rate[s].re, half * w.rate[s].im});
    for (int k = 0; k < w.orders; ++k) {
      const Complex u = turn(section * w.shape.order[k]);
      sum += w.response[k * w.modes + s] * u;
      sum += conjugate(w.conjugate_response[k * w.modes + s] * u);
    }
    Complex force = {lanes(0.0), lanes(0.0)};
    for (int i = 0; i < w.inputs; ++i) {
      const double both = w.shape.is_pair[s] ? 2.0 : 1.0;
      force += (both * view(w.pack.constant_input)[i]) * load(w.pack.mode_input, (s * w.inputs + i) * 3);
    }
    for (int j = 0; j < w.contacts; ++j) {
      const Complex push = load(w.pack.push, j * w.modes + s);
      force = force - (w.first_direction[j] * view(w.pack.limit)[j]) * push;
    }
    sum = sum - force / lambda;
    if (!w.shape.is_pair[s]) sum.im = lanes(0.0);
    w.state[s] = sum;
  }
}

// Energy norm of a state.
template <class W, class Coordinate>
inline Lanes norm_of_coordinates(const W& w, const Coordinate& coordinate) {
  const int D = w.states;
  Lanes sum = lanes(0.0);
  for (int row = 0; row < D; ++row) {
    Lanes x = lanes(0.0);
    for (int c = 0; c < D; ++c) x += view(w.pack.to_energy)[row * D + c] * coordinate(c);
    sum += x * x;
  }
  return sqrt(0.5 * sum);
}

template <class W>
inline Lanes norm_of_state(W& w) {
  int c = 0;
  for (int s = 0; s < w.modes; ++s) {
    w.turned_push[c++] = w.state[s].re;
    if (w.shape.is_pair[s]) w.turned_push[c++] = w.state[s].im;
  }
  return norm_of_coordinates(w, [&](int i) { return w.turned_push[i]; });
}

// Tells the norm of the state, multipliers and contraction, in the lanes told.
template <class W>
inline void judge(W& w, Mask mask) {
  const int D = w.states;
  const auto tell = [&](double* array, Lanes x) { *view(array) = select(mask, x, *view(array)); };
  const Lanes section = (w.reversals > 0 ? w.sorted_phase[0] : lanes(0.0)) + 0.5 * w.segment_length[0];
  find_state(w, section);
  tell(w.pack.state_norm, norm_of_state(w));

  differentiate_map(w);
  const Lanes radius = largest_multiplier(w);
  tell(w.pack.multiplier, w.shape.half_period ? radius * radius : radius);

  multiply(w, view(w.pack.to_energy), w.flow, w.scratch);
  multiply(w, w.scratch, view(w.pack.from_energy), w.flow);
  for (int i = 0; i < D * D; ++i) w.scratch[i] = w.flow[i % D * D + i / D];  // transposed
  multiply(w, w.scratch, w.flow, w.square, true);
  tell(w.pack.contraction, sqrt(largest_modulus(w, w.square, w.scratch, 1e-6, true)));
}

}  // namespace
