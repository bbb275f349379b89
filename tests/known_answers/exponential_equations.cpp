#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "tests/known_answers/exponential_integrator.hpp"

// How the equations are stamped from the network, and one piece of them for each state of contacts and bends.
namespace frahm::periodic {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::RowVectorXd, Eigen::VectorXd;
using mechanics::ElementType, mechanics::ExcitationKind, mechanics::NodeKind;

}  // namespace

ExponentialIntegrator::ExponentialIntegrator(const mechanics::Network& network,
                                             const mechanics::NetworkValues& values)
    : n_(static_cast<Index>(network.masses.size())),
      excitations_(network.excitations),
      excitation_values_(values.excitation),
      omega_(values.omega) {
  std::set<int> orders;
  for (const auto& excitation : network.excitations)
    if (excitation.order > 0) orders.insert(excitation.order);
  orders_.assign(orders.begin(), orders.end());
  for (const auto& element : network.elements)
    internal_ += element.type == ElementType::maxwell || element.type == ElementType::jenkins;
  first_joint_ = 2 * n_ + internal_;
  internal_ += static_cast<Index>(network.joints.size());
  size_ = 2 * n_ + internal_ + 2 * static_cast<Index>(orders_.size()) + 1;
  stamp(network, values);
  set_step();
  x_.setZero(size_);
}

VectorXd ExponentialIntegrator::direction(const mechanics::Element& element) const {
  VectorXd w = VectorXd::Zero(n_);
  for (const auto& [node, factor] : element.along)
    if (node.kind == NodeKind::mass) w[static_cast<Index>(node.index)] += factor;
  return w;
}

// A derivative of the displacement of a prescribed node, as a form of the state.
RowVectorXd ExponentialIntegrator::harmonic(std::size_t node, int derivative) const {
  RowVectorXd form = RowVectorXd::Zero(size_);
  for (std::size_t k = 0; k < excitations_.size(); ++k) {
    if (excitations_[k].kind != ExcitationKind::motion || excitations_[k].node != node) continue;
    const auto [amplitude, phase, rod] = excitation_values_[k];
    if (excitations_[k].order == 0) {
      if (derivative == 0) form[size_ - 1] += amplitude * std::cos(phase);
      continue;
    }
    // d/dt cos(n omega t + phase) = n omega cos(n omega t + phase + pi/2)
    const auto place = std::ranges::find(orders_, excitations_[k].order) - orders_.begin();
    const double size = amplitude * std::pow(excitations_[k].order * omega_, derivative);
    const double angle = phase + 0.5 * std::numbers::pi * derivative;
    form[2 * n_ + internal_ + 2 * place] += size * std::cos(angle);
    form[2 * n_ + internal_ + 2 * place + 1] -= size * std::sin(angle);
  }
  return form;
}

// For derivative 2 the supports' part alone: that of the masses is not a state.
RowVectorXd ExponentialIntegrator::motion(const mechanics::Element& element, int derivative) const {
  RowVectorXd form = RowVectorXd::Zero(size_);
  for (const auto& [node, factor] : element.along) {
    if (node.kind == NodeKind::mass && derivative < 2)
      form[derivative * n_ + static_cast<Index>(node.index)] += factor;
    if (node.kind == NodeKind::prescribed) form += factor * harmonic(node.index, derivative);
    if (node.kind != NodeKind::joint) continue;
    const auto joint = static_cast<Index>(node.index);
    if (derivative == 0) form[first_joint_ + joint] += factor;
    if (derivative == 1) form += factor * joint_rates_.row(joint);
  }
  return form;
}

void ExponentialIntegrator::stamp(const mechanics::Network& network, const mechanics::NetworkValues& values) {
  M_ = Eigen::Map<const VectorXd>(values.mass.data(), n_).asDiagonal();
  force_.setZero(n_, size_);
  rates_.setZero(internal_, size_);
  stamp_joints(network, values);
  const double omega_h = values.hysteretic_omega > 0.0 ? values.hysteretic_omega : omega_;
  Index internal = 0;
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    const mechanics::Element& element = network.elements[e];
    const double value = values.element[e], second = values.second.empty() ? 0.0 : values.second[e];
    if (element.type == ElementType::maxwell || element.type == ElementType::jenkins)
      stamp_internal_force(element, value, second, internal++);
    else
      stamp_element(element, value, second, omega_h);
    for (std::size_t b = 0; b < element.bends.size(); ++b)
      stamp_bend(element, element.bends[b], values.bends[e][b]);
  }
  for (std::size_t k = 0; k < excitations_.size(); ++k) {
    if (excitations_[k].kind != ExcitationKind::force) continue;
    const auto on = static_cast<Index>(excitations_[k].node);
    if (on >= n_) continue;
    const auto [amplitude, phase, rod] = excitation_values_[k];
    if (excitations_[k].order == 0) {
      force_(on, size_ - 1) += amplitude * std::cos(phase);
      continue;
    }
    const Index place =
        2 * n_ + internal_ + 2 * (std::ranges::find(orders_, excitations_[k].order) - orders_.begin());
    force_(on, place) += amplitude * std::cos(phase);
    force_(on, place + 1) -= amplitude * std::sin(phase);
  }
  M_inverse_ = M_.inverse();
}

// Joints without mass, each with a damper: C x' = P - sum of j (k u + c (u' without joints)).
void ExponentialIntegrator::stamp_joints(const mechanics::Network& network,
                                         const mechanics::NetworkValues& values) {
  const auto joints = static_cast<Index>(network.joints.size());
  joint_rates_.setZero(joints, size_);
  if (joints == 0) return;
  MatrixXd C = MatrixXd::Zero(joints, joints), balance = MatrixXd::Zero(joints, size_);
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    const mechanics::Element& element = network.elements[e];
    VectorXd j = VectorXd::Zero(joints);
    for (const auto& [node, factor] : element.along)
      if (node.kind == NodeKind::joint) j[static_cast<Index>(node.index)] += factor;
    if (element.type == ElementType::spring) balance -= j * values.element[e] * motion(element, 0);
    if (element.type != ElementType::damper) continue;
    C += values.element[e] * j * j.transpose();
    balance -= j * values.element[e] * motion(element, 1);  // joint_rates_ are still zero
  }
  for (std::size_t k = 0; k < excitations_.size(); ++k) {
    const Index joint = static_cast<Index>(excitations_[k].node) - n_;
    if (excitations_[k].kind != ExcitationKind::force || joint < 0) continue;
    const auto [amplitude, phase, rod] = excitation_values_[k];
    const Index place =
        2 * n_ + internal_ + 2 * (std::ranges::find(orders_, excitations_[k].order) - orders_.begin());
    balance(joint, place) += amplitude * std::cos(phase);
    balance(joint, place + 1) -= amplitude * std::sin(phase);
  }
  joint_rates_ = C.partialPivLu().solve(balance);
  rates_.bottomRows(joints) = joint_rates_;
}

// s' = k u' - (k/c) s of a Maxwell element; of a Jenkins element s' = k u' while its slider sticks.
void ExponentialIntegrator::stamp_internal_force(const mechanics::Element& element, double k, double second,
                                                 Index internal) {
  const Index place = 2 * n_ + internal;
  force_.col(place) -= direction(element);
  rates_.row(internal) = k * motion(element, 1);
  if (element.type == ElementType::maxwell)
    rates_(internal, place) -= k / second;
  else
    contacts_.push_back({direction(element), motion(element, 1), motion(element, 2), second, second, place});
}

void ExponentialIntegrator::stamp_element(const mechanics::Element& element, double value, double second,
                                          double omega_h) {
  const VectorXd w = direction(element);
  switch (element.type) {
    case ElementType::spring:
      force_ -= w * value * motion(element, 0);
      break;
    case ElementType::damper:
      force_ -= w * value * motion(element, 1);
      break;
    case ElementType::hysteretic:  // k u + (eta k / omega_h) u'
      force_ -= w * (value * motion(element, 0) + second * value / omega_h * motion(element, 1));
      break;
    case ElementType::inerter:
      M_ += value * w * w.transpose();
      force_ -= w * value * motion(element, 2);
      break;
    case ElementType::coulomb:
      contacts_.push_back({w, motion(element, 1), motion(element, 2), value,
                           element.has_static_force && second > 0.0 ? second : value, -1});
      break;
    default:
      break;
  }
}

void ExponentialIntegrator::stamp_bend(const mechanics::Element& element, const mechanics::BendPlace& place,
                                       const mechanics::BendValue& value) {
  const bool of_velocity = place.law->of_velocity;
  Bend bend;
  bend.w = place.side * direction(element);
  bend.past = place.side * motion(element, of_velocity ? 1 : 0);
  bend.past[size_ - 1] -= value.place;
  if (of_velocity)
    bend.force = value.damping * bend.past;
  else
    bend.force = value.stiffness * bend.past + value.damping * place.side * motion(element, 1);
  bend.jumps = !place.law->pulls && value.damping != 0.0;
  bends_.push_back(bend);
}

// A step is one over the fastest rate; the series has as many terms as it needs.
void ExponentialIntegrator::set_step() {
  Modes modes{std::vector<Mode>(contacts_.size(), Mode::forward), std::vector<Side>(bends_.size())};
  for (std::size_t j = 0; j < contacts_.size(); ++j)
    if (!holds(j)) modes.contact[j] = Mode::stuck;
  double fastest = 0.0;
  for (const Side side : {Side::before, Side::beyond}) {
    std::ranges::fill(modes.bend, side);
    const Eigen::EigenSolver<MatrixXd> solver(make_piece(modes).A, false);
    fastest = std::max(fastest, solver.eigenvalues().cwiseAbs().maxCoeff());
  }
  const double period = 2.0 * std::numbers::pi / omega_;
  steps_ = std::max(8, static_cast<int>(std::ceil(fastest * period)));
  step_ = period / steps_;
}

ExponentialIntegrator::Piece ExponentialIntegrator::make_piece(const Modes& modes) const {
  const auto m = static_cast<Index>(contacts_.size());
  MatrixXd force = force_;
  std::vector<std::size_t> stuck;
  for (std::size_t j = 0; j < contacts_.size(); ++j) {
    if (!holds(j)) continue;
    const double side = modes.contact[j] == Mode::forward ? 1.0 : -1.0;
    if (modes.contact[j] == Mode::stuck)
      stuck.push_back(j);
    else
      force.col(size_ - 1) -= side * contacts_[j].limit * contacts_[j].w;
  }
  for (std::size_t b = 0; b < bends_.size(); ++b)
    if (modes.bend[b] == Side::beyond) force -= bends_[b].w * bends_[b].force;
  MatrixXd acceleration = M_inverse_ * force;
  Piece result;
  result.lambda.setZero(m, size_);
  result.rate.setZero(m, size_);
  if (!stuck.empty()) {
    // W^T (a - M^-1 W lambda) + p^T y'' = 0
    MatrixXd W(n_, static_cast<Index>(stuck.size())), relative(W.cols(), size_);
    for (std::size_t i = 0; i < stuck.size(); ++i) {
      W.col(static_cast<Index>(i)) = contacts_[stuck[i]].w;
      relative.row(static_cast<Index>(i)) =
          contacts_[stuck[i]].w.transpose() * acceleration + contacts_[stuck[i]].support_rate;
    }
    const Eigen::FullPivLU<MatrixXd> G(W.transpose() * M_inverse_ * W);
    result.is_possible = G.isInvertible();
    const MatrixXd lambda = G.solve(relative);
    acceleration -= M_inverse_ * W * lambda;
    for (std::size_t i = 0; i < stuck.size(); ++i)
      result.lambda.row(static_cast<Index>(stuck[i])) = lambda.row(static_cast<Index>(i));
  }
  for (Index j = 0; j < m; ++j) {
    const Contact& contact = contacts_[static_cast<std::size_t>(j)];
    result.rate.row(j) = contact.w.transpose() * acceleration + contact.support_rate;
  }
  result.A.setZero(size_, size_);
  result.A.block(0, n_, n_, n_).setIdentity();
  result.A.middleRows(n_, n_) = acceleration;
  result.A.middleRows(2 * n_, internal_) = rates_;
  for (std::size_t j = 0; j < contacts_.size(); ++j)
    if (!holds(j) && modes.contact[j] != Mode::stuck) result.A.row(contacts_[j].internal).setZero();
  for (std::size_t k = 0; k < orders_.size(); ++k) {
    const Index place = 2 * n_ + internal_ + 2 * static_cast<Index>(k);
    result.A(place, place + 1) = -orders_[k] * omega_;
    result.A(place + 1, place) = orders_[k] * omega_;
  }
  add_ends(modes, result);
  return result;
}

const ExponentialIntegrator::Piece& ExponentialIntegrator::piece(const Modes& modes) {
  const auto known = pieces_.find(modes);
  return known != pieces_.end() ? known->second : pieces_.emplace(modes, make_piece(modes)).first->second;
}

// The forms that end the modes of a piece.
void ExponentialIntegrator::add_ends(const Modes& modes, Piece& piece) const {
  const auto most = static_cast<Index>(2 * (contacts_.size() + bends_.size()));
  piece.forms.setZero(most, size_);
  const auto add = [&](const End& end, const RowVectorXd& form) {
    piece.forms.row(static_cast<Index>(piece.ends.size())) = form;
    piece.ends.push_back(end);
  };
  for (std::size_t j = 0; j < contacts_.size(); ++j) {
    const Contact& contact = contacts_[j];
    if (modes.contact[j] != Mode::stuck) {
      add({j, 0}, (modes.contact[j] == Mode::forward ? 1.0 : -1.0) * contact.speed);
      continue;
    }
    RowVectorXd force = RowVectorXd::Zero(size_);
    if (holds(j))
      force = piece.lambda.row(static_cast<Index>(j));
    else
      force[contact.internal] = 1.0;
    for (const std::size_t which : {0U, 1U}) {
      RowVectorXd room = which == 0 ? RowVectorXd(-force) : force;
      room[size_ - 1] += contact.static_limit;
      add({j, which}, room);
    }
  }
  for (std::size_t b = 0; b < bends_.size(); ++b) {
    const std::size_t index = contacts_.size() + b;
    add({index, 0}, (modes.bend[b] == Side::before ? -1.0 : 1.0) * bends_[b].past);
    if (!bends_[b].jumps || modes.bend[b] == Side::before) continue;
    add({index, 1}, (modes.bend[b] == Side::free ? -1.0 : 1.0) * bends_[b].force);
  }
  piece.forms.conservativeResize(static_cast<Index>(piece.ends.size()), size_);
}

}  // namespace frahm::periodic
