#pragma once

#include "solvers/nonstop/forms.hpp"

// The integrals of products of forms over a step, by Gauss-Legendre.
namespace {

// Six-point Gauss-Legendre nodes and weights on [0, 1] (Abramowitz and Stegun, table 25.4): over a step the
// error is below 5e-14 of the integrand's scale.
constexpr int kNodes = 6;
constexpr double kNodeAt[kNodes] = {0.03376524289842397, 0.16939530676686774, 0.3806904069584015,
                                    0.6193095930415985,  0.8306046932331323,  0.966234757101576};
constexpr double kNodeWeight[kNodes] = {0.08566224618958517, 0.1803807865240693, 0.23395696728634552,
                                        0.23395696728634552, 0.1803807865240693, 0.08566224618958517};

template <class W>
inline void set_factors(W& w, Lanes h) {
  for (int s = 0; s < w.modes; ++s) w.step_factor[s] = exponential({h * w.rate[s].re, h * w.rate[s].im});
  for (int k = 0; k < w.orders; ++k) w.osc_factor[k] = turn(h * w.shape.order[k]);
  if (w.shape.integrated == 0) return;
  for (int i = 0; i < kNodes / 2; ++i) {
    const Lanes t = h * kNodeAt[i];
    for (int s = 0; s < w.modes; ++s)
      w.node_factor[i * w.modes + s] = exponential({t * w.rate[s].re, t * w.rate[s].im});
    for (int k = 0; k < w.orders; ++k) w.node_osc[i * w.orders + k] = turn(t * w.shape.order[k]);
  }
  // The nodes lie symmetrically: exp(rate (h - t)) = exp(rate h) / exp(rate t).
  for (int i = kNodes / 2; i < kNodes; ++i) {
    const int mirror = kNodes - 1 - i;
    for (int s = 0; s < w.modes; ++s) {
      Complex factor = w.step_factor[s] / w.node_factor[mirror * w.modes + s];
      const Mask vanishes = h * w.rate[s].re < lanes(kVanishing);
      const Lanes t = h * kNodeAt[i];
      if (any(vanishes)) factor = select(vanishes, exponential({t * w.rate[s].re, t * w.rate[s].im}), factor);
      w.node_factor[i * w.modes + s] = factor;
    }
    for (int k = 0; k < w.orders; ++k)
      w.node_osc[i * w.orders + k] = w.osc_factor[k] * conjugate(w.node_osc[mirror * w.orders + k]);
  }
}

// Adds a step to all integrals; h is zero in lanes without it.
template <class W>
inline void integrate_step(W& w, Lanes h) {
  const int first = w.shape.first_integrated();
  for (int i = 0; i < kNodes; ++i) {
    const Lanes weight = h * kNodeWeight[i];
    for (int s = 0; s < w.modes; ++s) w.at_node[s] = w.zeta[s] * w.node_factor[i * w.modes + s];
    for (int k = 0; k < w.orders; ++k) w.osc_at_node[k] = w.osc[k] * w.node_osc[i * w.orders + k];
    for (int f = 0; f < w.shape.integrated; ++f)
      w.form_value[f] = value(w, first + f, w.at_node, w.osc_at_node) + w.level[first + f];
    for (int p = 0; p < w.shape.products; ++p) {
      const Product& product = w.shape.product[p];
      const Lanes a = weight * w.form_value[product.a];
      if (product.b >= 0) {
        w.integral[p] += a * w.form_value[product.b];
      } else if (product.b == -1) {
        w.integral[p] += a;
      } else {
        const Complex& u = w.osc_at_node[(-2 - product.b) / 2];
        w.integral[p] += a * (product.b % 2 == 0 ? u.re : u.im);
      }
    }
    for (int p = 0; p < w.shape.powers; ++p) {
      const Product& power = w.shape.power[p];
      const Lanes work = weight * (w.form_value[power.a] * w.form_value[power.b]);
      w.work[p] += work;
      w.work_size[p] += abs(work);
    }
  }
}

}  // namespace
