#include "solvers/nonstop/sliding_forms.hpp"

#include "solvers/algebra/solve.hpp"
#include "solvers/mechanics/element_forces.hpp"
#include "solvers/mechanics/element_table.hpp"

namespace frahm::periodic::nonstop {

Form& Form::add(double factor, const Form& other) {
  state += factor * other.state;
  motion += factor * other.motion;
  velocity += factor * other.velocity;
  acceleration += factor * other.acceleration;
  force += factor * other.force;
  applied += factor * other.applied;
  contact += factor * other.contact;
  element += factor * other.element;
  return *this;
}

SlidingForms::SlidingForms(const mechanics::Assembly& assembly, const mechanics::LinearSystem& system)
    : assembly_(assembly), system_(system), M_inverse_(algebra::inverse(system.M)) {}

Form SlidingForms::zero() const {
  const Eigen::Index n = system_.masses(), p = system_.constant_motion.size();
  const auto elements = static_cast<Eigen::Index>(system_.coefficients.size());
  return {Eigen::VectorXd::Zero(2 * n + system_.internal_forces()),
          Eigen::VectorXd::Zero(p),
          Eigen::VectorXd::Zero(p),
          Eigen::VectorXd::Zero(p),
          Eigen::VectorXd::Zero(n),
          Eigen::VectorXd::Zero(n),
          Eigen::VectorXd::Zero(system_.contacts()),
          Eigen::VectorXd::Zero(elements)};
}

Form SlidingForms::state(Eigen::Index i) const {
  Form form = zero();
  form.state[i] = 1.0;
  return form;
}

Form SlidingForms::support_velocity(Eigen::Index node) const {
  Form form = zero();
  form.velocity[node] = 1.0;
  return form;
}

Form SlidingForms::applied_force(Eigen::Index mass) const {
  Form form = zero();
  form.applied[mass] = 1.0;
  return form;
}

Form SlidingForms::displacement(const mechanics::Incidence& at) const {
  Form form = zero();
  form.state.head(at.w.size()) = at.w;
  form.motion = at.p;
  return form;
}

Form SlidingForms::velocity(const mechanics::Incidence& at) const {
  Form form = zero();
  form.state.segment(at.w.size(), at.w.size()) = at.w;
  form.velocity = at.p;
  return form;
}

// w^T q'' + p^T y'',  q'' = M^-1 (f - K q - C q' - D s - W lambda)
Form SlidingForms::acceleration(const mechanics::Incidence& at) const {
  const Eigen::Index n = system_.masses();
  Form form = zero();
  form.force = M_inverse_ * at.w;
  form.state.head(n) = -system_.K * form.force;
  form.state.segment(n, n) = -system_.C.transpose() * form.force;
  form.state.tail(system_.internal_forces()) = -system_.D.transpose() * form.force;
  form.contact = -system_.W.transpose() * form.force;
  form.acceleration = at.p;
  return form;
}

Form SlidingForms::element_force(std::size_t element, const mechanics::ElementCoefficients& law) const {
  const mechanics::Incidence& at = assembly_.incidences()[element];
  Form form = mechanics::smooth_force(*this, at, law);
  if (law.internal >= 0) form.state[2 * system_.masses() + law.internal] += 1.0;
  if (mechanics::has_contact(assembly_.network().elements[element]))
    form.element[static_cast<Eigen::Index>(element)] = 1.0;
  return form;
}

Form SlidingForms::node_force(const mechanics::Node& node, const mechanics::LinearSystem& system) const {
  return mechanics::force_on_node(*this, assembly_.network(), node, system);
}

}  // namespace frahm::periodic::nonstop
