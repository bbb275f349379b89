#include "solvers/mechanics/steady_response.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <complex>

namespace frahm::mechanics {
namespace {

using Complex = std::complex<double>;

// Spring stiffness of each internal force; 0 of those of contacts.
Eigen::VectorXd springs_of(const LinearSystem& system) {
  Eigen::VectorXd springs = system.internal_stiffness;
  for (const Eigen::Index internal : system.contact_internal) {
    if (internal >= 0) springs[internal] = 0.0;
  }
  return springs;
}

}  // namespace

Eigen::VectorXd steady_response(const LinearSystem& system, double phase) {
  const Eigen::Index n = system.masses(), internal = system.internal_forces();
  const Eigen::VectorXd springs = springs_of(system);
  Eigen::VectorXd state = Eigen::VectorXd::Zero(2 * n + internal);
  state.head(n) = system.K.llt().solve(system.constant_force);
  for (Eigen::Index k = 0; k < system.force.cols(); ++k) {
    const int order = system.orders[static_cast<std::size_t>(k)];
    const Complex i_rate(0.0, order * system.omega);
    // S = g (D^T X + p^T Y),  g = k i Omega / (i Omega + rate)
    const Eigen::ArrayXcd g =
        springs.array() * i_rate / (system.internal_rate.cast<Complex>().array() + i_rate);
    const Eigen::VectorXcd from_support =
        g.matrix().asDiagonal() * (system.D_support.transpose() * system.motion.col(k));
    Eigen::MatrixXcd stiffness = system.K + i_rate * system.C + (i_rate * i_rate) * system.M;
    stiffness += system.D * g.matrix().asDiagonal() * system.D.transpose();
    const Eigen::VectorXcd X = stiffness.partialPivLu().solve(system.force.col(k) - system.D * from_support);
    const Eigen::VectorXcd S = g.matrix().asDiagonal() * (system.D.transpose() * X) + from_support;
    const Complex turn = std::polar(1.0, order * phase);
    state.head(n) += (turn * X).real();
    state.segment(n, n) += (i_rate * turn * X).real();
    state.tail(internal) += (turn * S).real();
  }
  return state;
}

}  // namespace frahm::mechanics
