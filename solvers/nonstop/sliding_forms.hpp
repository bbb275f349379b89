#pragma once

#include <Eigen/Core>

#include "solvers/mechanics/linear_system.hpp"

namespace frahm::periodic::nonstop {

// A quantity that is linear in the state, the motion of the supports, the forces on the masses and friction,
// while all contacts slide: displacements, velocities, accelerations, element forces and sums of them.
struct Form {
  Eigen::VectorXd state;                           // of y = (q, q', s)
  Eigen::VectorXd motion, velocity, acceleration;  // of the prescribed nodes
  Eigen::VectorXd force;                           // of f(t) on the masses, what supports exert included
  Eigen::VectorXd applied;                         // of the part of it that acts from outside
  Eigen::VectorXd contact;                         // of F_j sigma_j of each contact
  Eigen::VectorXd element;                         // of each element's own friction force

  Form& add(double factor, const Form& other);
};

// The forms of a system, in SI units; they hold while its matrices do.
class SlidingForms {
 public:
  // Both must outlive the forms.
  SlidingForms(const mechanics::Assembly& assembly, const mechanics::LinearSystem& system);

  Form zero() const;
  // u = w^T q + p^T y [m], u' [m/s], u'' [m/s^2] of an incidence.
  Form displacement(const mechanics::Incidence& at) const;
  Form velocity(const mechanics::Incidence& at) const;
  Form acceleration(const mechanics::Incidence& at) const;
  // Force [N] of an element.
  Form element_force(std::size_t element, const mechanics::ElementCoefficients& law) const;
  // The force [N] that drives `node` (ground or prescribed): the sum that all elements need there.
  Form node_force(const mechanics::Node& node, const mechanics::LinearSystem& system) const;
  Form state(Eigen::Index i) const;  // y_i itself
  // Velocity of a prescribed node, and outside force on a mass.
  Form support_velocity(Eigen::Index node) const;
  Form applied_force(Eigen::Index mass) const;

 private:
  const mechanics::Assembly& assembly_;
  const mechanics::LinearSystem& system_;
  Eigen::MatrixXd M_inverse_;
};

}  // namespace frahm::periodic::nonstop
