#include "tests/known_answers/exponential_integrator.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>

namespace frahm::periodic {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::RowVectorXd, Eigen::VectorXd;
using mechanics::ElementType, mechanics::ExcitationKind, mechanics::NodeKind;

constexpr Index kMostTerms = 80;

// A polynomial over [0, 1] by its coefficients, from the constant on.
struct Polynomial {
  const double* c;
  Index count;

  double operator()(double t) const {
    double sum = 0.0;
    for (Index k = count - 1; k >= 0; --k) sum = sum * t + c[k];
    return sum;
  }
  double slope(double t) const {
    double sum = 0.0;
    for (Index k = count - 1; k >= 1; --k) sum = sum * t + static_cast<double>(k) * c[k];
    return sum;
  }
  // Bounds of |g'| and |g''| over [0, 1].
  double most_slope() const {
    double sum = 0.0;
    for (Index k = 1; k < count; ++k) sum += static_cast<double>(k) * std::abs(c[k]);
    return sum;
  }
  double most_bend() const {
    double sum = 0.0;
    for (Index k = 2; k < count; ++k) sum += static_cast<double>(k * (k - 1)) * std::abs(c[k]);
    return sum;
  }
};

// A root between a and b, where the signs differ: on the side of b.
double root_between(const Polynomial& g, double a, double b) {
  const bool falls = g(b) <= 0.0;
  for (double middle = 0.5 * (a + b); middle > a && middle < b; middle = 0.5 * (a + b))
    ((g(middle) <= 0.0) == falls ? b : a) = middle;
  return b;
}

// Visits, from left to right, intervals in which g has at most one root, until `visit` says true. Below
// `little` g is rounding.
template <class Visit>
bool isolate(const Polynomial& g, double bend, double little, double a, double b, const Visit& visit) {
  constexpr double kNarrow = 1e-9;  // a minimum so narrow only touches
  const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
  const double value = std::abs(g(middle)), slope = std::abs(g.slope(middle));
  const double change = slope * half + 0.5 * bend * half * half;
  if (value > change) return false;
  if (slope > bend * half || half < kNarrow || value + change < little) return visit(a, b);
  return isolate(g, bend, little, a, middle, visit) || isolate(g, bend, little, middle, b, visit);
}

// The first place in [0, 1] where g, positive at first, is not; or 2. A start within rounding of zero is left
// out: where g then grows, the mode has just begun.
double first_end(Polynomial g, double little) {
  for (int zeros = 0; zeros < 2 && g.count > 1 && std::abs(g.c[0]) <= little; ++zeros) {
    ++g.c;
    --g.count;
  }
  const double most_slope = g.most_slope();
  if (std::abs(g.c[0]) + most_slope <= little) return 2.0;
  if (g.c[0] <= 0.0) return 0.0;
  if (g.c[0] > most_slope) return 2.0;
  double found = 2.0;
  isolate(g, g.most_bend(), little, 0.0, 1.0, [&](double a, double b) {
    if (g(b) > 0.0) return false;
    found = root_between(g, a, b);
    return true;
  });
  return found;
}

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

// Of derivative 2 the supports' part alone: that of the masses is not a state.
RowVectorXd ExponentialIntegrator::motion(const mechanics::Element& element, int derivative) const {
  RowVectorXd form = RowVectorXd::Zero(size_);
  for (const auto& [node, factor] : element.along) {
    if (node.kind == NodeKind::mass && derivative < 2)
      form[derivative * n_ + static_cast<Index>(node.index)] += factor;
    if (node.kind == NodeKind::prescribed) form += factor * harmonic(node.index, derivative);
  }
  return form;
}

void ExponentialIntegrator::stamp(const mechanics::Network& network, const mechanics::NetworkValues& values) {
  M_ = Eigen::Map<const VectorXd>(values.mass.data(), n_).asDiagonal();
  force_.setZero(n_, size_);
  rates_.setZero(internal_, size_);
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

void ExponentialIntegrator::set_forcing_states() {
  for (std::size_t k = 0; k < orders_.size(); ++k) {
    const Index place = 2 * n_ + internal_ + 2 * static_cast<Index>(k);
    x_[place] = 1.0;
    x_[place + 1] = 0.0;
  }
  x_[size_ - 1] = 1.0;
}

void ExponentialIntegrator::start(const VectorXd& q, const VectorXd& v, const VectorXd& s) {
  constexpr double kAtRest = 1e-11, kAtLimit = 1e-12;  // relative
  x_.setZero();
  x_.head(n_) = q;
  x_.segment(n_, n_) = v;
  x_.segment(2 * n_, s.size()) = s;
  set_forcing_states();
  most_ = least_ = q;
  stuck_throughout = ~0U;
  modes_ = {std::vector<Mode>(contacts_.size(), Mode::stuck), std::vector<Side>(bends_.size(), Side::before)};
  zeros_.assign(contacts_.size() + bends_.size(), {0, 0});
  speed_scale_ = v.cwiseAbs().maxCoeff() + omega_ * q.cwiseAbs().maxCoeff() + 1e-3;
  typical_.setZero(size_);
  typical_.head(n_).setConstant(speed_scale_ / omega_);
  typical_.segment(n_, n_).setConstant(speed_scale_);
  for (std::size_t b = 0; b < bends_.size(); ++b) {
    if (bends_[b].past.dot(x_) <= 0.0) continue;
    modes_.bend[b] = bends_[b].jumps && bends_[b].force.dot(x_) <= 0.0 ? Side::free : Side::beyond;
  }
  std::vector<std::size_t> at_rest;
  for (std::size_t j = 0; j < contacts_.size(); ++j) {
    const Contact& contact = contacts_[j];
    const double speed = contact.speed.dot(x_);
    const Mode sliding = speed > 0.0 ? Mode::forward : Mode::backward;
    if (holds(j) && std::abs(speed) < kAtRest * speed_scale_)
      at_rest.push_back(j);
    else if (holds(j))
      modes_.contact[j] = sliding;
    else if (const double s_j = x_[contact.internal];
             std::abs(s_j) >= contact.limit * (1.0 - kAtLimit) && s_j * speed > 0.0)
      modes_.contact[j] = sliding;
  }
  choose(at_rest);
}

unsigned ExponentialIntegrator::coulomb_contacts() const {
  unsigned mask = 0;
  for (std::size_t j = 0; j < contacts_.size(); ++j)
    if (holds(j)) mask |= 1U << j;
  return mask;
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

void ExponentialIntegrator::pass_period() {
  set_forcing_states();
  for (int i = 0; i < steps_; ++i) advance(step_);
}

// Taylor's series of exp(A h) X, up to two terms in a row that are below rounding.
void ExponentialIntegrator::expand(double h) {
  constexpr double kBelowRounding = 1e-18;
  taylor_.resize(size_, kMostTerms);
  taylor_.col(0) = x_;
  const Index moving = 2 * n_ + internal_;  // the forcing's states are near one
  const double small = kBelowRounding * (x_.cwiseAbs() + typical_).head(moving).maxCoeff();
  int in_a_row = 0;
  for (terms_ = 1; terms_ < kMostTerms && in_a_row < 2; ++terms_) {
    const auto term = taylor_.col(terms_);
    taylor_.col(terms_).noalias() = now_->A * taylor_.col(terms_ - 1) * (h / static_cast<double>(terms_));
    const bool is_small = term.head(moving).cwiseAbs().maxCoeff() <= small &&
                          term.tail(size_ - moving).cwiseAbs().maxCoeff() <= kBelowRounding;
    in_a_row = is_small ? in_a_row + 1 : 0;
  }
  if (terms_ == kMostTerms) throw std::runtime_error("the reference's series has too many terms");
}

void ExponentialIntegrator::move(double part) {
  x_ = taylor_.col(terms_ - 1);
  for (Index k = terms_ - 2; k >= 0; --k) x_ = x_ * part + taylor_.col(k);
  x_[size_ - 1] = 1.0;
}

// The place in the step, in [0, 1], where the first mode ends, or 2; and which.
std::pair<double, ExponentialIntegrator::End> ExponentialIntegrator::first_of_ends() {
  constexpr double kRounding = 1e-14;
  std::pair<double, End> first{2.0, {}};
  guards_.noalias() = taylor_.leftCols(terms_).transpose() * now_->forms.transpose();
  for (std::size_t i = 0; i < now_->ends.size(); ++i) {
    const End& end = now_->ends[i];
    const auto column = static_cast<Index>(i);
    const auto zeros = static_cast<Index>(zeros_[end.index][end.which]);
    const Polynomial g{guards_.col(column).data() + zeros, terms_ - zeros};
    if (g.c[0] > g.most_slope() && g.c[0] > kRounding) continue;
    const double little =
        kRounding * now_->forms.row(column).cwiseAbs().dot((x_.cwiseAbs() + typical_).transpose());
    const double place = first_end(g, little);
    if (place < first.first) first = {place, end};
  }
  return first;
}

void ExponentialIntegrator::advance(double h) {
  constexpr int kMostEvents = 1000;  // of a step
  constexpr double kAtOnce = 1e-9;   // of a step: what grows from zero has not left it yet
  for (int events = 0; h > 0.0; ++events) {
    if (events > kMostEvents) throw std::runtime_error("the reference met too many events in a step");
    expand(h);
    const auto [first, at] = first_of_ends();
    const double part = std::min(first, 1.0);
    if (watches_extremes) note_extremes(part);
    move(part);
    if (part * h > kAtOnce * step_) std::ranges::fill(zeros_, std::array<int, 2>{0, 0});
    for (std::size_t j = 0; j < contacts_.size() && part * h > kAtOnce * step_; ++j)
      if (modes_.contact[j] != Mode::stuck) stuck_throughout &= ~(1U << j);
    if (first > 1.0) return;
    h *= 1.0 - part;
    ++events_;
    pass(at);
  }
}

void ExponentialIntegrator::note_extremes(double end) {
  for (Index i = 0; i < n_; ++i) {
    const RowVectorXd q = taylor_.row(i).head(terms_), v = taylor_.row(n_ + i).head(terms_);
    const Polynomial displacement{q.data(), terms_}, velocity{v.data(), terms_};
    const auto note = [&](double at) {
      most_[i] = std::max(most_[i], displacement(at));
      least_[i] = std::min(least_[i], displacement(at));
    };
    note(end);
    if (std::abs(v[0]) > velocity.most_slope()) continue;
    isolate(velocity, velocity.most_bend(), 1e-14 * speed_scale_, 0.0, end, [&](double a, double b) {
      if ((velocity(a) <= 0.0) != (velocity(b) <= 0.0)) note(root_between(velocity, a, b));
      return false;
    });
  }
}

void ExponentialIntegrator::pass(const End& end) {
  if (end.index < contacts_.size())
    pass_contact(end.index, end.which);
  else
    pass_bend(end.index - contacts_.size(), end.which);
}

void ExponentialIntegrator::pass_contact(std::size_t j, std::size_t which) {
  Contact& contact = contacts_[j];
  Mode& mode = modes_.contact[j];
  const Mode released = which == 0 ? Mode::forward : Mode::backward;
  if (!holds(j)) {
    const bool slid = mode != Mode::stuck;
    const bool forward = slid ? mode == Mode::forward : which == 0;
    x_[contact.internal] = forward ? contact.limit : -contact.limit;
    if (slid) zeros_[j][forward ? 0 : 1] = 2;  // s stays at its limit with u' = 0, and unloads
    mode = slid ? Mode::stuck : released;
    now_ = &piece(modes_);
    return;
  }
  if (mode == Mode::stuck) {
    const bool drops = contact.static_limit > contact.limit;
    mode = released;
    zeros_[j] = {drops ? 1 : 2, 0};  // u' grows like t where the force drops, else like t^2
    choose(drops ? stuck_contacts() : std::vector<std::size_t>{});
    return;
  }
  constexpr double kTogether = 1e-12;
  std::vector<std::size_t> at_rest = stuck_contacts(), just_released;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    if (!holds(k) || modes_.contact[k] == Mode::stuck) continue;
    const bool rests = std::abs(contacts_[k].speed.dot(x_)) < kTogether * speed_scale_;
    if (k == j || (rests && zeros_[k][0] == 0))
      at_rest.push_back(k);
    else if (rests)
      just_released.push_back(k);
  }
  choose(at_rest);
  // The reversal of one may press another, released at the same instant, back to rest.
  if (is_consistent(just_released, modes_)) return;
  at_rest.insert(at_rest.end(), just_released.begin(), just_released.end());
  choose(at_rest);
}

void ExponentialIntegrator::pass_bend(std::size_t b, std::size_t which) {
  Side& side = modes_.bend[b];
  const Bend& bend = bends_[b];
  if (which == 0)
    side = side == Side::before ? Side::beyond : Side::before;
  else
    side = side == Side::free ? Side::beyond : Side::free;
  zeros_[contacts_.size() + b] = {0, 0};
  zeros_[contacts_.size() + b][which] = 1;
  choose(bend.jumps ? stuck_contacts() : std::vector<std::size_t>{});
}

std::vector<std::size_t> ExponentialIntegrator::stuck_contacts() const {
  std::vector<std::size_t> stuck;
  for (std::size_t j = 0; j < contacts_.size(); ++j)
    if (holds(j) && modes_.contact[j] == Mode::stuck) stuck.push_back(j);
  return stuck;
}

bool ExponentialIntegrator::is_consistent(const std::vector<std::size_t>& at_rest, const Modes& modes) {
  constexpr double kTie = 1e-11;  // relative: ties go to stick
  const Piece& result = piece(modes);
  if (!result.is_possible) return false;
  for (const std::size_t j : at_rest) {
    const Contact& contact = contacts_[j];
    const auto row = static_cast<Index>(j);
    const double rate = result.rate.row(row).dot(x_);
    const double little = kTie * contact.limit * contact.w.dot(M_inverse_ * contact.w);
    if (modes.contact[j] == Mode::stuck) {
      if (std::abs(result.lambda.row(row).dot(x_)) > contact.static_limit * (1.0 + kTie)) return false;
    } else if ((modes.contact[j] == Mode::forward ? rate : -rate) < -little) {
      return false;
    }
  }
  return true;
}

// Of all consistent modes of the contacts at rest, those with most of them stuck.
void ExponentialIntegrator::choose(const std::vector<std::size_t>& at_rest) {
  int combinations = 1, best = -1;
  for (std::size_t i = 0; i < at_rest.size(); ++i) combinations *= 3;
  Modes chosen = modes_;
  for (int code = 0; code < combinations && !at_rest.empty(); ++code) {
    Modes modes = modes_;
    int stuck = 0, rest = code;
    for (const std::size_t j : at_rest) {
      modes.contact[j] = static_cast<Mode>(rest % 3);
      stuck += rest % 3 == 0;
      rest /= 3;
    }
    if (stuck <= best || !is_consistent(at_rest, modes)) continue;
    best = stuck;
    chosen = modes;
  }
  if (best < 0 && !at_rest.empty()) throw std::logic_error("the reference found no consistent modes");
  modes_ = chosen;
  for (const std::size_t j : at_rest) zeros_[j] = {modes_.contact[j] == Mode::stuck ? 0 : 1, 0};
  now_ = &piece(modes_);
  if (!at_rest.empty()) bring_to_rest();
}

// Velocities of stuck contacts, which are zero but for rounding, are taken out by the least change of energy.
void ExponentialIntegrator::bring_to_rest() {
  const std::vector<std::size_t> stuck = stuck_contacts();
  if (stuck.empty()) return;
  const auto count = static_cast<Index>(stuck.size());
  MatrixXd W(n_, count);
  VectorXd speed(count);
  for (Index i = 0; i < count; ++i) {
    W.col(i) = contacts_[stuck[static_cast<std::size_t>(i)]].w;
    speed[i] = contacts_[stuck[static_cast<std::size_t>(i)]].speed.dot(x_);
  }
  x_.segment(n_, n_) -= M_inverse_ * W * (W.transpose() * M_inverse_ * W).ldlt().solve(speed);
}

}  // namespace frahm::periodic
