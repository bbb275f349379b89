#include "solvers/mechanics/system_derivative.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <numeric>

#include "solvers/mechanics/crank.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/joints.hpp"
#include "solvers/mechanics/recorded_columns.hpp"
#include "solvers/mechanics/structural_damping.hpp"

namespace frahm::mechanics {
namespace {

void resize(const LinearSystem& system, const NetworkValues& direction, LinearSystem& d) {
  const Eigen::Index n = system.masses(), p = system.W_support.rows();
  const Eigen::Index forced = n + system.joints.B.rows();
  d.omega = direction.omega;
  d.orders = system.orders;
  d.reference_order = system.reference_order;
  d.mass.setZero(n, n);
  d.mass.diagonal() = Eigen::Map<const Eigen::VectorXd>(direction.mass.data(), n);
  d.M.setZero(n, n);
  d.C.setZero(n, n);
  d.K.setZero(n, n);
  d.M_support.setZero(n, p);
  d.C_support.setZero(n, p);
  d.K_support.setZero(n, p);
  d.limit.setZero(system.contacts());
  d.static_limit.setZero(system.contacts());
  d.internal_stiffness.setZero(system.internal_forces());
  d.internal_rate.setZero(system.internal_forces());
  d.coefficients.resize(system.coefficients.size());
  d.constant_force.setZero(forced);
  d.constant_motion.setZero(p);
  d.belt_velocity.setZero(p);
  d.force.setZero(forced, system.force.cols());
  d.motion.setZero(p, system.motion.cols());
  d.M = d.mass;
  d.support_force = system.support_force;
  d.felt_inertia = d.support_force.c.transpose() * d.mass;
  d.felt_inertia_support.setZero(p);
}

void differentiate_elements(const Assembly& assembly, const NetworkValues& values,
                            const NetworkValues& direction, const LinearSystem& system, LinearSystem& d) {
  const Network& network = assembly.network();
  const double reference = network.reference_order;
  const Dual omega_h = values.hysteretic_omega > 0.0
                           ? Dual{values.hysteretic_omega, direction.hysteretic_omega}
                           : Dual{reference * values.omega, reference * direction.omega};
  const auto add = [](Eigen::MatrixXd& block, Eigen::MatrixXd& support, const Incidence& at, double by) {
    if (by == 0.0) return;
    block.noalias() += by * at.w * at.w.transpose();
    support.noalias() += by * at.w * at.p.transpose();
  };
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    const Element& element = network.elements[e];
    const Added<Dual> added =
        kind_of(element).adds(Dual{values.element[e], direction.element[e]},
                              Dual{second_value(values, e), second_value(direction, e)}, omega_h);
    const Incidence& at = assembly.incidences()[e];
    const Eigen::Index internal = system.coefficients[e].internal;
    const bool has_static_force = static_force(element, values, e) > 0.0;
    const double at_rest = has_static_force ? second_value(direction, e) : added.limit.derivative;
    d.coefficients[e] = {.stiffness = added.stiffness.derivative,
                         .damping = added.damping.derivative,
                         .inertance = added.inertance.derivative,
                         .friction = added.limit.derivative,
                         .static_friction = at_rest,
                         .internal = internal,
                         .internal_damping = added.internal_damping.derivative};
    if (!at.has_joint()) {
      add(d.K, d.K_support, at, added.stiffness.derivative);
      add(d.C, d.C_support, at, added.damping.derivative);
    }
    add(d.M, d.M_support, at, added.inertance.derivative);
    if (const double excess = d.support_force.excess[static_cast<Eigen::Index>(e)]; excess != 0.0) {
      d.felt_inertia += excess * added.inertance.derivative * at.w.transpose();
      d.felt_inertia_support += excess * added.inertance.derivative * at.p.transpose();
    }
    if (has_contact(element)) {
      const auto contact = static_cast<Eigen::Index>(assembly.shares()[e].contact);
      d.limit[contact] += added.limit.derivative;
      d.static_limit[contact] += at_rest;
    }
    if (internal >= 0) {
      d.internal_stiffness[internal] = added.internal_stiffness.derivative;
      d.internal_rate[internal] = added.internal_rate.derivative;
    }
  }
}

void differentiate_bends(const Network& network, const NetworkValues& direction, Bends& d) {
  const auto count = [](const Element& element) { return element.bends.size(); };
  const std::size_t all = std::transform_reduce(network.elements.begin(), network.elements.end(),
                                                std::size_t{0}, std::plus<>(), count);
  const auto b = static_cast<Eigen::Index>(all);
  d.place.setZero(b);
  d.stiffness.setZero(b);
  d.damping.setZero(b);
  Eigen::Index first = 0;
  for (std::size_t e = 0; e < direction.bends.size(); ++e) {
    Eigen::Index column = first;
    for (const BendValue& by : direction.bends[e]) {
      d.place[column] = by.place;
      d.stiffness[column] = by.stiffness;
      d.damping[column++] = by.damping;
    }
    first += static_cast<Eigen::Index>(count(network.elements[e]));
  }
}

// d [A e^{i turns phase}] = (dA + i turns A dphase) e^{i turns phase}
std::complex<double> phasor_derivative(Dual amplitude, Dual phase, double turns) {
  return std::complex<double>(amplitude.derivative, turns * amplitude.value * phase.derivative) *
         std::polar(1.0, turns * phase.value);
}

void differentiate_crank(const Excitation& excitation, const ExcitationValue& value,
                         const ExcitationValue& by, const std::vector<int>& orders, LinearSystem& d) {
  const auto node = static_cast<Eigen::Index>(excitation.node);
  const auto place = [&](int order) {
    return std::lower_bound(orders.begin(), orders.end(), order) - orders.begin();
  };
  const Dual radius{value.amplitude, by.amplitude};
  const double quarter = 0.5 * std::numbers::pi;
  d.motion(node, place(1)) += phasor_derivative(radius, {value.phase - quarter, by.phase}, 1.0);

  const int count = excitation.taylor_order == 1 ? 0 : excitation.even_orders;
  const auto even = crank_even_orders(value.amplitude, value.rod, count, excitation.taylor_order);
  const auto even_by = crank_even_orders_derivative(value.amplitude, value.rod, by.amplitude, by.rod, count,
                                                    excitation.taylor_order);
  d.constant_motion[node] += even_by[0];
  for (int m = 1; m <= count; ++m) {
    const auto i = static_cast<std::size_t>(m);
    d.motion(node, place(2 * m)) +=
        phasor_derivative({even[i], even_by[i]}, {value.phase, by.phase}, 2.0 * m);
  }
}

void differentiate_excitation(const Assembly& assembly, const NetworkValues& values,
                              const NetworkValues& direction, LinearSystem& d) {
  const std::vector<int>& orders = assembly.orders();
  for (std::size_t k = 0; k < assembly.network().excitations.size(); ++k) {
    const Excitation& excitation = assembly.network().excitations[k];
    const ExcitationValue &value = values.excitation[k], &by = direction.excitation[k];
    if (excitation.kind == ExcitationKind::crank) {
      differentiate_crank(excitation, value, by, orders, d);
      continue;
    }
    if (is_recorded(excitation.kind)) continue;
    const auto node = static_cast<Eigen::Index>(excitation.node);
    const bool is_force = excitation.kind == ExcitationKind::force;
    const std::complex<double> change =
        phasor_derivative({value.amplitude, by.amplitude}, {value.phase, by.phase}, 1.0);
    if (excitation.kind == ExcitationKind::belt) {
      d.belt_velocity[node] += change.real();
      continue;
    }
    if (excitation.order == 0) {
      (is_force ? d.constant_force : d.constant_motion)[node] += change.real();
      continue;
    }
    const auto place = std::lower_bound(orders.begin(), orders.end(), excitation.order) - orders.begin();
    (is_force ? d.force : d.motion)(node, place) += change;
  }
}

// f_k -= Z_k Y_k with Z_k = K_s + i n omega C_s - (n omega)^2 M_s:  d(Z Y) = dZ Y + Z dY.
void differentiate_support_forces(const LinearSystem& system, LinearSystem& d) {
  d.constant_force -= d.K_support * system.constant_motion + system.K_support * d.constant_motion;
  d.constant_force -= d.C_support * system.belt_velocity + system.C_support * d.belt_velocity;
  for (Eigen::Index k = 0; k < system.force.cols(); ++k) {
    const double n = system.orders[static_cast<std::size_t>(k)];
    const std::complex<double> i_omega(0.0, n * system.omega), i_omega_by(0.0, n * d.omega);
    for (Eigen::Index row = 0; row < system.masses(); ++row) {
      for (Eigen::Index s = 0; s < system.motion.rows(); ++s) {
        const double C = system.C_support(row, s), M = system.M_support(row, s);
        const std::complex<double> Z = system.K_support(row, s) + i_omega * (C + i_omega * M);
        const std::complex<double> Z_by = d.K_support(row, s) +
                                          i_omega * (d.C_support(row, s) + i_omega * d.M_support(row, s)) +
                                          i_omega_by * (C + 2.0 * i_omega * M);
        d.force(row, k) -= Z_by * system.motion(s, k) + Z * d.motion(s, k);
      }
    }
  }
}

}  // namespace

void differentiate_matrices(const Assembly& assembly, const NetworkValues& values,
                            const NetworkValues& direction, const LinearSystem& system,
                            LinearSystem& derivative) {
  resize(system, direction, derivative);
  differentiate_elements(assembly, values, direction, system, derivative);
  differentiate_bends(assembly.network(), direction, derivative.bends);
  if (system.joints.any()) differentiate_joints(assembly, system, derivative);
  differentiate_structural_damping(assembly, values, direction, system, derivative);
}

void differentiate(const Assembly& assembly, const NetworkValues& values, const NetworkValues& direction,
                   const LinearSystem& system, LinearSystem& derivative) {
  differentiate_matrices(assembly, values, direction, system, derivative);
  // A system over m periods has an m-th of the frequency.
  derivative.omega *= system.omega / values.omega;
  differentiate_excitation(assembly, values, direction, derivative);
  if (system.joints.any()) part_loads_of_joints(system.masses(), derivative);
  derivative.constant_applied_force = derivative.constant_force;
  derivative.applied_force = derivative.force;
  if (system.motion.rows() > 0) differentiate_support_forces(system, derivative);
  differentiate_recorded(assembly.network(), values, direction, system, derivative);
  if (system.joints.any()) differentiate_loads_of_joints(system, derivative);
}

}  // namespace frahm::mechanics
