#pragma once

#include "solvers/mechanics/linear_system.hpp"

// Damping of the structure as a whole, as buildings and finite-element models have it: by its natural modes
// or in proportion to its matrices, and that of matrices from elsewhere.
//
// M and K are those of masses, inerters, springs and matrices: contacts slide, dampers and Maxwell springs
// are not among them. With K Phi = M Phi Lambda, Phi^T M Phi = 1, Lambda = diag(omega_i^2):
//
//   modal      C_d = M Phi diag(2 zeta_i omega_i) Phi^T M
//   rayleigh   C_d = a M + b K
//   (R. W. Clough and J. Penzien, Dynamics of Structures, 1993, section 12-3)
//
// It acts on the motion relative to the quasi-static one under the motion y of the ends of the springs,
//   K q_s + K_ends y = 0,   r = q - q_s = q + B y,   B = K^-1 K_ends,
// so that a structure that moves with its base is not damped. The ends are the ground (y = 0) and the
// prescribed nodes. By the principle of virtual work C_d r' acts on the masses and B^T C_d r' on the ends:
//
//   S = [1 B]^T C_d [1 B],   C += C_d,   C_support += C_d K^-1 K_support.
//
// What the structure dissipates is r'^T C_d r' = v^T S v. The damping of matrices adds to the block of the
// masses.
namespace frahm::mechanics {

// Whether a network has damping of the structure: [damping], or matrices that damp.
bool has_structural_damping(const Network& network);

// Throws MechanicsError for ratios or coefficients that are negative, not finite or not as many as there can
// be. values: of NetworkValues::damping.
void check_structural_damping(const Network& network, const std::vector<double>& values);

// Sets S and adds it to C and C_support; `system` must hold M, K, K_support and the coefficients of elements.
// Throws MechanicsError where modes of one frequency have different ratios: C_d is not determined then.
void set_structural_damping(const Assembly& assembly, const std::vector<double>& values,
                            LinearSystem& system);

// The same for the derivative of `system` along `direction`.
void differentiate_structural_damping(const Assembly& assembly, const NetworkValues& values,
                                      const NetworkValues& direction, const LinearSystem& system,
                                      LinearSystem& derivative);

// What a row of S, or of another linear form of the velocities v, is of masses and prescribed nodes.
Incidence structural_incidence(const LinearSystem& system, const Eigen::RowVectorXd& row);

// The force [N] with which the structure's damping drives `node`, as an incidence of velocities [N s/m].
Incidence structural_reaction(const LinearSystem& system, const Node& node);

// Rows R with S = R^T R: the structure dissipates the sum of the squares of R v. None where it does not damp.
Eigen::MatrixXd structural_rates(const LinearSystem& system);

}  // namespace frahm::mechanics
