#pragma once

#include "solvers/flow/flow.hpp"
#include "solvers/flow/joint_rows.hpp"
#include "solvers/mechanics/element_forces.hpp"

namespace frahm::periodic {

// A quantity that is linear in the state and the forcing while the mode lasts: g(t) = z . (q, v, s) + u .
// u(t). Displacements, velocities, accelerations, element forces and sums of them are all of this kind.
template <int N, int H>
struct LinearForm {
  using S = Sizes<N, H>;
  typename S::State z;
  typename S::Oscillators u;

  ValueAndSlope at(const Instant<N, H>& instant) const {
    const Eigen::Index n = instant.a.size();
    double slope =
        z.head(n).dot(instant.z.segment(n, n)) + z.segment(n, n).dot(instant.a) + u.dot(instant.du);
    if constexpr (S::kInternal != 0) slope += z.tail(z.size() - 2 * n).dot(instant.ds);
    return {z.dot(instant.z) + u.dot(instant.u), slope};
  }

  Polynomial polynomial(const Expansion<N, H>& x) const { return x.z * z + x.u * u; }

  // y: state and oscillators, one after the other.
  template <class Joined>
  double value(const Joined& y) const {
    return z.dot(y.head(z.size())) + u.dot(y.segment(z.size(), u.size()));
  }

  LinearForm& add(double factor, const LinearForm& other) {
    z += factor * other.z;
    u += factor * other.u;
    return *this;
  }
};

// The forms of an orbit's network, in SI units.
template <int N, int H>
class Forms {
 public:
  using S = Sizes<N, H>;
  using Form = LinearForm<N, H>;

  // Both must outlive the forms.
  Forms(const mechanics::Assembly& assembly, const Flow<N, H>& flow) : assembly_(assembly), flow_(flow) {}

  // u = w^T q + p^T y [m], u' [m/s], u'' [m/s^2] of an incidence.
  Form displacement(const mechanics::Incidence& at) const;
  Form velocity(const mechanics::Incidence& at) const;
  Form acceleration(const mechanics::Incidence& at, const Mode<N, H>& mode) const;

  // x' of a joint by itself.
  Form velocity_of_joint(Eigen::Index joint) const {
    const Eigen::Index j = flow_.equations().joints.B.rows();
    return velocity({Eigen::VectorXd::Zero(flow_.equations().masses()),
                     Eigen::VectorXd::Zero(flow_.equations().motion.rows()),
                     Eigen::VectorXd::Unit(j, joint)});
  }

  // Force [N] of an element.
  Form element_force(std::size_t element, const mechanics::ElementCoefficients& law,
                     const Mode<N, H>& mode) const;

  // lambda_j [N] of a contact that sticks in this mode.
  Form stuck_contact_force(Eigen::Index contact, const Mode<N, H>& mode) const;

  // The force [N] that drives `node` (ground or prescribed): the sum that all elements need there.
  Form node_force(const mechanics::Node& node, const mechanics::LinearSystem& system,
                  const Mode<N, H>& mode) const;

  // u' [m/s] along a bend, and its force there [N], beyond its place.
  Form bend_velocity(Eigen::Index bend) const;
  Form bend_force(Eigen::Index bend) const;

  Form zero() const {
    return {S::State::Zero(flow_.equations().states()),
            S::Oscillators::Zero(flow_.equations().oscillators())};
  }

 private:
  void add_bends(std::size_t element, const Mode<N, H>& mode, Form& form) const;
  Form acceleration_of_joints(const mechanics::Incidence& at, const Mode<N, H>& mode) const;

  const mechanics::Assembly& assembly_;
  const Flow<N, H>& flow_;
};

template <int N, int H>
LinearForm<N, H> Forms<N, H>::displacement(const mechanics::Incidence& at) const {
  Form form = zero();
  form.z.head(at.w.size()) = at.w;
  if (at.p.size() > 0) form.u = flow_.equations().motion.transpose() * at.p;
  if (at.has_joint()) add_joints(flow_.equations(), at.j, form.z, form.u);
  return form;
}

template <int N, int H>
LinearForm<N, H> Forms<N, H>::velocity(const mechanics::Incidence& at) const {
  const StepEquations<N, H>& eq = flow_.equations();
  Form form = zero();
  form.z.segment(at.w.size(), at.w.size()) = at.w / eq.step;
  if (at.p.size() > 0) form.u = eq.motion_velocity.transpose() * at.p / eq.step;
  if (at.has_joint()) add_velocity_of_joints(eq, at.j / eq.step, form.z, form.u);
  return form;
}

template <int N, int H>
LinearForm<N, H> Forms<N, H>::acceleration(const mechanics::Incidence& at, const Mode<N, H>& mode) const {
  if (at.has_joint()) return acceleration_of_joints(at, mode);
  const StepEquations<N, H>& eq = flow_.equations();
  const Configuration<N, H>& c = flow_.configuration(mode);
  const double per_second_squared = 1.0 / (eq.step * eq.step);
  const typename S::Vector w = at.w * per_second_squared;
  Form form = zero();
  form.z = c.pull_form(eq, w);
  form.u = c.Au.transpose() * w;
  form.u[0] += w.dot(mode.acceleration);
  if (at.p.size() > 0) form.u += eq.motion_acceleration.transpose() * at.p * per_second_squared;
  return form;
}

// w^T a + x'' with  x'' = B a + X s'' + offset'' u,  s'' = k D^T a - rate s' + drive' u: the acceleration of
// masses in the direction of a, and what follows from the velocities.
template <int N, int H>
LinearForm<N, H> Forms<N, H>::acceleration_of_joints(const mechanics::Incidence& at,
                                                     const Mode<N, H>& mode) const {
  const StepEquations<N, H>& eq = flow_.equations();
  const Eigen::Index n = at.w.size();
  const Eigen::VectorXd j = at.j / (eq.step * eq.step), s = eq.joints.X.transpose() * j;
  mechanics::Incidence of_masses{at.w, at.p};
  of_masses.w += eq.joints.B.transpose() * at.j +
                 eq.D * eq.internal_stiffness.cwiseProduct(eq.joints.X.transpose() * at.j);
  Form form = acceleration(of_masses, mode);
  const Eigen::VectorXd slowed = eq.internal_rate.cwiseProduct(s);
  form.z.segment(n, n) -= eq.D * eq.internal_stiffness.cwiseProduct(slowed);
  form.z.tail(s.size()) += eq.internal_rate.cwiseProduct(slowed);
  form.u += eq.joints.offset_acceleration.transpose() * j + eq.joints.drive_rate.transpose() * s -
            eq.internal_drive.transpose() * slowed;
  return form;
}

template <int N, int H>
LinearForm<N, H> Forms<N, H>::element_force(std::size_t element, const mechanics::ElementCoefficients& law,
                                            const Mode<N, H>& mode) const {
  const mechanics::Incidence& at = assembly_.incidences()[element];
  Form form = mechanics::smooth_force(*this, at, law, mode);
  if (law.internal >= 0) form.z[2 * at.w.size() + law.internal] += 1.0;
  add_bends(element, mode, form);
  if (law.static_friction == 0.0) return form;
  const mechanics::ContactShare& place = assembly_.shares()[element];
  const auto contact = static_cast<Eigen::Index>(place.contact);
  const StepEquations<N, H>& eq = flow_.equations();
  if (!eq.holds(contact)) return form;  // its force is the internal one
  // Elements of one contact each carry a part of its force in proportion to their limits: at rest the static
  // ones, so that none breaks its own.
  const bool rests = flow_.rests(mode, contact);
  const double limit = (rests ? eq.static_limit : eq.limit)[contact];
  const double own = rests ? law.static_friction : law.friction;
  const double share = limit > 0.0 ? place.orientation * own / limit : 0.0;
  if (contains(mode.stuck, contact)) {
    form.add(share, stuck_contact_force(contact, mode));
  } else {
    form.u[0] += share * mode.friction[contact];
  }
  return form;
}

// The bends of the element beyond their places, each along its side.
template <int N, int H>
void Forms<N, H>::add_bends(std::size_t element, const Mode<N, H>& mode, Form& form) const {
  if (mode.beyond == 0) return;
  const StepBends<N, H>& bends = flow_.equations().bends;
  for (Eigen::Index j = 0; j < bends.count(); ++j) {
    const auto place = static_cast<std::size_t>(j);
    if (!contains(mode.beyond, j) || assembly_.bends().element[place] != element) continue;
    form.add(assembly_.bends().side[place], bend_force(j));
  }
}

// k (u - D) + c u', or c (u' - D)
template <int N, int H>
LinearForm<N, H> Forms<N, H>::bend_force(Eigen::Index j) const {
  const StepBends<N, H>& bends = flow_.equations().bends;
  const Eigen::Index n = flow_.equations().masses();
  Form form = zero();
  form.z.head(n) = bends.stiffness[j] * bends.B.col(j);
  form.z.segment(n, n) = bends.damping[j] * bends.B.col(j);
  form.u = bends.support_force(j).transpose();
  return form;
}

template <int N, int H>
LinearForm<N, H> Forms<N, H>::bend_velocity(Eigen::Index j) const {
  const StepBends<N, H>& bends = flow_.equations().bends;
  const Eigen::Index n = flow_.equations().masses();
  Form form = zero();
  form.z.segment(n, n) = bends.B.col(j) / flow_.equations().step;
  form.u = bends.motion_velocity.row(j).transpose() / flow_.equations().step;
  return form;
}

template <int N, int H>
LinearForm<N, H> Forms<N, H>::stuck_contact_force(Eigen::Index contact, const Mode<N, H>& mode) const {
  Form form = zero();
  form.z = flow_.stuck_force_form(mode, contact);
  form.u = flow_.configuration(mode).Lu.row(contact).transpose();
  form.u[0] += mode.stuck_force[contact];
  return form;
}

template <int N, int H>
LinearForm<N, H> Forms<N, H>::node_force(const mechanics::Node& node, const mechanics::LinearSystem& system,
                                         const Mode<N, H>& mode) const {
  return mechanics::force_on_node(*this, assembly_.network(), node, system, mode);
}

// Compiled once for each size, in flow_1_1.cpp and so on.
extern template class Forms<1, 1>;
extern template class Forms<2, 1>;
extern template class Forms<Eigen::Dynamic, Eigen::Dynamic>;

}  // namespace frahm::periodic
