#include "solvers/smooth/forms.hpp"

#include <algorithm>

#include "solvers/mechanics/element_forces.hpp"
namespace frahm::smooth {

Form Forms::zero() const {
  return {Eigen::VectorXd::Zero(equation_.size()), Eigen::VectorXd::Zero(equation_.oscillators()),
          Eigen::VectorXd::Zero(equation_.terms())};
}

Form Forms::displacement(const mechanics::Incidence& at) const {
  Form form = zero();
  form.z.head(at.w.size()) = at.w;
  form.u = equation_.motion().transpose() * at.p;
  return form;
}

Form Forms::velocity(const mechanics::Incidence& at) const {
  Form form = zero();
  form.z.segment(at.w.size(), at.w.size()) = at.w;
  form.u = equation_.motion_velocity().transpose() * at.p;
  return form;
}

// w^T q'' from the equation's rows of the velocities.
Form Forms::acceleration(const mechanics::Incidence& at) const {
  const Eigen::Index n = equation_.masses();
  Form form = zero();
  form.z = equation_.A().middleRows(n, n).transpose() * at.w;
  form.u = equation_.B().middleRows(n, n).transpose() * at.w;
  form.u += equation_.motion_acceleration().transpose() * at.p;
  form.f = equation_.G().middleRows(n, n).transpose() * at.w;
  return form;
}

Form Forms::element_force(std::size_t element, const mechanics::ElementCoefficients& law) const {
  const mechanics::Incidence& at = assembly_.incidences()[element];
  Form form = mechanics::smooth_force(*this, at, law);
  if (law.internal >= 0) form.z[2 * equation_.masses() + law.internal] += 1.0;
  const auto& bent = equation_.elements();
  const auto term = std::find(bent.begin(), bent.end(), element);
  if (term != bent.end()) form.f[term - bent.begin()] += 1.0;
  return form;
}

Form Forms::node_force(const mechanics::Node& node, const mechanics::LinearSystem& system) const {
  return mechanics::force_on_node(*this, assembly_.network(), node, system);
}

Form Forms::applied_force(std::size_t mass) const {
  Form form = zero();
  form.u = equation_.applied_force().row(static_cast<Eigen::Index>(mass)).transpose();
  return form;
}

}  // namespace frahm::smooth
