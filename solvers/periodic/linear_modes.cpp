#include "solvers/periodic/linear_modes.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace frahm::periodic {
namespace {

// phi^T C phi / (2 omega phi^T M phi) of an undamped mode; a Maxwell element adds the damping it has at
// omega,
//   Re[k / (i omega + k/c)] = k (k/c) / (omega^2 + (k/c)^2).
double damping_ratio(const mechanics::LinearSystem& system, const Eigen::VectorXd& shape, double omega) {
  const Eigen::ArrayXd rate = system.maxwell_rate.array();
  const Eigen::VectorXd dampers = system.maxwell_stiffness.array() * rate / (omega * omega + rate * rate);
  const Eigen::VectorXd strain = system.D.transpose() * shape;
  const double loss = shape.dot(system.C * shape) + strain.dot(dampers.asDiagonal() * strain);
  return loss / (2.0 * omega * shape.dot(system.M * shape));
}

}  // namespace

void modes_of(const mechanics::LinearSystem& system, std::vector<double>& frequency,
              std::vector<double>& damping) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(system.K, system.M);
  frequency.clear();
  damping.clear();
  for (Eigen::Index k = 0; k < system.masses(); ++k) {
    const Eigen::VectorXd shape = modes.eigenvectors().col(k);  // phi^T M phi = 1
    const double omega = std::sqrt(modes.eigenvalues()[k]);
    frequency.push_back(omega);
    damping.push_back(damping_ratio(system, shape, omega));
  }
}

LinearModes linear_modes(const mechanics::Network& network, const mechanics::NetworkValues& values,
                         bool all_stuck) {
  const mechanics::Assembly assembly(network);
  mechanics::LinearSystem system;
  assembly.set_values(values, system);
  const Eigen::Index n = system.masses();
  // What still moves when every contact sticks: displacements B eta with W^T B = 0.
  Eigen::MatrixXd B = Eigen::MatrixXd::Identity(n, n);
  if (all_stuck && system.contacts() > 0) {
    const Eigen::FullPivLU<Eigen::MatrixXd> constraints(system.W.transpose());
    if (constraints.dimensionOfKernel() == 0) return {};
    B = constraints.kernel();
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(B.transpose() * system.K * B,
                                                                        B.transpose() * system.M * B);
  LinearModes result;
  for (Eigen::Index k = 0; k < B.cols(); ++k) {
    Eigen::VectorXd shape = B * modes.eigenvectors().col(k);
    const double omega = std::sqrt(modes.eigenvalues()[k]);
    result.frequency.push_back(omega);
    result.damping.push_back(damping_ratio(system, shape, omega));
    Eigen::Index largest = 0;
    shape.cwiseAbs().maxCoeff(&largest);
    shape /= shape[largest];
    result.shape.emplace_back(shape.data(), shape.data() + n);
  }
  return result;
}

}  // namespace frahm::periodic
