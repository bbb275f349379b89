#pragma once

#include <Eigen/Core>
#include <span>

#include "solvers/quantities/integrals.hpp"
#include "solvers/quantities/passage_sensitivity.hpp"

namespace frahm::periodic {

// The derivative of the integrals over an orbit of each signal times the oscillators, and of its square, a
// row each [units of the product x s], while the step in seconds is held:  x = w^T q + p^T y,  dx = w^T dq +
// p^T dy. steps: of the orbit, expanded.  passage: the sensitivity over them.  spans: how many of them make a
// period.
template <int N, int H>
Eigen::MatrixXd signal_products_derivative(std::span<const mechanics::Incidence> signals,
                                           const OrbitSteps<N, H>& orbit,
                                           const PassageSensitivity<N, H>& passage,
                                           const StepEquations<N, H>& eq, double spans) {
  const Eigen::Index n = eq.masses();
  Eigen::MatrixXd products =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(signals.size()), eq.oscillators() + 1);
  const auto steps = orbit.steps();
  for (std::size_t s = 0; s < signals.size(); ++s) {
    const auto& [w, p] = signals[s];
    auto row = products.row(static_cast<Eigen::Index>(s));
    const typename Sizes<N, H>::Oscillators moved = eq.motion.transpose() * p,
                                            moved_by = passage.equations().motion.transpose() * p;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const auto& u = steps[i].expansion.u;
      const Polynomial x = steps[i].expansion.z.leftCols(n) * w + u * moved;
      const Polynomial x_by = passage.polynomials(i).leftCols(n) * w + u * moved_by;
      for (int node = 0; node < kNodes; ++node) {
        const Polynomial power = powers(kNodeAt[node] * steps[i].length);
        const double by = spans * eq.step * steps[i].length * kNodeWeight[node] * x_by.dot(power);
        row.head(eq.oscillators()) += by * (power.transpose() * u);
        row[eq.oscillators()] += 2.0 * by * x.dot(power);
      }
    }
  }
  return products;
}

}  // namespace frahm::periodic
