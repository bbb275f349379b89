#include "solvers/quantities/instant_motion.hpp"

#include "solvers/mechanics/rotation.hpp"
#include "solvers/mechanics/structural_damping.hpp"

namespace frahm::periodic {
namespace {

struct ValueAndDerivative {
  double value = 0.0, by = 0.0;
};

// w^T q + p^T y and its derivative.
ValueAndDerivative relative(const mechanics::Incidence& at, const Eigen::VectorXd& q,
                            const Eigen::VectorXd& q_by, const Eigen::VectorXd& y,
                            const Eigen::VectorXd& y_by) {
  return {at.w.dot(q) + at.p.dot(y), at.w.dot(q_by) + at.p.dot(y_by)};
}

// + j^T x
ValueAndDerivative with_joints(ValueAndDerivative sum, const mechanics::Incidence& at,
                               const Eigen::VectorXd& x, const Eigen::VectorXd& x_by) {
  if (!at.has_joint()) return sum;
  return {sum.value + at.j.dot(x), sum.by + at.j.dot(x_by)};
}

ValueAndDerivative displacement(const mechanics::Incidence& at, const InstantMotion& m) {
  return with_joints(relative(at, m.at.q, m.by.q, m.at.y, m.by.y), at, m.at.x, m.by.x);
}

ValueAndDerivative velocity(const mechanics::Incidence& at, const InstantMotion& m) {
  return with_joints(relative(at, m.at.v, m.by.v, m.at.y_velocity, m.by.y_velocity), at, m.at.x_velocity,
                     m.by.x_velocity);
}

ValueAndDerivative acceleration(const mechanics::Incidence& at, const InstantMotion& m) {
  return with_joints(relative(at, m.at.a, m.by.a, m.at.y_acceleration, m.by.y_acceleration), at,
                     m.at.x_acceleration, m.by.x_acceleration);
}

// The force of elements, each product by the product rule.
class Forces {
 public:
  Forces(const InstantMotion& motion, const mechanics::Assembly& assembly,
         const mechanics::LinearSystem& system, const mechanics::LinearSystem& system_by)
      : motion_(motion), assembly_(assembly), system_(system), by_(system_by) {}

  // F = k u + c v + b v' + s + its bends + its share of the friction
  double of_element(std::size_t e) const {
    const mechanics::Incidence& at = assembly_.incidences()[e];
    const mechanics::ElementCoefficients &law = system_.coefficients[e], &law_by = by_.coefficients[e];
    double force = product(law.stiffness, law_by.stiffness, displacement(at, motion_)) +
                   product(law.damping, law_by.damping, velocity(at, motion_)) +
                   product(law.inertance, law_by.inertance, acceleration(at, motion_));
    // The friction of an element with an internal force is the limit of that force.
    if (law.internal >= 0) return force + motion_.internal_by[law.internal];
    if (law.static_friction != 0.0 || law_by.static_friction != 0.0) force += friction(e);
    return force + bends(e);
  }

  double at_node(const mechanics::Node& node) const {
    double sum = 0.0;
    const mechanics::Network& network = assembly_.network();
    const bool takes_torque = mechanics::ground_takes_torque(network);
    for (std::size_t e = 0; e < network.elements.size(); ++e) {
      const double share = mechanics::share_in_force(network.elements[e], node, takes_torque);
      if (share != 0.0) sum += share * of_element(e);
    }
    if (system_.structural_damping.size() == 0) return sum;
    // d(S_node v) = dS_node v + S_node dv
    return sum + velocity(mechanics::structural_reaction(system_, node), motion_).by +
           velocity(mechanics::structural_reaction(by_, node), motion_).value;
  }

 private:
  static double product(double factor, double factor_by, const ValueAndDerivative& motion) {
    return factor_by * motion.value + factor * motion.by;
  }

  double bends(std::size_t e) const {
    const mechanics::Bends& all = assembly_.bends();
    double force = 0.0;
    for (std::size_t j = 0; j < motion_.bends_by.size(); ++j) {
      if (all.element[j] == e) force += all.side[j] * motion_.bends_by[j];
    }
    return force;
  }

  // sigma F of a sliding contact; of a stuck one the share F_s / sum F_s of its force lambda.
  double friction(std::size_t e) const {
    const mechanics::ContactShare& place = assembly_.shares()[e];
    const ContactForce& contact = motion_.contacts[place.contact];
    if (!contact.sticks) return place.orientation * contact.direction * by_.coefficients[e].friction;
    const auto j = static_cast<Eigen::Index>(place.contact);
    const double limit = system_.static_limit[j];
    const double share = system_.coefficients[e].static_friction / limit;
    const double share_by = (by_.coefficients[e].static_friction - share * by_.static_limit[j]) / limit;
    return place.orientation * (share * contact.force_by + share_by * contact.force);
  }

  const InstantMotion& motion_;
  const mechanics::Assembly& assembly_;
  const mechanics::LinearSystem &system_, &by_;
};

}  // namespace

double velocity_derivative(const mechanics::Incidence& at, const InstantMotion& motion) {
  return velocity(at, motion).by;
}

double acceleration_of(const mechanics::Incidence& at, const InstantMotion& motion) {
  return acceleration(at, motion).value;
}

double trace_derivative(const Trace& trace, const InstantMotion& motion, const mechanics::Assembly& assembly,
                        const mechanics::LinearSystem& system, const mechanics::LinearSystem& system_by) {
  const Forces forces(motion, assembly, system, system_by);
  switch (trace.kind) {
    case TraceKind::velocity:
      return velocity(trace.at, motion).by;
    case TraceKind::acceleration:
      return acceleration(trace.at, motion).by;
    case TraceKind::element_force: {
      double force = 0.0;
      for (std::size_t e = trace.element; e < trace.element + trace.parts; ++e) force += forces.of_element(e);
      return force;
    }
    case TraceKind::support_force:
      return forces.at_node(trace.node);
    case TraceKind::displacement:
      break;
  }
  return displacement(trace.at, motion).by;
}

}  // namespace frahm::periodic
