#pragma once

#include "solvers/nonstop/reversals.hpp"

// A form at an instant: what the reversals have left of each mode (zeta), the harmonics (osc), and a level
// that is constant between two reversals.
namespace {

template <class W>
FRAHM_INLINE Lanes value(const W& w, int form, const Complex* zeta, const Complex* osc) {
  return real_sum(w.modes, complex_view(w.pack.form_modal) + form * w.modes, zeta) +
         real_sum(w.orders, w.phasors() + form * w.orders, osc);
}
// By the phase.
template <class W>
FRAHM_INLINE Lanes slope(const W& w, int form, const Complex* zeta, const Complex* osc) {
  return real_sum(w.modes, w.slope_modal + form * w.modes, zeta) +
         real_sum(w.orders, w.slope_phasors() + form * w.orders, osc);
}

// Bound of a form's fourth derivative over the segment that begins at zeta.
template <class W>
FRAHM_INLINE Lanes fourth_derivative(const W& w, int form) {
  Lanes sum = lanes(0.0);
  for (int s = 0; s < w.modes; ++s) {
    const Lanes r2 = w.rate_size[s] * w.rate_size[s];
    sum += size_of(load(w.pack.form_modal, form * w.modes + s)) * size_of(w.zeta[s]) * (r2 * r2);
  }
  for (int k = 0; k < w.orders; ++k) {
    const double n = w.shape.order[k];
    sum += size_of(w.phasors()[form * w.orders + k]) * (n * n * n * n);
  }
  return sum;
}

template <class W>
inline void set_levels(W& w) {
  for (int form = w.contacts; form < w.shape.forms(); ++form) {  // velocities have none
    if (w.is_unused(form)) continue;
    w.level[form] = w.constant[form];
    for (int j = 0; j < w.contacts; ++j) w.level[form] += w.friction[form * w.contacts + j] * w.direction[j];
  }
}

}  // namespace
