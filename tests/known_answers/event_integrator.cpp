#include "tests/known_answers/event_integrator.hpp"

#include <algorithm>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>
#include <complex>
#include <stdexcept>

#include "solvers/algebra/eigenvalues.hpp"

namespace frahm::periodic {
namespace {

using Eigen::Index, Eigen::VectorXd;
constexpr double kStepAngle = 0.06;  // fastest rate times step: the eighth-order error is then below rounding

Eigen::Map<const VectorXd> head(const std::vector<double>& x, Index n) {
  return {x.data(), n};
}
Eigen::Map<const VectorXd> velocity(const std::vector<double>& x, Index n) {
  return {x.data() + n, n};
}
Eigen::Map<const VectorXd> maxwell(const std::vector<double>& x, Index n) {
  return {x.data() + 2 * n, static_cast<Index>(x.size()) - 2 * n};
}

// Re sum_k amplitude_k (i order_k omega)^derivative e^{i order_k omega t}
VectorXd harmonic(const mechanics::LinearSystem& s, const Eigen::MatrixXcd& amplitude, double t,
                  int derivative) {
  VectorXd result = VectorXd::Zero(amplitude.rows());
  for (std::size_t k = 0; k < s.orders.size(); ++k) {
    const std::complex<double> rate(0.0, s.orders[k] * s.omega);
    result += (amplitude.col(static_cast<Index>(k)) * std::pow(rate, derivative) * std::exp(rate * t)).real();
  }
  return result;
}

// The root of a function that is positive at `lo` and not at `hi`.
template <class Function>
double bisect(double lo, double hi, const Function& function) {
  for (double middle = 0.5 * (lo + hi); middle > lo && middle < hi; middle = 0.5 * (lo + hi)) {
    (function(middle) > 0.0 ? lo : hi) = middle;
  }
  return hi;
}

}  // namespace

EventIntegrator::EventIntegrator(const mechanics::LinearSystem& system)
    : system_(system), M_inverse_(system.M.inverse()) {
  const mechanics::Bends& bends = system.bends;
  const Eigen::MatrixXd K =
      system.K + bends.W * bends.stiffness.cwiseAbs().asDiagonal() * bends.W.transpose();
  const Eigen::MatrixXd C = system.C + bends.W * bends.damping.cwiseAbs().asDiagonal() * bends.W.transpose();
  const double stiff = algebra::eigenvalues(M_inverse_ * K).cwiseAbs().maxCoeff();
  const double viscous = algebra::eigenvalues(M_inverse_ * C).cwiseAbs().maxCoeff();
  double maxwell = 0.0;
  if (system.internal_forces() > 0) {
    const Eigen::MatrixXd springs = system.D * system.internal_stiffness.asDiagonal() * system.D.transpose();
    maxwell = system.internal_rate.maxCoeff() +
              std::sqrt(algebra::eigenvalues(M_inverse_ * springs).cwiseAbs().maxCoeff());
  }
  step_ = kStepAngle / std::max({std::sqrt(stiff), viscous, maxwell, system.orders.back() * system.omega});
}

void EventIntegrator::start(double t, const VectorXd& q, const VectorXd& v, const VectorXd& s) {
  t_ = t;
  state_.assign(q.data(), q.data() + q.size());
  state_.insert(state_.end(), v.data(), v.data() + v.size());
  state_.insert(state_.end(), s.data(), s.data() + s.size());
  state_.resize(static_cast<std::size_t>(2 * system_.masses() + system_.internal_forces()), 0.0);
  most_ = least_ = q;
  events_ = 0;
  modes_.assign(static_cast<std::size_t>(system_.contacts()), Mode::stuck);
  fresh_.assign(modes_.size() + static_cast<std::size_t>(system_.bends.count()), false);
  beyond_.assign(static_cast<std::size_t>(system_.bends.count()), false);
  for (Index j = 0; j < system_.bends.count(); ++j)
    beyond_[static_cast<std::size_t>(j)] = bend_room(state_, t, j) > 0.0;
  const VectorXd static_q = system_.K.llt().solve(system_.force.cwiseAbs().rowwise().sum());
  speed_scale_ =
      v.cwiseAbs().maxCoeff() + system_.omega * (static_q.norm() + system_.motion.norm()) + recorded_.speed;
  std::vector<Index> at_rest;
  for (Index j = 0; j < system_.contacts(); ++j) {
    const double speed = relative_velocity(state_, t, j);
    if (slides_by_state(j)) {
      const double force =
          maxwell(state_, system_.masses())[system_.contact_internal[static_cast<std::size_t>(j)]];
      const bool slides = std::abs(force) >= system_.limit[j] * (1.0 - 1e-12) && force * speed > 0.0;
      if (slides) modes_[static_cast<std::size_t>(j)] = force > 0.0 ? Mode::forward : Mode::backward;
    } else if (std::abs(speed) < 1e-11 * speed_scale_)
      at_rest.push_back(j);
    else
      modes_[static_cast<std::size_t>(j)] = speed > 0.0 ? Mode::forward : Mode::backward;
  }
  choose(at_rest);
}

VectorXd EventIntegrator::support(double t, int derivative) const {
  VectorXd y = harmonic(system_, system_.motion, t, derivative);
  if (derivative == 0) y += system_.constant_motion;
  if (derivative == 1) y += system_.belt_velocity;
  if (recorded_.motion) y += recorded_.motion(t, derivative);
  return y;
}

VectorXd EventIntegrator::forcing(double t) const {
  VectorXd force = system_.constant_force + harmonic(system_, system_.force, t, 0);
  if (recorded_.force) force += recorded_.force(t);
  if (recorded_.motion)
    force -= system_.K_support * recorded_.motion(t, 0) + system_.C_support * recorded_.motion(t, 1) +
             system_.M_support * recorded_.motion(t, 2);
  return force;
}

EventIntegrator::Motion EventIntegrator::motion(const State& x, double t,
                                                const std::vector<Mode>& modes) const {
  const Index n = system_.masses(), m = system_.contacts();
  Motion result{VectorXd::Zero(n), VectorXd::Zero(m)};
  std::vector<Index> stuck;
  for (Index j = 0; j < m; ++j) {
    const Mode mode = modes[static_cast<std::size_t>(j)];
    if (slides_by_state(j)) continue;
    if (mode == Mode::stuck)
      stuck.push_back(j);
    else
      result.friction[j] = mode == Mode::forward ? system_.limit[j] : -system_.limit[j];
  }
  VectorXd force =
      forcing(t) - system_.K * head(x, n) - system_.C * velocity(x, n) - system_.D * maxwell(x, n);
  for (Index j = 0; j < system_.bends.count(); ++j) {
    if (beyond_[static_cast<std::size_t>(j)]) force -= bend_force(x, t, j) * system_.bends.W.col(j);
  }
  result.acceleration = M_inverse_ * (force - system_.W * result.friction);
  if (stuck.empty()) return result;
  // W_S^T (a - M^-1 W_S lambda) = - p_S^T y''
  const Eigen::MatrixXd W = system_.W(Eigen::all, stuck);
  VectorXd relative(static_cast<Index>(stuck.size()));
  for (std::size_t i = 0; i < stuck.size(); ++i) {
    relative[static_cast<Index>(i)] = relative_acceleration(result.acceleration, t, stuck[i]);
  }
  const Eigen::MatrixXd G = W.transpose() * M_inverse_ * W;
  const VectorXd lambda = G.completeOrthogonalDecomposition().solve(relative);
  result.acceleration -= M_inverse_ * W * lambda;
  for (std::size_t i = 0; i < stuck.size(); ++i) result.friction[stuck[i]] = lambda[static_cast<Index>(i)];
  return result;
}

double EventIntegrator::relative_velocity(const State& x, double t, Index j) const {
  double speed = system_.W.col(j).dot(velocity(x, system_.masses()));
  if (system_.motion.rows() > 0) speed += system_.W_support.col(j).dot(support(t, 1));
  return speed;
}

double EventIntegrator::relative_acceleration(const VectorXd& a, double t, Index j) const {
  double relative = system_.W.col(j).dot(a);
  if (system_.motion.rows() > 0) relative += system_.W_support.col(j).dot(support(t, 2));
  return relative;
}

double EventIntegrator::bend_force(const State& x, double t, Index j) const {
  const mechanics::Bends& bends = system_.bends;
  const Index n = system_.masses();
  double u = bends.W.col(j).dot(head(x, n)), v = bends.W.col(j).dot(velocity(x, n));
  if (system_.motion.rows() > 0) {
    u += bends.W_support.col(j).dot(support(t, 0));
    v += bends.W_support.col(j).dot(support(t, 1));
  }
  if (bends.law[static_cast<std::size_t>(j)]->of_velocity) return bends.damping[j] * (v - bends.place[j]);
  return bends.stiffness[j] * (u - bends.place[j]) + bends.damping[j] * v;
}

double EventIntegrator::bend_room(const State& x, double t, Index j) const {
  const mechanics::Bends& bends = system_.bends;
  const Index n = system_.masses();
  const laws::Bend& law = *bends.law[static_cast<std::size_t>(j)];
  const bool has_support = system_.motion.rows() > 0;
  if (law.of_velocity) {
    double v = bends.W.col(j).dot(velocity(x, n));
    if (has_support) v += bends.W_support.col(j).dot(support(t, 1));
    return v - bends.place[j];
  }
  double u = bends.W.col(j).dot(head(x, n));
  if (has_support) u += bends.W_support.col(j).dot(support(t, 0));
  const double past = u - bends.place[j];
  return law.pulls || bends.damping[j] == 0.0 ? past : std::min(past, bend_force(x, t, j));
}

double EventIntegrator::margin(const State& x, double t, Index j) const {
  if (j >= system_.contacts()) {
    const Index bend = j - system_.contacts();
    const double room = bend_room(x, t, bend);
    return beyond_[static_cast<std::size_t>(bend)] ? room : -room;
  }
  if (slides_by_state(j) && modes_[static_cast<std::size_t>(j)] == Mode::stuck) {
    const Index place = system_.contact_internal[static_cast<std::size_t>(j)];
    return system_.limit[j] * (1.0 + 1e-12) - std::abs(maxwell(x, system_.masses())[place]);
  }
  switch (modes_[static_cast<std::size_t>(j)]) {
    case Mode::forward:
      return relative_velocity(x, t, j);
    case Mode::backward:
      return -relative_velocity(x, t, j);
    case Mode::stuck:
      break;
  }
  return system_.static_limit[j] * (1.0 + 1e-12) - std::abs(motion(x, t, modes_).friction[j]);
}

EventIntegrator::State EventIntegrator::moved(double t, double h) const {
  boost::numeric::odeint::runge_kutta_fehlberg78<State> stepper;
  const Index n = system_.masses();
  State x = state_;
  const auto rate = [&](const State& y, State& dy, double at) {
    const VectorXd a = motion(y, at, modes_).acceleration;
    std::copy_n(y.data() + n, n, dy.data());
    std::copy_n(a.data(), n, dy.data() + n);
    // s' = k (d^T q' + p^T y') - s k / c
    VectorXd strain_rate = system_.D.transpose() * velocity(y, n);
    if (system_.motion.rows() > 0) {
      strain_rate += system_.D_support.transpose() * support(at, 1);
    }
    for (Index e = 0; e < system_.internal_forces(); ++e) {
      const auto place = static_cast<std::size_t>(2 * n + e);
      dy[place] = system_.internal_stiffness[e] * strain_rate[e] - system_.internal_rate[e] * y[place];
    }
    for (Index j = 0; j < system_.contacts(); ++j) {
      const bool slides = slides_by_state(j) && modes_[static_cast<std::size_t>(j)] != Mode::stuck;
      if (slides)
        dy[static_cast<std::size_t>(2 * n + system_.contact_internal[static_cast<std::size_t>(j)])] = 0.0;
    }
  };
  stepper.do_step(rate, x, t, h);
  return x;
}

// The time after t_ at which the contact's mode ends, or infinity.
double EventIntegrator::first_end_of_mode(double h, Index j) const {
  const auto at = [&](double elapsed) { return margin(moved(t_, elapsed), t_ + elapsed, j); };
  const double little = 1e-3 * h;
  double lo = fresh_[static_cast<std::size_t>(j)] ? 0.02 * h : 0.0;
  const double left = at(lo), right = at(h);
  if (fresh_[static_cast<std::size_t>(j)] && left <= 0.0)
    return lo;  // a micro-slip shorter than the search resolves
  if (right <= 0.0) return bisect(lo, h, at);
  if (at(lo + little) >= left || at(h - little) >= right) return HUGE_VAL;
  double hi = h;  // both ends positive, falling inwards: look for a minimum below zero
  constexpr double kGolden = 0.6180339887498949;
  while (hi - lo > 1e-7 * h) {
    const double c = hi - kGolden * (hi - lo), d = lo + kGolden * (hi - lo), at_c = at(c), at_d = at(d);
    if (at_c <= 0.0) return bisect(lo, c, at);
    if (at_d <= 0.0) return bisect(lo, d, at);
    (at_c < at_d ? hi : lo) = at_c < at_d ? d : c;
  }
  return HUGE_VAL;
}

bool EventIntegrator::is_consistent(const std::vector<Index>& at_rest, const std::vector<Mode>& modes) const {
  const Motion result = motion(state_, t_, modes);
  for (const Index j : at_rest) {
    const double scale =
        std::max(1e-300, (system_.W.transpose() * M_inverse_ * system_.W)(j, j) * system_.limit[j]);
    const double relative = relative_acceleration(result.acceleration, t_, j);
    switch (modes[static_cast<std::size_t>(j)]) {
      case Mode::stuck:
        if (std::abs(result.friction[j]) > system_.static_limit[j] * (1.0 + 1e-11)) return false;
        if (std::abs(relative) > 1e-9 * scale) return false;  // two constraints that contradict each other
        break;
      case Mode::forward:
        if (relative < -1e-11 * scale) return false;
        break;
      case Mode::backward:
        if (relative > 1e-11 * scale) return false;
        break;
    }
  }
  return true;
}

// For all consistent modes of the contacts at rest, those with most of them stuck.
void EventIntegrator::choose(const std::vector<Index>& at_rest) {
  if (at_rest.empty()) return;
  int best = -1;
  std::vector<Mode> chosen;
  const auto count = static_cast<int>(std::lround(std::pow(3.0, static_cast<double>(at_rest.size()))));
  for (int code = 0; code < count; ++code) {
    std::vector<Mode> modes = modes_;
    int stuck = 0, rest = code;
    for (const Index j : at_rest) {
      modes[static_cast<std::size_t>(j)] = static_cast<Mode>(rest % 3);
      stuck += rest % 3 == 0;
      rest /= 3;
    }
    if (stuck > best && is_consistent(at_rest, modes)) {
      best = stuck;
      chosen = modes;
    }
  }
  if (best < 0) throw std::logic_error("the reference found no consistent modes");
  modes_ = chosen;
  for (const Index j : at_rest)
    fresh_[static_cast<std::size_t>(j)] = modes_[static_cast<std::size_t>(j)] != Mode::stuck;
}

void EventIntegrator::pass_event(Index j) {
  constexpr int kMostEvents = 10000;
  if (++events_ > kMostEvents) throw std::runtime_error("the reference met more than 10000 events");
  if (j >= system_.contacts()) return pass_bend(j - system_.contacts());
  const auto place = static_cast<std::size_t>(j);
  std::vector<Index> at_rest;
  if (slides_by_state(j)) {
    const double force = maxwell(state_, system_.masses())[system_.contact_internal[place]];
    const bool sticks = modes_[place] == Mode::stuck;
    modes_[place] = !sticks ? Mode::stuck : force > 0.0 ? Mode::forward : Mode::backward;
    const auto state = static_cast<std::size_t>(2 * system_.masses() + system_.contact_internal[place]);
    if (sticks) state_[state] = force > 0.0 ? system_.limit[j] : -system_.limit[j];
    fresh_[place] = true;
    return;
  }
  if (modes_[place] == Mode::stuck) {
    modes_[place] = motion(state_, t_, modes_).friction[j] > 0.0 ? Mode::forward : Mode::backward;
    fresh_[place] = true;
    if (system_.static_limit[j] > system_.limit[j]) choose(stuck_contacts());
    return;
  }
  for (Index k = 0; k < system_.contacts(); ++k) {
    if (slides_by_state(k)) continue;
    const bool arrives = k == j || std::abs(relative_velocity(state_, t_, k)) < 1e-12 * speed_scale_;
    if ((arrives && !fresh_[static_cast<std::size_t>(k)]) ||
        modes_[static_cast<std::size_t>(k)] == Mode::stuck) {
      at_rest.push_back(k);
    }
  }
  fresh_[place] = false;
  if (std::find(at_rest.begin(), at_rest.end(), j) == at_rest.end()) at_rest.push_back(j);
  choose(at_rest);
}

std::vector<Index> EventIntegrator::stuck_contacts() const {
  std::vector<Index> stuck;
  for (Index j = 0; j < system_.contacts(); ++j) {
    if (modes_[static_cast<std::size_t>(j)] == Mode::stuck && !slides_by_state(j)) stuck.push_back(j);
  }
  return stuck;
}

// Where its force jumps, contacts at rest are chosen again.
void EventIntegrator::pass_bend(Index bend) {
  const auto place = static_cast<std::size_t>(bend);
  beyond_[place] = !beyond_[place];
  fresh_[modes_.size() + place] = true;
  if (system_.bends.damping[bend] != 0.0 && !system_.bends.law[place]->of_velocity) choose(stuck_contacts());
}

void EventIntegrator::note_extremes(double h) {
  const Index n = system_.masses();
  const State end = moved(t_, h);
  for (Index i = 0; i < n; ++i) {
    const auto velocity = [&](double elapsed) { return moved(t_, elapsed)[static_cast<std::size_t>(n + i)]; };
    double value = end[static_cast<std::size_t>(i)];
    most_[i] = std::max(most_[i], value);
    least_[i] = std::min(least_[i], value);
    const double before = state_[static_cast<std::size_t>(n + i)],
                 after = end[static_cast<std::size_t>(n + i)];
    if (before * after >= 0.0) continue;
    const double side = before > 0.0 ? 1.0 : -1.0;
    value = moved(t_, bisect(0.0, h, [&](double elapsed) {
                    return side * velocity(elapsed);
                  }))[static_cast<std::size_t>(i)];
    most_[i] = std::max(most_[i], value);
    least_[i] = std::min(least_[i], value);
  }
}

void EventIntegrator::advance_to(double t_end) {
  while (t_ < t_end) {
    double h = std::min(step_, t_end - t_);
    if (h < 1e-9 * step_) break;
    Index first = -1;
    for (Index j = 0; j < system_.contacts() + system_.bends.count(); ++j) {
      const double at = first_end_of_mode(h, j);
      if (at > h) continue;
      h = at;
      first = j;
    }
    note_extremes(h);
    state_ = moved(t_, h);
    t_ += h;
    std::fill(fresh_.begin(), fresh_.end(), false);
    if (first >= 0) pass_event(first);
  }
}

VectorXd EventIntegrator::displacements() const {
  return head(state_, system_.masses());
}
VectorXd EventIntegrator::maxwell_forces() const {
  return maxwell(state_, system_.masses());
}
VectorXd EventIntegrator::velocities() const {
  return velocity(state_, system_.masses());
}

}  // namespace frahm::periodic
