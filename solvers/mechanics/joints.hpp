#pragma once

#include <string>
#include <vector>

#include "solvers/mechanics/linear_system.hpp"

// Joints: nodes without mass or inerter, where springs and dampers meet. With M of the masses alone, the
// equations of masses q and joints x under forces f and P and supports y are
//
//   M q'' + C_q q' + C_qx x' + K_q q + K_qx x = f(t),   C_xq q' + C_x x' + C_xy y' + K_xq q + K_x x + K_xy y
//   = P(t)
//
// (M'' and the supports' forces on the masses left out), with K_x positive definite. C_x is zero along
// `undamped` directions U and positive definite along others. With N the others, K_x-orthogonal to U and such
// that N^T C_x N = 1, N^T K_x N = diag(k):
//
//   x = B q + B_support y + A P - N s/k,   A = K_x^-1,  B = -A K_xq,  B_support = -A K_xy,
//   s' = k (D^T q' + p^T y' + N^T C_x A P') - k s,   D = (C_qx + B^T C_x) N,  p = (C_yx + B_support^T C_x) N,
//   M q'' + (C_q - C_qx N N^T C_xq) q' + (K_q - K_qx A K_xq) q + D s = f + B^T P,
//
// so that each damped direction is a Maxwell element: s is the force of its dampers, and s^2/2k the energy
// that the springs store in it beyond what q, y and P ask for. Elements of one damped direction alone, where
// K and C are numbers, are the textbook's three-parameter solid [12].
namespace frahm::mechanics {

// What a joint takes instead of an element that it cannot have; "" where it can.
std::string instead_at_joint(const Element& element);

// Throws MechanicsError for an element that a joint cannot have: a contact, a bend, an inerter, a smooth law
// or a Maxwell element. The message says what to write instead.
void check_elements_of_joints(const Network& network, const std::vector<Incidence>& incidences);

// Which combinations of joints dampers strain, whatever their values are.
JointDirections directions_of_joints(const Network& network, const std::vector<Incidence>& incidences);

// Takes the joints out: adds to K, C and those of supports what elements of joints have of them, by the
// coefficients of the elements, and sets `joints` and the internal forces of their damped directions.
// Throws MechanicsError where no spring holds a joint, or where dampers of a damped direction are all zero.
void condense_joints(const Assembly& assembly, LinearSystem& system);

// The same for the derivative of `system`, in its basis of damped directions: of K, C, D and their blocks of
// supports, and of `joints`. Of internal stiffness k the derivative is a matrix.
void differentiate_joints(const Assembly& assembly, const LinearSystem& system, LinearSystem& derivative);

// Moves the rows of forces after those of the n masses to the joints' own.
void part_loads_of_joints(Eigen::Index masses, LinearSystem& system);

// f += B^T P, once the forces that act from outside are noted.
void load_masses_by_joints(LinearSystem& system);
// The derivative: B^T dP + dB^T P.
void differentiate_loads_of_joints(const LinearSystem& system, LinearSystem& derivative);

// w + B^T j: the factors of the masses in a direction where its joints follow them at rest.
Eigen::VectorXd at_rest(const LinearSystem& system, const Incidence& at);

}  // namespace frahm::mechanics
