#include "solvers/mechanics/steady_response.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <complex>

#include "solvers/algebra/solve.hpp"
#include "solvers/mechanics/free_directions.hpp"

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

// Under the constant force f alone dampers let free masses drift on at R c, where nothing else resists them:
//   R^T C R c = R^T f,   K q = P^T (f - C R c),   R^T M q = 0,   P = 1 - R R^T M.
// Without P a force that friction alone holds would move q along R as far as it likes, and rounding with it.
void carry_along(const LinearSystem& system, Eigen::VectorXd& state) {
  const Eigen::MatrixXd& R = system.free_directions;
  const Eigen::Index n = system.masses();
  const Eigen::VectorXd dampers = (system.internal_rate.array() > 0.0)
                                      .select(springs_of(system).cwiseQuotient(system.internal_rate), 0.0);
  const Eigen::MatrixXd C = system.C + system.D * dampers.asDiagonal() * system.D.transpose();
  const Eigen::MatrixXd resistance = R.transpose() * C * R;
  const Eigen::VectorXd drive = R.transpose() * system.constant_force;
  const Eigen::VectorXd velocity =
      R * Eigen::VectorXd(resistance.completeOrthogonalDecomposition().solve(drive));
  state.segment(n, n) = velocity;
  Eigen::VectorXd force = system.constant_force - C * velocity;
  force -= system.M * (R * (R.transpose() * force));
  state.head(n) = algebra::inverse(held_stiffness(system)) * force;
  state.head(n) -= R * (R.transpose() * (system.M * state.head(n)));
}

}  // namespace

Eigen::VectorXd steady_response(const LinearSystem& system, double phase) {
  const Eigen::Index n = system.masses(), internal = system.internal_forces();
  const Eigen::VectorXd springs = springs_of(system);
  Eigen::VectorXd state = Eigen::VectorXd::Zero(2 * n + internal);
  if (system.free_directions.cols() == 0)
    state.head(n) = system.K.llt().solve(system.constant_force);
  else
    carry_along(system, state);
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
