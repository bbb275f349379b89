#include "solvers/mechanics/linear_system.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <sstream>

#include "solvers/mechanics/crank.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/free_directions.hpp"
#include "solvers/mechanics/joints.hpp"
#include "solvers/mechanics/recorded_columns.hpp"
#include "solvers/mechanics/rotation.hpp"
#include "solvers/mechanics/smooth_laws.hpp"
#include "solvers/mechanics/structural_damping.hpp"

namespace frahm::mechanics {
namespace {

[[noreturn]] void refuse(const std::string& thing, double value, const std::string& rule) {
  std::ostringstream message;
  message << thing << " = " << value << ": " << rule;
  throw MechanicsError(message.str());
}

void check_value(const ValueKey& key, const Element& element, double value) {
  const std::string thing = std::string(key.key) + " of '" + element.name + "'";
  if (!std::isfinite(value)) refuse(thing, value, "must be finite");
  if (key.range != Range::finite && value < 0.0) refuse(thing, value, "must not be negative");
  if (key.range == Range::positive && value == 0.0) refuse(thing, value, "must be positive");
}

// A pivot of Cholesky's decomposition below this part of the largest is only rounding away from zero.
constexpr double kSmallestPivot = 1e-13;

// Refuses a node whose own entry is too small next to that of another.
void refuse_lost_entry(const Eigen::MatrixXd& matrix, const std::string& name, const Network& network) {
  Eigen::Index least = 0, most = 0;
  const double smallest = matrix.diagonal().minCoeff(&least), largest = matrix.diagonal().maxCoeff(&most);
  if (!(smallest > 0.0) || std::sqrt(smallest) > kSmallestPivot * std::sqrt(largest)) return;
  std::ostringstream rule;
  rule << "is lost in rounding next to " << largest << " at '"
       << network.masses[static_cast<std::size_t>(most)] << "'";
  refuse("the " + name + " at '" + network.masses[static_cast<std::size_t>(least)] + "'", smallest,
         rule.str());
}

void require_positive_definite(const Eigen::MatrixXd& matrix, const std::string& name,
                               const std::string& hint, const Network& network) {
  const Eigen::LLT<Eigen::MatrixXd> factor(matrix);
  const double smallest_pivot = kSmallestPivot * std::sqrt(matrix.diagonal().cwiseAbs().maxCoeff());
  if (factor.info() == Eigen::Success && factor.matrixLLT().diagonal().minCoeff() > smallest_pivot) return;
  refuse_lost_entry(matrix, name, network);
  throw MechanicsError("the " + name + " matrix of the moving nodes is not positive definite: " + hint);
}

}  // namespace

Incidence incidence(const Network& network, const Direction& u) {
  Incidence result{Eigen::VectorXd::Zero(static_cast<Eigen::Index>(network.masses.size())),
                   Eigen::VectorXd::Zero(static_cast<Eigen::Index>(network.prescribed.size())),
                   Eigen::VectorXd::Zero(static_cast<Eigen::Index>(network.joints.size()))};
  for (const auto& [node, factor] : u) {
    if (node.kind == NodeKind::mass) result.w[static_cast<Eigen::Index>(node.index)] += factor;
    if (node.kind == NodeKind::prescribed) result.p[static_cast<Eigen::Index>(node.index)] += factor;
    if (node.kind == NodeKind::joint) result.j[static_cast<Eigen::Index>(node.index)] += factor;
  }
  return result;
}

Incidence incidence(const Network& network, const Element& element) {
  return incidence(network, element.along);
}

Assembly::Assembly(const Network& network, FreeMasses free)
    : network_(network),
      free_(free),
      shares_(network.elements.size()),
      internal_(network.elements.size(), -1) {
  for (std::size_t e = 0; e < network_.elements.size(); ++e) {
    const Element& element = network_.elements[e];
    const ElementKind& kind = kind_of(element);
    incidences_.push_back(incidence(network_, element));
    if (incidences_.back().w.isZero(0.0) && !incidences_.back().has_joint()) {
      throw MechanicsError("element '" + element.name + "' joins no moving node");
    }
    if (kind.has_internal_force) internal_[e] = static_cast<Eigen::Index>(internal_forces_++);
    if (kind.law != nullptr) place_in_contact(e);
  }
  depends_on_frequency_ = frequency_dependent_element(network_) != nullptr;
  bends_ = place_bends(network_, incidences_);
  place_orders();
  weigh_support_force();
  if (free_ == FreeMasses::allowed) clean_floating_matrices();
  add_up_matrices();
  if (network_.joints.empty()) return;
  check_elements_of_joints(network_, incidences_);
  joint_directions_ = directions_of_joints(network_, incidences_);
  internal_forces_ += static_cast<std::size_t>(joint_directions_.damped.cols());
}

// Where all springs together leave masses free, what is rounding in the matrices must not hold them either.
void Assembly::clean_floating_matrices() {
  if (network_.matrices.empty()) return;
  if (!network_.joints.empty()) {
    if (!may_have_free_masses(network_)) return;
    for (MatrixPart& part : network_.matrices) part.stiffness = without_rounding(part.stiffness);
    return;
  }
  LinearSystem every_spring;
  const auto n = static_cast<Eigen::Index>(network_.masses.size());
  every_spring.M.setIdentity(n, n);
  for (const Element& element : network_.elements)
    every_spring.coefficients.push_back({.stiffness = kind_of(element).holds ? 1.0 : 0.0});
  if (mechanics::find_free_directions(*this, every_spring).cols() == 0) return;
  for (MatrixPart& part : network_.matrices) part.stiffness = without_rounding(part.stiffness);
}

void Assembly::add_up_matrices() {
  const auto n = static_cast<Eigen::Index>(network_.masses.size());
  const auto add = [&](const Eigen::MatrixXd& part, const std::vector<std::size_t>& nodes,
                       Eigen::MatrixXd& sum) {
    if (part.size() == 0) return;
    if (sum.size() == 0) sum.setZero(n, n);
    for (Eigen::Index i = 0; i < part.rows(); ++i)
      for (Eigen::Index j = 0; j < part.cols(); ++j)
        sum(static_cast<Eigen::Index>(nodes[static_cast<std::size_t>(i)]),
            static_cast<Eigen::Index>(nodes[static_cast<std::size_t>(j)])) += part(i, j);
  };
  for (const MatrixPart& part : network_.matrices) {
    add(part.mass, part.nodes, matrices_.mass);
    add(part.damping, part.nodes, matrices_.damping);
    add(part.stiffness, part.nodes, matrices_.stiffness);
  }
}

// Elements along the same direction share a contact where their law merges.
void Assembly::place_in_contact(std::size_t e) {
  const laws::Law* law = kind_of(network_.elements[e]).law;
  const Incidence& own = incidences_[e];
  for (std::size_t other = 0; law->merges && other < e; ++other) {
    const Incidence& first = incidences_[other];
    const bool alike = first.w == own.w && first.p == own.p;
    const bool opposite = first.w == -own.w && first.p == -own.p;
    if (kind_of(network_.elements[other]).law != law || !(alike || opposite)) continue;
    shares_[e].contact = shares_[other].contact;
    shares_[e].orientation = alike ? shares_[other].orientation : -shares_[other].orientation;
    return;
  }
  shares_[e].contact = contact_laws_.size();
  contact_laws_.push_back(law);
  contact_internal_.push_back(internal_[e]);
}

void Assembly::place_orders() {
  for (const Excitation& excitation : network_.excitations) {
    if (excitation.order < 0) throw MechanicsError("the order of an excitation must not be negative");
    if (excitation.order > 0) orders_.push_back(excitation.order);
    if (excitation.order % 2 == 0) odd_forcing_ = false;
    if (excitation.kind != ExcitationKind::crank || excitation.taylor_order == 1) continue;
    odd_forcing_ = false;
    for (int m = 1; m <= excitation.even_orders; ++m) orders_.push_back(2 * m);
  }
  if (network_.reference_order < 1) throw MechanicsError("the reference order must be at least 1");
  orders_.push_back(network_.reference_order);
  std::sort(orders_.begin(), orders_.end());
  orders_.erase(std::unique(orders_.begin(), orders_.end()), orders_.end());
}

void Assembly::check_values(const NetworkValues& values) const {
  for (std::size_t i = 0; i < network_.masses.size(); ++i) {
    if (!(values.mass[i] >= 0.0 && std::isfinite(values.mass[i]))) {
      refuse((rotates(network_, i) ? "inertia of '" : "mass of '") + network_.masses[i] + "'", values.mass[i],
             "must be finite and not negative");
    }
  }
  for (std::size_t e = 0; e < network_.elements.size(); ++e) {
    const Element& element = network_.elements[e];
    const auto keys = kind_of(element).values();
    for (std::size_t i = 0; i < keys.size(); ++i)
      if (keys[i]->exists_under(element.law)) check_value(*keys[i], element, number_of(values, i, e));
    if (element.law == ForceLaw::stribeck) check_curve(element, smooth_value(values, e).curve);
    if (const double at_rest = static_force(element, values, e); at_rest < values.element[e] && at_rest > 0.0)
      refuse("static_force of '" + element.name + "'", at_rest, "must not be below its force");
  }
  check_structural_damping(network_, values.damping);
}

void Assembly::set_values(const NetworkValues& values, LinearSystem& system) const {
  check_values(values);
  const auto n = static_cast<Eigen::Index>(network_.masses.size());
  const auto p = static_cast<Eigen::Index>(network_.prescribed.size());
  const auto m = static_cast<Eigen::Index>(contacts());
  system.M.setZero(n, n);
  system.C.setZero(n, n);
  system.K.setZero(n, n);
  system.M_support.setZero(n, p);
  system.C_support.setZero(n, p);
  system.K_support.setZero(n, p);
  system.W.setZero(n, m);
  system.W_support.setZero(p, m);
  system.limit.setZero(m);
  system.static_limit.setZero(m);
  system.bends = bends_;
  set_bends(network_, values, system.bends);
  system.law = contact_laws_;
  system.contact_internal = contact_internal_;
  const auto s = static_cast<Eigen::Index>(internal_forces_);
  system.D.setZero(n, s);
  system.D_support.setZero(p, s);
  system.internal_stiffness.setZero(s);
  system.internal_rate.setZero(s);
  system.orders = orders_;
  system.reference_order = network_.reference_order;
  system.odd_forcing = odd_forcing_;
  system.mass.setZero(n, n);
  system.mass.diagonal() = Eigen::Map<const Eigen::VectorXd>(values.mass.data(), n);
  if (matrices_.mass.size() > 0) system.mass += matrices_.mass;
  system.M = system.mass;
  system.support_force = support_force_;
  system.felt_inertia = support_force_.c.transpose() * system.mass;
  system.felt_inertia_support.setZero(p);
  if (matrices_.stiffness.size() > 0) system.K = matrices_.stiffness;

  const double omega_h =
      values.hysteretic_omega > 0.0 ? values.hysteretic_omega : network_.reference_order * values.omega;
  system.coefficients.resize(network_.elements.size());
  // Each coefficient adds coefficient * w w^T to the block of the masses and coefficient * w p^T to that of
  // the supports; those of joints follow.
  const auto add = [](Eigen::MatrixXd& block, Eigen::MatrixXd& support, const Incidence& at, double value) {
    if (value == 0.0) return;
    block.noalias() += value * at.w * at.w.transpose();
    support.noalias() += value * at.w * at.p.transpose();
  };
  for (std::size_t e = 0; e < network_.elements.size(); ++e) {
    const Incidence& at = incidences_[e];
    const Added<double> added =
        kind_of(network_.elements[e]).adds(values.element[e], second_value(values, e), omega_h);
    system.coefficients[e] = {.stiffness = added.stiffness,
                              .damping = added.damping,
                              .inertance = added.inertance,
                              .friction = added.limit,
                              .internal = internal_[e],
                              .internal_damping = added.internal_damping};
    if (!at.has_joint()) {
      add(system.K, system.K_support, at, added.stiffness);
      add(system.C, system.C_support, at, added.damping);
    }
    add(system.M, system.M_support, at, added.inertance);
    if (const double excess = support_force_.excess[static_cast<Eigen::Index>(e)]; excess != 0.0) {
      system.felt_inertia += excess * added.inertance * at.w.transpose();
      system.felt_inertia_support += excess * added.inertance * at.p.transpose();
    }
    if (has_contact(network_.elements[e])) {
      const auto contact = static_cast<Eigen::Index>(shares_[e].contact);
      system.W.col(contact) = shares_[e].orientation * at.w;
      system.W_support.col(contact) = shares_[e].orientation * at.p;
      const double at_rest = static_force(network_.elements[e], values, e);
      const double limit = friction_at_high_speed(smooth_value(values, e), added.limit);
      system.limit[contact] += limit;
      system.static_limit[contact] += at_rest > 0.0 ? at_rest : limit;
      system.coefficients[e].static_friction = at_rest > 0.0 ? at_rest : added.limit;
    }
    if (const Eigen::Index place = internal_[e]; place >= 0) {
      system.D.col(place) = at.w;
      system.D_support.col(place) = at.p;
      system.internal_stiffness[place] = added.internal_stiffness;
      system.internal_rate[place] = added.internal_rate;
    }
  }
  weigh_laws(values, system);
  require_positive_definite(
      system.M, "mass",
      "a mass of zero needs an inerter to a mass, to the ground or to a node of prescribed "
      "motion (in a series an inerter may change places with a spring or a damper); a spring and a slider in "
      "series are one jenkins element",
      network_);
  if (!network_.joints.empty()) condense_joints(*this, system);
  check_stiffness(system);
  set_structural_damping(*this, values.damping, system);
  find_resisted(system);
}

// After the damping of the structure, which acts along free directions too.
void Assembly::find_resisted(LinearSystem& system) const {
  const Eigen::MatrixXd& R = system.free_directions;
  system.resisted.resize(0, R.cols());
  if (R.cols() == 0) return;
  const Eigen::MatrixXd damped = damped_combinations(*this, system);
  const Eigen::Index contacts = system.contacts(), internal = system.internal_forces();
  const Eigen::Index bends = system.bends.count();
  system.resisted.setZero(damped.rows() + contacts + internal + bends, R.cols());
  system.resisted.topRows(damped.rows()) = strained_along(damped.transpose(), R);
  const Eigen::MatrixXd rubbed = strained_along(system.W, R), bent = strained_along(system.bends.W, R);
  for (Eigen::Index j = 0; j < contacts; ++j) {
    if (system.static_limit[j] > 0.0) system.resisted.row(damped.rows() + j) = rubbed.row(j);
  }
  system.resisted.middleRows(damped.rows() + contacts, internal) = strained_along(system.D, R);
  for (Eigen::Index j = 0; j < bends; ++j) {
    if (system.bends.law[static_cast<std::size_t>(j)]->of_velocity)
      system.resisted.row(damped.rows() + contacts + internal + j) = bent.row(j);
  }
}

void Assembly::check_stiffness(LinearSystem& system) const {
  system.free_directions.resize(system.masses(), 0);
  if (free_ == FreeMasses::refused) {
    require_positive_definite(system.K, "stiffness",
                              "some motion is held by no spring, or a negative stiffness is too large",
                              network_);
    return;
  }
  system.free_directions = mechanics::find_free_directions(*this, system);
  const bool any = system.free_directions.cols() > 0;
  require_positive_definite(any ? held_stiffness(system) : system.K, "stiffness",
                            "a negative stiffness is too large", network_);
}

// One response alone follows the symmetry of its system.
void Assembly::weigh_laws(const NetworkValues& values, LinearSystem& system) const {
  system.monotone = are_monotone(network_, values) && smooth_laws_are_monotone(network_, values) &&
                    system.static_limit == system.limit;
  system.odd_response = odd_forcing_ && system.monotone && system.bends.count() == 0;
}

void Assembly::set_friction(const NetworkValues& values, LinearSystem& system) const {
  check_values(values);
  system.limit.setZero();
  system.static_limit.setZero();
  for (std::size_t e = 0; e < network_.elements.size(); ++e) {
    if (!has_contact(network_.elements[e])) continue;
    const Added<double> added =
        kind_of(network_.elements[e]).adds(values.element[e], second_value(values, e), 0.0);
    const double at_rest = static_force(network_.elements[e], values, e);
    const double limit = friction_at_high_speed(smooth_value(values, e), added.limit);
    const auto contact = static_cast<Eigen::Index>(shares_[e].contact);
    system.coefficients[e].friction = added.limit;
    system.coefficients[e].static_friction = at_rest > 0.0 ? at_rest : added.limit;
    system.limit[contact] += limit;
    system.static_limit[contact] += at_rest > 0.0 ? at_rest : limit;
  }
  weigh_laws(values, system);
  find_resisted(system);
}

// R cos(omega t + phase - pi/2) + sum_m even[m] cos(2 m (omega t + phase))
void Assembly::add_crank(const Excitation& excitation, const ExcitationValue& value,
                         LinearSystem& system) const {
  const auto [radius, phase, rod] = value;
  if (!(radius >= 0.0)) refuse("the crank's radius", radius, "must not be negative");
  if (!(std::isfinite(rod) && rod > radius)) refuse("the crank's rod", rod, "must be longer than the crank");
  const int even_orders = excitation.taylor_order == 1 ? 0 : excitation.even_orders;
  if (excitation.taylor_order == 0 && radius > 0.0 && crank_orders_needed(radius / rod) > even_orders) {
    refuse("crank over rod", radius / rod, "is more than the stored orders allow");
  }
  const auto node = static_cast<Eigen::Index>(excitation.node);
  const auto place = [&](int order) {
    return std::lower_bound(orders_.begin(), orders_.end(), order) - orders_.begin();
  };
  const auto even = crank_even_orders(radius, rod, even_orders, excitation.taylor_order);
  system.motion(node, place(1)) += std::polar(radius, phase - 0.5 * std::numbers::pi);
  system.constant_motion[node] += even[0];
  for (int m = 1; m <= even_orders; ++m) {
    system.motion(node, place(2 * m)) += even[static_cast<std::size_t>(m)] * std::polar(1.0, 2 * m * phase);
  }
}

void Assembly::set_forcing(const NetworkValues& values, LinearSystem& system) const {
  if (!(values.omega > 0.0 && std::isfinite(values.omega))) {
    refuse("the angular frequency", values.omega, "must be finite and positive");
  }
  const double fastest = orders_.back() * values.omega;
  if (!std::isfinite(fastest * fastest * system.M.diagonal().maxCoeff()))
    refuse("the angular frequency", values.omega,
           "must be lower: its square times the masses must be finite");
  const auto n = static_cast<Eigen::Index>(network_.masses.size());
  const auto p = static_cast<Eigen::Index>(network_.prescribed.size());
  const auto harmonics = static_cast<Eigen::Index>(orders_.size());
  const auto forced = n + static_cast<Eigen::Index>(network_.joints.size());
  system.omega = values.omega;
  system.constant_force.setZero(forced);
  system.constant_motion.setZero(p);
  system.belt_velocity.setZero(p);
  system.force.setZero(forced, harmonics);
  system.motion.setZero(p, harmonics);

  for (std::size_t k = 0; k < network_.excitations.size(); ++k) {
    const Excitation& excitation = network_.excitations[k];
    const auto node = static_cast<Eigen::Index>(excitation.node);
    const auto [amplitude, phase, rod] = values.excitation[k];
    if (!std::isfinite(amplitude)) refuse("an excitation's amplitude", amplitude, "must be finite");
    if (!std::isfinite(phase)) refuse("an excitation's phase", phase, "must be finite");
    if (is_recorded(excitation.kind)) continue;
    if (excitation.kind == ExcitationKind::crank) {
      add_crank(excitation, values.excitation[k], system);
      continue;
    }
    if (excitation.kind == ExcitationKind::belt) {
      system.belt_velocity[node] += amplitude * std::cos(phase);
      continue;
    }
    const bool is_force = excitation.kind == ExcitationKind::force;
    if (excitation.order == 0) {
      (is_force ? system.constant_force : system.constant_motion)[node] += amplitude * std::cos(phase);
      continue;
    }
    const auto place = std::lower_bound(orders_.begin(), orders_.end(), excitation.order) - orders_.begin();
    (is_force ? system.force : system.motion)(node, place) += std::polar(amplitude, phase);
  }
  if (forced > n) part_loads_of_joints(n, system);
  system.constant_applied_force = system.constant_force;
  system.applied_force = system.force;
  set_recorded(network_, values, system);
  if (forced > n) load_masses_by_joints(system);
  if (p == 0) return;

  // What the supports exert: f = -(K_s y + C_s y' + M_s y''), harmonic by harmonic. What they exert through
  // Maxwell elements is in those elements' forces.
  system.constant_force.noalias() -= system.K_support * system.constant_motion;
  if (!system.belt_velocity.isZero(0.0))
    system.constant_force.noalias() -= system.C_support * system.belt_velocity;
  for (Eigen::Index k = 0; k < harmonics; ++k) {
    const std::complex<double> i_omega(0.0, orders_[static_cast<std::size_t>(k)] * values.omega);
    for (Eigen::Index row = 0; row < n; ++row) {
      for (Eigen::Index s = 0; s < p; ++s) {
        const std::complex<double> dynamic_stiffness =
            system.K_support(row, s) +
            i_omega * (system.C_support(row, s) + i_omega * system.M_support(row, s));
        system.force(row, k) -= dynamic_stiffness * system.motion(s, k);
      }
    }
  }
}

}  // namespace frahm::mechanics
