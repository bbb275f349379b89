#include "solvers/mechanics/linear_system.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <sstream>

namespace frahm::mechanics {
namespace {

const char* value_name(ElementType type) {
  switch (type) {
    case ElementType::spring:
      return "stiffness";
    case ElementType::damper:
      return "damping";
    case ElementType::inerter:
      return "inertance";
    case ElementType::coulomb:
      return "force";
  }
  return "value";
}

[[noreturn]] void refuse(const std::string& thing, double value, const std::string& rule) {
  std::ostringstream message;
  message << thing << " = " << value << ": " << rule;
  throw MechanicsError(message.str());
}

void require_positive_definite(const Eigen::MatrixXd& matrix, const std::string& name,
                               const std::string& hint) {
  const Eigen::LLT<Eigen::MatrixXd> factor(matrix);
  // A pivot that is only rounding away from zero is a singular matrix too.
  const double smallest_pivot = 1e-13 * std::sqrt(matrix.diagonal().cwiseAbs().maxCoeff());
  if (factor.info() != Eigen::Success || !(factor.matrixLLT().diagonal().minCoeff() > smallest_pivot)) {
    throw MechanicsError("the " + name + " matrix of the moving nodes is not positive definite: " + hint);
  }
}

}  // namespace

Incidence incidence(const Network& network, const Element& element) {
  Incidence result{Eigen::VectorXd::Zero(static_cast<Eigen::Index>(network.masses.size())),
                   Eigen::VectorXd::Zero(static_cast<Eigen::Index>(network.prescribed.size()))};
  const auto add = [&](const Node& node, double sign) {
    if (node.kind == NodeKind::mass) result.w[static_cast<Eigen::Index>(node.index)] += sign;
    if (node.kind == NodeKind::prescribed) result.p[static_cast<Eigen::Index>(node.index)] += sign;
  };
  add(element.b, +1.0);
  add(element.a, -1.0);
  return result;
}

Assembly::Assembly(const Network& network) : network_(network), shares_(network.elements.size()) {
  std::vector<const Element*> contact_elements;
  for (std::size_t e = 0; e < network_.elements.size(); ++e) {
    const Element& element = network_.elements[e];
    incidences_.push_back(incidence(network_, element));
    if (incidences_.back().w.isZero(0.0)) {
      throw MechanicsError("element '" + element.name + "' joins no moving node");
    }
    if (element.type != ElementType::coulomb) continue;
    const auto same_nodes = [&](const Element* other) {
      return (other->a == element.a && other->b == element.b) ||
             (other->a == element.b && other->b == element.a);
    };
    const auto found = std::find_if(contact_elements.begin(), contact_elements.end(), same_nodes);
    shares_[e].contact = static_cast<std::size_t>(found - contact_elements.begin());
    if (found == contact_elements.end()) {
      contact_elements.push_back(&element);
    } else {
      shares_[e].orientation = (*found)->a == element.a ? 1.0 : -1.0;
    }
  }
  contacts_ = contact_elements.size();
  for (const Excitation& excitation : network_.excitations) {
    if (excitation.order < 0) throw MechanicsError("the order of an excitation must not be negative");
    if (excitation.order > 0) orders_.push_back(excitation.order);
    if (excitation.order % 2 == 0) odd_forcing_ = false;
  }
  if (network_.reference_order < 1) throw MechanicsError("the reference order must be at least 1");
  orders_.push_back(network_.reference_order);
  std::sort(orders_.begin(), orders_.end());
  orders_.erase(std::unique(orders_.begin(), orders_.end()), orders_.end());
}

void Assembly::check_values(const NetworkValues& values) const {
  for (std::size_t i = 0; i < network_.masses.size(); ++i) {
    if (!(values.mass[i] >= 0.0 && std::isfinite(values.mass[i]))) {
      refuse("mass of '" + network_.masses[i] + "'", values.mass[i], "must be finite and not negative");
    }
  }
  for (std::size_t e = 0; e < network_.elements.size(); ++e) {
    const Element& element = network_.elements[e];
    const double value = values.element[e];
    const std::string thing = std::string(value_name(element.type)) + " of '" + element.name + "'";
    if (!std::isfinite(value)) refuse(thing, value, "must be finite");
    if (element.type != ElementType::spring && value < 0.0) refuse(thing, value, "must not be negative");
  }
}

void Assembly::set_values(const NetworkValues& values, LinearSystem& system) const {
  check_values(values);
  const auto n = static_cast<Eigen::Index>(network_.masses.size());
  const auto p = static_cast<Eigen::Index>(network_.prescribed.size());
  const auto m = static_cast<Eigen::Index>(contacts_);
  system.M.setZero(n, n);
  system.C.setZero(n, n);
  system.K.setZero(n, n);
  system.M_support.setZero(n, p);
  system.C_support.setZero(n, p);
  system.K_support.setZero(n, p);
  system.W.setZero(n, m);
  system.W_support.setZero(p, m);
  system.limit.setZero(m);
  system.orders = orders_;
  system.odd_forcing = odd_forcing_;
  for (Eigen::Index i = 0; i < n; ++i) system.M(i, i) = values.mass[static_cast<std::size_t>(i)];

  // Each element adds value * w w^T to the block of the masses and value * w p^T to that of the supports.
  const auto add = [](Eigen::MatrixXd& block, Eigen::MatrixXd& support, const Incidence& at, double value) {
    block.noalias() += value * at.w * at.w.transpose();
    support.noalias() += value * at.w * at.p.transpose();
  };
  for (std::size_t e = 0; e < network_.elements.size(); ++e) {
    const Incidence& at = incidences_[e];
    const double value = values.element[e];
    switch (network_.elements[e].type) {
      case ElementType::spring:
        add(system.K, system.K_support, at, value);
        break;
      case ElementType::damper:
        add(system.C, system.C_support, at, value);
        break;
      case ElementType::inerter:
        add(system.M, system.M_support, at, value);
        break;
      case ElementType::coulomb: {
        const auto contact = static_cast<Eigen::Index>(shares_[e].contact);
        system.W.col(contact) = shares_[e].orientation * at.w;
        system.W_support.col(contact) = shares_[e].orientation * at.p;
        system.limit[contact] += value;
        break;
      }
    }
  }
  require_positive_definite(system.M, "mass", "a mass of zero needs an inerter that moves with it");
  require_positive_definite(system.K, "stiffness",
                            "some motion is held by no spring, or a negative stiffness is too large");
}

void Assembly::set_forcing(const NetworkValues& values, LinearSystem& system) const {
  if (!(values.omega > 0.0 && std::isfinite(values.omega))) {
    refuse("the angular frequency", values.omega, "must be finite and positive");
  }
  const auto n = static_cast<Eigen::Index>(network_.masses.size());
  const auto p = static_cast<Eigen::Index>(network_.prescribed.size());
  const auto harmonics = static_cast<Eigen::Index>(orders_.size());
  system.omega = values.omega;
  system.constant_force.setZero(n);
  system.constant_motion.setZero(p);
  system.force.setZero(n, harmonics);
  system.motion.setZero(p, harmonics);

  for (std::size_t k = 0; k < network_.excitations.size(); ++k) {
    const Excitation& excitation = network_.excitations[k];
    const auto node = static_cast<Eigen::Index>(excitation.node);
    const auto [amplitude, phase] = values.excitation[k];
    if (!std::isfinite(amplitude)) refuse("an excitation's amplitude", amplitude, "must be finite");
    if (!std::isfinite(phase)) refuse("an excitation's phase", phase, "must be finite");
    const bool is_force = excitation.kind == ExcitationKind::force;
    if (excitation.order == 0) {
      (is_force ? system.constant_force : system.constant_motion)[node] += amplitude * std::cos(phase);
      continue;
    }
    const auto place = std::lower_bound(orders_.begin(), orders_.end(), excitation.order) - orders_.begin();
    (is_force ? system.force : system.motion)(node, place) += std::polar(amplitude, phase);
  }
  system.constant_applied_force = system.constant_force;
  system.applied_force = system.force;
  if (p == 0) return;

  // What the supports exert: f = -(K_s y + C_s y' + M_s y''), harmonic by harmonic.
  system.constant_force.noalias() -= system.K_support * system.constant_motion;
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
