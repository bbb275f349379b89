#pragma once

#include <Eigen/Core>
#include <vector>

#include "solvers/algebra/null_space.hpp"
#include "solvers/flow/flow.hpp"

// Contacts in a loop through supports that move apart. Where velocities and accelerations of the supports are
// both zero, as when an earthquake begins, all of the loop may be at rest, but for that instant alone: the
// choice of those that slide is that of the instant after it.
namespace frahm::periodic {

// Whether these contacts cannot all stick, as no motion of the masses follows the supports: some sum
// of their directions vanishes, W_S x = 0, and that of the supports' velocities p^T y' x does not.
template <int N, int H>
bool are_parted(const StepEquations<N, H>& eq, ContactMask stuck) {
  constexpr double kRounding = 1e-12;
  const std::vector<Eigen::Index> contacts = list_of(stuck & eq.holding);
  if (contacts.size() < 2) return false;
  const Eigen::MatrixXd velocities = eq.support_velocity(contacts, Eigen::all);
  const Eigen::MatrixXd loops = algebra::null_space(Eigen::MatrixXd(eq.W(Eigen::all, contacts)));
  return (loops.transpose() * velocities).norm() > kRounding * velocities.norm();
}

// What the relative accelerations of the contacts are about to change by, p^T y''', counted so that the
// largest is a millionth of what friction can do: then it decides between what is equal now, and nothing
// else.
template <int N, int H>
Eigen::VectorXd parting(const StepEquations<N, H>& eq, const Instant<N, H>& at) {
  constexpr double kSoon = 1e-6;
  Eigen::VectorXd jerk = eq.support_acceleration * at.du;
  const double largest = jerk.cwiseAbs().maxCoeff();
  const double friction = eq.limit.cwiseProduct(eq.compliance).maxCoeff();
  if (largest > 0.0) jerk *= kSoon * friction / largest;
  return jerk;
}

}  // namespace frahm::periodic
