#pragma once

#include "solvers/nonstop/work.hpp"

// The response with all contacts sliding, without friction, and what friction adds to it a reversal.
namespace {

// e^z
FRAHM_INLINE Complex exponential(Complex z) {
  return exp(z.re) * turn(z.im);
}

FRAHM_INLINE Complex load(const double* array, int index) {
  return complex_view(array)[index];
}

// sum_s Re(factor_s coordinate_s)
FRAHM_INLINE Lanes real_sum(int count, const Complex* factor, const Complex* coordinate) {
  Lanes sum = lanes(0.0);
  for (int i = 0; i < count; ++i) sum += real_part(factor[i], coordinate[i]);
  return sum;
}

// E_s = exp(lambda_s span); after it the motion repeats with its sign, so that what a reversal leaves in a
// mode adds up to 1 / (1 - sign E_s) of itself. False in lanes so near a resonance without damping that
// digits would be lost.
template <class W>
inline Mask set_rates(W& w) {
  constexpr double kResonance = 1e-3, kLargest = 1e5;
  const Lanes per_radian = 1.0 / *view(w.pack.omega);
  Mask usable = *view(w.pack.is_there) > 0.5;
  // Under several harmonics a frictionless contact may turn twice in a step, and its reversals would be
  // miscounted.
  for (int j = 0; w.shape.asks_strokes && w.orders > 1 && j < w.contacts; ++j)
    usable = usable & (view(w.pack.limit)[j] > 0.0);
  for (int s = 0; s < w.modes; ++s) {
    const Complex lambda = load(w.pack.lambda, s);
    w.rate[s] = per_radian * lambda;
    w.rate_size[s] = size_of(w.rate[s]);
    const Complex E = exponential({w.span * w.rate[s].re, w.span * w.rate[s].im});
    w.over_span[s] = E;
    const Complex left = {1.0 - w.sign * E.re, -w.sign * E.im};
    const Lanes size = size_of(left);
    usable = usable & (size > kResonance) & (w.rate_size[s] < lanes(kLargest));
    w.closure[s] = Complex{lanes(1.0), lanes(0.0)} / left;
  }
  return usable;
}

// (c_0 + c_1 d/dt + c_2 d^2/dt^2) of an input's harmonic
template <class Factor>
FRAHM_INLINE Complex acted(const Factor* c, Lanes rate, Complex input) {
  if constexpr (sizeof(Factor) == sizeof(Complex)) {
    const Complex by = {c[0].re - rate * (c[1].im + rate * c[2].re),
                        c[0].im + rate * (c[1].re - rate * c[2].im)};
    return by * input;
  } else {
    return Complex{c[0] - rate * rate * c[2], rate * c[1]} * input;
  }
}
FRAHM_INLINE Complex acted_conjugate(const Complex* c, Lanes rate, Complex input) {
  const Complex conjugates[3] = {conjugate(c[0]), conjugate(c[1]), conjugate(c[2])};
  return acted(conjugates, rate, input);
}

// (i n omega - lambda_s) eta_s = drive_s of each harmonic, and the same with the conjugate mode.
template <class W>
inline void respond_to_forcing(W& w) {
  const Lanes omega = *view(w.pack.omega);
  for (int k = 0; k < w.orders; ++k) {
    w.harmonic_size[k] = lanes(0.0);
    const Lanes rate = omega * w.shape.order[k];
    for (int s = 0; s < w.modes; ++s) {
      const Complex lambda = load(w.pack.lambda, s);
      Complex drive = {lanes(0.0), lanes(0.0)}, by_conjugate = drive;
      for (int i = 0; i < w.inputs; ++i) {
        const Complex* c = complex_view(w.pack.mode_input) + (s * w.inputs + i) * 3;
        const Complex input = load(w.pack.input, i * w.orders + k);
        drive += acted(c, rate, input);
        if (w.shape.is_pair[s]) by_conjugate += acted_conjugate(c, rate, input);
      }
      const int i = k * w.modes + s;
      w.response[i] = drive / Complex{-lambda.re, rate - lambda.im};
      w.conjugate_response[i] = by_conjugate / Complex{-lambda.re, rate + lambda.im};
      w.harmonic_size[k] +=
          view(w.pack.mode_norm)[s] * (size_of(w.response[i]) + size_of(w.conjugate_response[i]));
    }
  }
}

// A form c . y + direct has the amplitude sum_s (c_s eta_s + conj(c_s) eta'_s) + direct.
template <class W>
inline void find_phasors(W& w) {
  const Lanes omega = *view(w.pack.omega);
  for (int form = 0; form < w.shape.forms(); ++form) {
    if (w.is_unused(form)) continue;
    for (int k = 0; k < w.orders; ++k) {
      Complex sum = {lanes(0.0), lanes(0.0)};
      for (int s = 0; s < w.modes; ++s) {
        const Complex c = load(w.pack.form_modal, form * w.modes + s);
        sum += c * w.response[k * w.modes + s];
        sum += conjugate(c) * w.conjugate_response[k * w.modes + s];
      }
      Complex direct = {lanes(0.0), lanes(0.0)};
      for (int i = 0; w.shape.is_direct[form] && i < w.inputs; ++i) {
        direct += acted(view(w.pack.form_input) + (form * w.inputs + i) * 3, omega * w.shape.order[k],
                        load(w.pack.input, i * w.orders + k));
      }
      w.direct[form * w.orders + k] = direct;
      w.phasor[form * w.orders + k] = sum + direct;
    }
    w.constant[form] = lanes(0.0);
    for (int i = 0; i < w.inputs; ++i)
      w.constant[form] +=
          view(w.pack.form_constant_input)[form * w.inputs + i] * view(w.pack.constant_input)[i];
    for (int j = 0; j < w.contacts; ++j) {
      const int i = form * w.contacts + j;
      w.friction[i] =
          view(w.pack.form_friction)[i] * view(w.pack.limit)[j] + view(w.pack.form_own_friction)[i];
    }
  }
  const int sloped = w.shape.first_integrated();
  for (int form = 0; form < sloped; ++form) {
    if (w.is_displacement(form)) continue;
    for (int s = 0; s < w.modes; ++s) {
      w.slope_modal[form * w.modes + s] = load(w.pack.form_modal, form * w.modes + s) * w.rate[s];
    }
    for (int k = 0; k < w.orders; ++k) {
      const Complex X = w.phasor[form * w.orders + k];
      const double n = w.shape.order[k];
      w.slope_phasor[form * w.orders + k] = {-n * X.im, n * X.re};
    }
  }
  for (int i = 0; i < w.contacts; ++i) {
    w.speed[i] = lanes(0.0);
    for (int k = 0; k < w.orders; ++k) w.speed[i] += size_of(w.phasor[i * w.orders + k]);
    w.per_speed[i] = 1.0 / w.speed[i];
  }
}

// eta_s' = lambda_s eta_s - F push_s sigma: with the direction sigma of a contact held, eta_s would rest at
// F push_s sigma / lambda_s. Where sigma turns from -1 to +1 this moves by 2 F push_s / lambda_s, and zeta_s,
// the distance from it, by as much the other way; it dies out as exp(lambda_s t). Velocities are owed to zeta
// alone.
template <class W>
inline void find_jumps(W& w) {
  for (int j = 0; j < w.contacts; ++j) {
    for (int s = 0; s < w.modes; ++s) {
      const int i = j * w.modes + s;
      w.jump[i] = view(w.pack.limit)[j] * load(w.pack.unit_jump, i);
    }
  }
  for (int i = 0; i < w.contacts; ++i) {
    for (int j = 0; j < w.contacts; ++j) {
      for (int s = 0; s < w.modes; ++s) {
        w.own[(i * w.contacts + j) * w.modes + s] =
            load(w.pack.form_modal, i * w.modes + s) * (w.jump[j * w.modes + s] * w.closure[s]);
      }
    }
  }
}

}  // namespace
