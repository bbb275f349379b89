#pragma once

#include <Eigen/Core>
#include <span>

#include "solvers/quantities/integrals.hpp"
#include "solvers/quantities/passage_sensitivity.hpp"

namespace frahm::periodic {

// How a joint's displacement  B q + X s + offset u  hangs on state and oscillators, and its derivative.
template <int N, int H>
struct JointProducts {
  explicit JointProducts(const StepJoints& joints, const Eigen::VectorXd& j)
      : q(joints.B.transpose() * j), s(joints.X.transpose() * j), u(joints.offset.transpose() * j) {}
  Polynomial of(const typename Sizes<N, H>::StatePolynomials& z) const {
    return z.leftCols(q.size()) * q + z.rightCols(s.size()) * s;
  }
  Eigen::VectorXd q, s, u;
};

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
    const auto& [w, p, j] = signals[s];
    const bool has_joint = signals[s].has_joint();
    auto row = products.row(static_cast<Eigen::Index>(s));
    const typename Sizes<N, H>::Oscillators moved = eq.motion.transpose() * p,
                                            moved_by = passage.equations().motion.transpose() * p;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const auto& u = steps[i].expansion.u;
      Polynomial x = steps[i].expansion.z.leftCols(n) * w + u * moved;
      Polynomial x_by = passage.polynomials(i).leftCols(n) * w + u * moved_by;
      if (has_joint) {
        const JointProducts<N, H> its(eq.joints, j), changed(passage.equations().joints, j);
        x += its.of(steps[i].expansion.z) + u * its.u;
        x_by += its.of(passage.polynomials(i)) + changed.of(steps[i].expansion.z) + u * changed.u;
      }
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
