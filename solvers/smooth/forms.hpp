#pragma once

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/smooth/equation.hpp"

namespace frahm::smooth {

// A quantity that is linear in state, forcing and the forces of smooth laws: g = z . state + u . u(t) + f .
// phi(t). Displacements, velocities, accelerations, element forces and sums of them are all of this kind.
struct Form {
  Eigen::VectorXd z, u, f;

  double value(const Instant& at) const { return z.dot(at.z) + u.dot(at.u) + f.dot(at.bent); }
  double slope(const Instant& at) const { return z.dot(at.dz) + u.dot(at.du) + f.dot(at.rate); }

  Form& add(double factor, const Form& other) {
    z += factor * other.z;
    u += factor * other.u;
    f += factor * other.f;
    return *this;
  }
};

// The forms of a network, in SI units; they hold until the equation is set again.
class Forms {
 public:
  // Both must outlive the forms.
  Forms(const mechanics::Assembly& assembly, const Equation& equation)
      : assembly_(assembly), equation_(equation) {}

  Form zero() const;
  // u = w^T q + p^T y [m], u' [m/s], u'' [m/s^2] of an incidence.
  Form displacement(const mechanics::Incidence& at) const;
  Form velocity(const mechanics::Incidence& at) const;
  Form acceleration(const mechanics::Incidence& at) const;
  // Force [N] of an element.
  Form element_force(std::size_t element, const mechanics::ElementCoefficients& law) const;
  // The force [N] that drives `node` (ground or prescribed): the sum that all elements need there.
  Form node_force(const mechanics::Node& node, const mechanics::LinearSystem& system) const;
  // Outside force [N] on a mass.
  Form applied_force(std::size_t mass) const;

 private:
  const mechanics::Assembly& assembly_;
  const Equation& equation_;
};

}  // namespace frahm::smooth
