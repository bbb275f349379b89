#include "solvers/mechanics/structural_damping.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "solvers/algebra/solve.hpp"
#include "solvers/algebra/symmetric_modes.hpp"
#include "solvers/mechanics/free_directions.hpp"
#include "solvers/mechanics/joints.hpp"
#include "solvers/mechanics/rotation.hpp"

namespace frahm::mechanics {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// The last ratio is that of all higher modes.
double ratio_of(const std::vector<double>& ratios, Index mode) {
  return ratios[std::min(static_cast<std::size_t>(mode), ratios.size() - 1)];
}

// K_ends: how the masses hang on the ground and on the prescribed nodes, n x (1 + p).
// system: whose joints follow the masses; of: of the springs, or their derivative.
MatrixXd stiffness_to_ends(const Assembly& assembly, const LinearSystem& system, const LinearSystem& of) {
  MatrixXd K(of.K.rows(), 1 + of.K_support.cols());
  K << Eigen::VectorXd::Zero(K.rows()), of.K_support;
  const auto& elements = assembly.network().elements;
  const bool takes_torque = ground_takes_torque(assembly.network());
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const double at_ground = share_in_force(elements[e], Node{}, takes_torque);
    if (at_ground != 0.0)
      K.col(0) += of.coefficients[e].stiffness * at_ground * at_rest(system, assembly.incidences()[e]);
  }
  return K;
}

// d(k (w + B^T j)) = dk (w + B^T j) + k dB^T j
MatrixXd stiffness_to_ends_derivative(const Assembly& assembly, const LinearSystem& system,
                                      const LinearSystem& by) {
  MatrixXd K = stiffness_to_ends(assembly, system, by);
  const auto& elements = assembly.network().elements;
  const bool takes_torque = ground_takes_torque(assembly.network());
  for (std::size_t e = 0; e < elements.size() && system.joints.any(); ++e) {
    const double at_ground = share_in_force(elements[e], Node{}, takes_torque);
    K.col(0) +=
        system.coefficients[e].stiffness * at_ground * (by.joints.B.transpose() * assembly.incidences()[e].j);
  }
  return K;
}

// [1 B], n x (n + 1 + p): the motion relative to the quasi-static one.
MatrixXd relative_motion(const MatrixXd& B) {
  MatrixXd T(B.rows(), B.rows() + B.cols());
  T << MatrixXd::Identity(B.rows(), B.rows()), B;
  return T;
}

void check_determined(const std::vector<double>& ratios, const Eigen::VectorXd& omega) {
  constexpr double kSame = 1e-9;  // of a frequency: if closer, rounding decides which mode is which
  for (Index i = 0; i + 1 < omega.size(); ++i) {
    const double own = ratio_of(ratios, i), next = ratio_of(ratios, i + 1);
    if (own == next || omega[i + 1] - omega[i] > kSame * omega[i + 1]) continue;
    std::ostringstream message;
    message << "modes " << i + 1 << " and " << i + 2 << " have the same frequency, " << omega[i]
            << " rad/s, but the damping ratios " << own << " and " << next
            << ": it is not determined which motion has which ratio";
    throw MechanicsError(message.str());
  }
}

// C_d = (M Phi) diag(2 zeta_i omega_i) (M Phi)^T of the modes that oscillate.
MatrixXd modal_damping(const LinearSystem& system, const std::vector<double>& ratios) {
  const algebra::SymmetricModes modes = undamped_modes_of(system);
  const Index elastic = system.masses() - system.free_directions.cols();
  const Eigen::VectorXd omega = modes.values.tail(elastic).cwiseSqrt();
  check_determined(ratios, omega);
  Eigen::VectorXd damping(omega.size());
  for (Index i = 0; i < omega.size(); ++i) damping[i] = 2.0 * ratio_of(ratios, i) * omega[i];
  const MatrixXd M_phi = system.M * modes.vectors.rightCols(elastic);
  return M_phi * damping.asDiagonal() * M_phi.transpose();
}

// Phi^T C_d Phi = diag(2 zeta_i omega_i) differentiated, with dPhi = Phi A and, from K Phi = M Phi Lambda,
// Phi^T M Phi = 1, dK^ = Phi^T dK Phi, dM^ = Phi^T dM Phi:  A_ii = -dM^_ii / 2,
// A_ij = (dK^_ij - omega_j^2 dM^_ij) / (omega_j^2 - omega_i^2). So Phi^T dC_d Phi has the entries
//   (s + delta) dK^_ij + omega_i omega_j (s - delta) dM^_ij + 2 dzeta_i omega_i [i = j],
//   s = (zeta_i + zeta_j) / (omega_i + omega_j),   delta = (zeta_i - zeta_j) / (omega_i - omega_j),
// with delta = 0 where the ratios are equal: there modes of one frequency do no harm.
MatrixXd modal_damping_derivative(const LinearSystem& system, const LinearSystem& by,
                                  const std::vector<double>& ratios, const std::vector<double>& ratios_by) {
  const algebra::SymmetricModes modes = algebra::symmetric_modes(system.K, system.M);
  const Eigen::VectorXd omega = modes.values.cwiseSqrt();
  const MatrixXd dK = modes.vectors.transpose() * by.K * modes.vectors;
  const MatrixXd dM = modes.vectors.transpose() * by.M * modes.vectors;
  MatrixXd change(omega.size(), omega.size());
  for (Index i = 0; i < omega.size(); ++i) {
    for (Index j = 0; j < omega.size(); ++j) {
      const double zeta_i = ratio_of(ratios, i), zeta_j = ratio_of(ratios, j);
      const double s = (zeta_i + zeta_j) / (omega[i] + omega[j]);
      const double delta = zeta_i == zeta_j ? 0.0 : (zeta_i - zeta_j) / (omega[i] - omega[j]);
      change(i, j) = (s + delta) * dK(i, j) + omega[i] * omega[j] * (s - delta) * dM(i, j);
    }
    if (!ratios_by.empty()) change(i, i) += 2.0 * ratio_of(ratios_by, i) * omega[i];
  }
  const MatrixXd M_phi = system.M * modes.vectors;
  return M_phi * change * M_phi.transpose();
}

// C_d, n x n.
MatrixXd damping_of(const Network& network, const std::vector<double>& values, const LinearSystem& system) {
  if (network.damping == DampingModel::modal) return modal_damping(system, values);
  return values[0] * system.M + values[1] * system.K;
}

MatrixXd damping_derivative(const Network& network, const std::vector<double>& values,
                            const std::vector<double>& by, const LinearSystem& system,
                            const LinearSystem& derivative) {
  if (network.damping == DampingModel::modal) return modal_damping_derivative(system, derivative, values, by);
  MatrixXd change = values[0] * derivative.M + values[1] * derivative.K;
  if (!by.empty()) change += by[0] * system.M + by[1] * system.K;
  return change;
}

// C and C_support += their blocks of S.
void add_to_system(LinearSystem& system) {
  const Index n = system.C.rows(), p = system.C_support.cols();
  system.C += system.structural_damping.topLeftCorner(n, n);
  system.C_support += system.structural_damping.topRightCorner(n, p);
}

}  // namespace

bool has_structural_damping(const Network& network) {
  return network.damping != DampingModel::none ||
         std::ranges::any_of(network.matrices,
                             [](const MatrixPart& part) { return part.damping.size() > 0; });
}

void check_structural_damping(const Network& network, const std::vector<double>& values) {
  if (network.damping == DampingModel::none) return;
  const bool is_modal = network.damping == DampingModel::modal;
  const std::size_t most = is_modal ? network.masses.size() : 2, least = is_modal ? 1 : 2;
  if (values.size() < least || values.size() > most) {
    throw MechanicsError(is_modal ? "modal damping takes one ratio, or up to one for each mass"
                                  : "rayleigh damping takes 2 coefficients");
  }
  for (const double value : values) {
    if (value >= 0.0 && std::isfinite(value)) continue;
    std::ostringstream message;
    message << (is_modal ? "a modal damping ratio = " : "a rayleigh coefficient = ") << value
            << ": must be finite and not negative";
    throw MechanicsError(message.str());
  }
}

// S = [1 B]^T C_d [1 B] + the matrices' damping
void set_structural_damping(const Assembly& assembly, const std::vector<double>& values,
                            LinearSystem& system) {
  const Network& network = assembly.network();
  if (!has_structural_damping(network)) {
    system.structural_damping.resize(0, 0);
    return;
  }
  const Index n = system.K.rows(), size = n + 1 + system.K_support.cols();
  system.structural_damping.setZero(size, size);
  if (network.damping != DampingModel::none) {
    const MatrixXd& R = system.free_directions;
    const MatrixXd K = R.cols() > 0 ? held_stiffness(system) : system.K;
    MatrixXd B = algebra::solve_positive(K, stiffness_to_ends(assembly, system, system));
    if (R.cols() > 0) B -= R * (R.transpose() * system.M * B);  // supports do not push along R
    const MatrixXd T = relative_motion(B);
    system.structural_damping = T.transpose() * damping_of(network, values, system) * T;
  }
  if (const MatrixXd& C = assembly.matrices().damping; C.size() > 0)
    system.structural_damping.topLeftCorner(n, n) += C;
  add_to_system(system);
}

// dS = T^T dC_d T + dT^T C_d T + T^T C_d dT with T = [1 B], dT = [0 dB], K dB = dK_ends - dK B
void differentiate_structural_damping(const Assembly& assembly, const NetworkValues& values,
                                      const NetworkValues& direction, const LinearSystem& system,
                                      LinearSystem& derivative) {
  const Network& network = assembly.network();
  derivative.structural_damping.setZero(system.structural_damping.rows(), system.structural_damping.cols());
  if (network.damping == DampingModel::none) return;
  const MatrixXd B = algebra::solve_positive(system.K, stiffness_to_ends(assembly, system, system));
  const MatrixXd B_by = algebra::solve_positive(
      system.K, MatrixXd(stiffness_to_ends_derivative(assembly, system, derivative) - derivative.K * B));
  const MatrixXd T = relative_motion(B);
  MatrixXd T_by = MatrixXd::Zero(T.rows(), T.cols());
  T_by.rightCols(B.cols()) = B_by;
  const MatrixXd cross = T_by.transpose() * damping_of(network, values.damping, system) * T;
  const MatrixXd change = damping_derivative(network, values.damping, direction.damping, system, derivative);
  derivative.structural_damping = T.transpose() * change * T + cross + cross.transpose();
  add_to_system(derivative);
}

Incidence structural_incidence(const LinearSystem& system, const Eigen::RowVectorXd& row) {
  return {row.head(system.C.rows()).transpose(), row.tail(system.C_support.cols()).transpose()};
}

Incidence structural_reaction(const LinearSystem& system, const Node& node) {
  const Index first = system.C.rows();
  const Index row = node.kind == NodeKind::ground ? first : first + 1 + static_cast<Index>(node.index);
  return structural_incidence(system, system.structural_damping.row(row));
}

// S = Q diag(s) Q^T:  R = diag(sqrt(s)) Q^T of the positive s; the others are rounding of zero.
MatrixXd structural_rates(const LinearSystem& system) {
  const MatrixXd& S = system.structural_damping;
  if (S.size() == 0) return {};
  const algebra::SymmetricModes modes = algebra::symmetric_modes(S);
  const double rounding = 1e-15 * modes.values.cwiseAbs().maxCoeff();
  const Index positive = (modes.values.array() > rounding).count();  // ascending: these are the last
  return modes.values.tail(positive).cwiseSqrt().asDiagonal() * modes.vectors.rightCols(positive).transpose();
}

}  // namespace frahm::mechanics
