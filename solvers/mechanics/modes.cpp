#include "solvers/mechanics/modes.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "solvers/algebra/no_value.hpp"
#include "solvers/algebra/null_space.hpp"
#include "solvers/algebra/solve.hpp"
#include "solvers/algebra/symmetric_modes.hpp"
#include "solvers/mechanics/free_directions.hpp"

namespace frahm::periodic {
namespace {

// phi^T C phi / (2 omega phi^T M phi) of an undamped mode; a Maxwell element adds the damping it has at
// omega,
//   Re[k / (i omega + k/c)] = k (k/c) / (omega^2 + (k/c)^2).
double damping_ratio(const mechanics::LinearSystem& system, const Eigen::VectorXd& shape, double omega) {
  const Eigen::ArrayXd rate = system.internal_rate.array();
  const Eigen::VectorXd dampers = system.internal_stiffness.array() * rate / (omega * omega + rate * rate);
  const Eigen::VectorXd strain = system.D.transpose() * shape;
  if (omega == 0.0) return kNone;
  const double loss = shape.dot(system.C * shape) + strain.dot(dampers.asDiagonal() * strain);
  return loss / (2.0 * omega * shape.dot(system.M * shape));
}

// With G, k of the joints' damped directions (mechanics/joints.hpp), t = G D^T phi their share in a mode, and
// R = (i omega G + k)^-1, the loss is  t^T G^-1 t + omega Im(t^T R t).  Its derivative by G, k and D, at G
// = 1.
double loss_of_joints_by(const mechanics::LinearSystem& system, const mechanics::LinearSystem& by,
                         const Eigen::VectorXd& strain, const Eigen::VectorXd& shape, double omega) {
  const std::complex<double> i_omega(0.0, omega);
  const Eigen::VectorXd& k = system.internal_stiffness;
  const Eigen::MatrixXd& k_by = by.joints.stiffness_by;
  const Eigen::MatrixXd G_by = k.cwiseInverse().asDiagonal() * (k_by - by.joints.rate_by);
  const Eigen::VectorXd t_by = by.D.transpose() * shape + G_by * strain;
  const Eigen::VectorXcd Rt = strain.array() / (k.array() + i_omega);
  const std::complex<double> changed = 2.0 * t_by.cast<std::complex<double>>().cwiseProduct(Rt).sum() -
                                       Rt.cwiseProduct(i_omega * (G_by * Rt) + k_by * Rt).sum();
  return 2.0 * strain.dot(t_by) - strain.dot(G_by * strain) + omega * changed.imag();
}

}  // namespace

void modes_of(const mechanics::LinearSystem& system, std::vector<double>& frequency,
              std::vector<double>& damping) {
  const algebra::SymmetricModes modes = mechanics::undamped_modes_of(system);
  frequency.clear();
  damping.clear();
  for (Eigen::Index k = 0; k < system.masses(); ++k) {
    const Eigen::VectorXd shape = modes.vectors.col(k);  // phi^T M phi = 1
    const double omega = std::sqrt(modes.values[k]);
    frequency.push_back(omega);
    damping.push_back(damping_ratio(system, shape, omega));
  }
}

// lambda = omega^2, phi^T M phi = 1:  dlambda = phi^T (dK - lambda dM) phi,
//   dphi = sum_j phi_j phi_j^T (dK - lambda dM) phi / (lambda - lambda_j) - phi (phi^T dM phi) / 2
// (R. L. Fox and M. P. Kapoor, AIAA J. 6 (1968) 2426), and the damping ratio is loss / (2 omega).
void modes_derivative(const mechanics::LinearSystem& system, const mechanics::LinearSystem& by,
                      std::vector<double>& frequency, std::vector<double>& damping) {
  constexpr double kSame = 1e-9;  // of lambda: if closer, rounding decides which mode is which
  const algebra::SymmetricModes modes = algebra::symmetric_modes(system.K, system.M);
  const Eigen::VectorXd& lambda = modes.values;
  const Eigen::ArrayXd k = system.internal_stiffness.array(), rate = system.internal_rate.array();
  frequency.clear();
  damping.clear();
  for (Eigen::Index i = 0; i < system.masses(); ++i) {
    const Eigen::VectorXd phi = modes.vectors.col(i);
    const double omega = std::sqrt(lambda[i]);
    const Eigen::VectorXd pull = by.K * phi - lambda[i] * (by.M * phi);
    const double omega_by = phi.dot(pull) / (2.0 * omega);
    Eigen::VectorXd phi_by = -0.5 * phi.dot(by.M * phi) * phi;
    bool simple = true;
    for (Eigen::Index j = 0; j < system.masses(); ++j) {
      if (j == i) continue;
      const double apart = lambda[i] - lambda[j];
      simple = simple && std::abs(apart) > kSame * lambda[i];
      phi_by += modes.vectors.col(j) * (modes.vectors.col(j).dot(pull) / apart);
    }
    const Eigen::ArrayXd below = omega * omega + rate * rate;
    const Eigen::ArrayXd dampers = k * rate / below;
    const Eigen::ArrayXd dampers_by =
        (by.internal_stiffness.array() * rate + k * by.internal_rate.array()) / below -
        dampers * (2.0 * omega * omega_by + 2.0 * rate * by.internal_rate.array()) / below;
    const Eigen::VectorXd strain = system.D.transpose() * phi, strain_by = system.D.transpose() * phi_by;
    const double loss_by = 2.0 * phi.dot(system.C * phi_by) + phi.dot(by.C * phi) +
                           2.0 * strain.dot((dampers * strain_by.array()).matrix()) +
                           strain.dot((dampers_by * strain.array()).matrix()) +
                           (system.joints.any() ? loss_of_joints_by(system, by, strain, phi, omega) : 0.0);
    const double ratio = damping_ratio(system, phi, omega);
    frequency.push_back(simple ? omega_by : kNone);
    damping.push_back(simple ? loss_by / (2.0 * omega) - ratio * omega_by / omega : kNone);
  }
}

LinearModes linear_modes(const mechanics::Network& network, const mechanics::NetworkValues& values,
                         bool all_stuck, mechanics::FreeMasses free) {
  const mechanics::Assembly assembly(network, free);
  mechanics::LinearSystem system;
  assembly.set_values(values, system);
  const Eigen::Index n = system.masses();
  // Motions while every contact sticks: displacements B eta with W^T B = 0 of the held contacts. The springs
  // after the other contacts act.
  Eigen::MatrixXd K = system.K, strained(0, n);
  if (system.free_directions.cols() > 0) strained = mechanics::strained_combinations(assembly, system);
  std::vector<Eigen::Index> held;
  for (Eigen::Index j = 0; all_stuck && j < system.contacts(); ++j) {
    const auto contact = static_cast<std::size_t>(j);
    if (system.law[contact]->holds_velocity) {
      held.push_back(j);
    } else {
      const Eigen::Index internal = system.contact_internal[contact];
      const Eigen::VectorXd d = system.D.col(internal);
      K += system.internal_stiffness[internal] * d * d.transpose();
      strained.conservativeResize(strained.rows() + 1, n);
      strained.bottomRows(1) = d.normalized().transpose();
    }
  }
  const Eigen::MatrixXd B = algebra::null_space(system.W(Eigen::all, held).transpose());
  if (B.cols() == 0) return {};
  const Eigen::MatrixXd K_B = B.transpose() * K * B, M_B = B.transpose() * system.M * B;
  Eigen::MatrixXd free_B(B.cols(), 0);
  if (system.free_directions.cols() > 0) {
    for (const Eigen::Index j : held) {
      strained.conservativeResize(strained.rows() + 1, n);
      strained.bottomRows(1) = system.W.col(j).normalized().transpose();
    }
    const Eigen::MatrixXd free_and_held = mechanics::free_of(strained, system.M);
    free_B = algebra::inverse(B.transpose() * B) * (B.transpose() * free_and_held);
  }
  const algebra::SymmetricModes modes = mechanics::modes_with_free(K_B, M_B, free_B);
  LinearModes result;
  for (Eigen::Index k = 0; k < B.cols(); ++k) {
    Eigen::VectorXd shape = B * modes.vectors.col(k);
    const double omega = std::sqrt(modes.values[k]);
    result.frequency.push_back(omega);
    result.damping.push_back(damping_ratio(system, shape, omega));
    Eigen::Index largest = 0;
    shape.cwiseAbs().maxCoeff(&largest);
    shape /= shape[largest];
    if (omega == 0.0) shape.array() += 0.0;  // no -0
    result.shape.emplace_back(shape.data(), shape.data() + n);
  }
  return result;
}

double lowest_frequency(const std::vector<double>& frequencies) {
  const auto lowest = std::ranges::find_if(frequencies, [](double omega) { return omega > 0.0; });
  return lowest == frequencies.end() ? kNone : *lowest;
}

double lowest_frequency(const mechanics::Network& network, const mechanics::NetworkValues& values,
                        mechanics::FreeMasses free) {
  return lowest_frequency(linear_modes(network, values, false, free).frequency);
}

}  // namespace frahm::periodic
