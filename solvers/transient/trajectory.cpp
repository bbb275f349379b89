#include "solvers/transient/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "solvers/algebra/no_value.hpp"
#include "solvers/algebra/null_space.hpp"
#include "solvers/algebra/solve.hpp"
#include "solvers/mechanics/coordinates.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/transient/step_limits.hpp"

namespace frahm::transient {
namespace {

using Eigen::Index;
using periodic::bit, periodic::contains, periodic::ContactMask;

constexpr double kNever = kNone;

void check_initial(double value, const char* what) {
  const double size = std::abs(value);
  if (std::isfinite(value) && (size == 0.0 || (size >= kSmallestInitial && size <= kLargestInitial))) return;
  std::ostringstream message;
  message << "an initial " << what << " is " << value << "; must be 0 or of a size from " << kSmallestInitial
          << " to " << kLargestInitial;
  throw mechanics::MechanicsError(message.str());
}

// Accelerations at fraction s of a step: the slopes of the velocities' polynomials [m a step^2].
template <class StatePolynomials>
Eigen::VectorXd acceleration_in(const StatePolynomials& z, Index masses, double s) {
  Eigen::VectorXd acceleration(masses);
  const periodic::Polynomial powers = periodic::powers(s);
  for (Index i = 0; i < masses; ++i)
    acceleration[i] = periodic::derivative(periodic::Polynomial(z.col(masses + i))).dot(powers);
  return acceleration;
}

}  // namespace

std::vector<double> sample_times(double duration, int count) {
  std::vector<double> times;
  for (int i = 0; i < count; ++i) times.push_back(count > 1 ? duration * i / (count - 1) : 0.0);
  return times;
}

Trajectory::Trajectory(const mechanics::Assembly& assembly, std::vector<double> times, Watch watch)
    : assembly_(assembly),
      walk_(flow_),
      steps_(flow_),
      account_(assembly, flow_),
      held_since_(kNever),
      forms_(assembly, flow_),
      signals_(mechanics::signal_incidences(assembly.network())),
      turning_points_(mechanics::coordinate_count(assembly.network())),
      stops_(assembly.contacts()),
      watch_(std::move(watch)) {
  samples_.time = std::move(times);
  samples_.displacement.resize(turning_points_.size());
  samples_.velocity.resize(turning_points_.size());
  samples_.acceleration.resize(turning_points_.size());
  samples_.dissipated.resize(account_.dissipated().size());
}

void Trajectory::set_system(const mechanics::LinearSystem& system, double phase) {
  const double energy = has_started() ? energy_now() : 0.0;
  flow_.set_system(system);
  take_forcing(system, phase, energy);
}

void Trajectory::set_forcing(const mechanics::LinearSystem& system, double phase) {
  take_forcing(system, phase, has_started() ? energy_now() : 0.0);
}

void Trajectory::take_forcing(const mechanics::LinearSystem& system, double phase, double energy_before) {
  const double old_step = flow_.equations().step;
  flow_.set_forcing(system);
  account_.set_system(system);
  forcing_omega_ = system.omega;
  set_frequency(system.omega, 0.0);
  phase_ = phase;
  if (!has_started()) return;
  carry_over(old_step);
  account_.put_in(energy_now() - energy_before);
}

void Trajectory::set_frequency(double omega, double alpha) {
  omega_ = omega;
  alpha_ = alpha;
  omega_since_ = time_;
}

void Trajectory::carry_over(double old_step) {
  const Index n = flow_.equations().masses();
  z_.segment(n, n) *= flow_.equations().step / old_step;
  if (stuck_ != 0) z_ = flow_.brought_to_rest(z_, phase_, stuck_);
}

void Trajectory::start(const InitialState& initial) {
  const periodic::StepEquations<Eigen::Dynamic, Eigen::Dynamic>& eq = flow_.equations();
  const Index n = eq.masses();
  z_.setZero(eq.states());
  const auto set = [&](const std::vector<double>& values, Index at, double factor, const char* what) {
    if (values.empty()) return;
    if (static_cast<Index>(values.size()) != n)
      throw mechanics::MechanicsError(std::string("an initial ") + what + " must be given for each mass");
    for (Index i = 0; i < n; ++i) {
      const double value = values[static_cast<std::size_t>(i)];
      check_initial(value, what);
      z_[at + i] = factor * value;
    }
  };
  set(initial.displacement, 0, 1.0, "displacement");
  set(initial.velocity, n, eq.step, "velocity");
  deceleration_.setZero(eq.contacts());
  acceleration_.setZero(n);
  for (std::size_t i = 0; i < turning_points_.size(); ++i) first_displacements_.push_back(displacement(i));
  account_.open(energy_now());
}

bool Trajectory::advance(double duration, double phase) {
  const double length = duration / flow_.equations().step, start = time_;
  if (!can_last(duration)) return false;
  for (double done = 0.0; done < length && failure_ == nullptr;) {
    if (watch_) watch_();
    const double part = std::min(length - done, kStepsAtOnce);
    if (!pass(part, phase + done * flow_.fundamental_rate())) return false;
    done += part;
    time_ = start + done * flow_.equations().step;
  }
  if (failure_ == nullptr) time_ = start + duration;
  return failure_ == nullptr;
}

bool Trajectory::can_last(double duration) {
  if (failure_ == nullptr && steps_taken_ + duration / flow_.equations().step > kMostSteps) {
    failure_ = kTooManySteps;
  }
  return failure_ == nullptr;
}

bool Trajectory::pass(double length, double phase) {
  stretch_.section = phase;
  walk_.pass(z_, phase, length, stretch_.passage, periodic::Tangent::none);
  steps_taken_ += length;
  failure_ = stretch_.passage.failure;
  if (failure_ != nullptr) return false;
  energy_scale_ = flow_.energy_scale(z_);
  steps_.lay_out(stretch_);
  for (Step& step : steps_.steps()) follow(step);
  z_ = stretch_.passage.end;
  phase_ = phase + length * flow_.fundamental_rate();
  return true;
}

void Trajectory::follow(Step& step) {
  const auto& eq = flow_.equations();
  const Index n = eq.masses();
  const double at = time_ + step.start * eq.step;
  const auto& mode = flow_.mode(step.mode);
  note_mode(mode, at, step.left.z);
  const auto& x = steps_.expand(step);
  for (Index i = 0; i < n; ++i) {
    turning_points_[static_cast<std::size_t>(i)].follow(
        {.start = at,
         .step = eq.step,
         .length = step.length,
         .displacement = x.z.col(i),
         .velocity = x.z.col(n + i),
         .speed_scale = std::sqrt(2.0 * eq.M_inverse(i, i)) * energy_scale_});
  }
  follow_signals(step, at);
  keep_samples(step, at);
  account_.follow(mode, x, step.length);
  for (Index j = 0; j < eq.contacts(); ++j) {
    if (!contains(mode.stuck, j)) deceleration_[j] = std::abs(flow_.sliding_speed(step.right, j).slope);
  }
}

// Against the speed of a signal's masses at the motion's energy, and of its supports.
void Trajectory::follow_signals(const Step& step, double at) {
  const auto& eq = flow_.equations();
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    const auto& [w, p] = signals_[i];
    const double of_masses = std::sqrt(2.0 * w.dot(eq.M_inverse * w)) * energy_scale_;
    const double of_supports = p.cwiseAbs().dot(eq.motion_velocity.cwiseAbs().rowwise().sum());
    turning_points_[static_cast<std::size_t>(eq.masses()) + i].follow(
        {.start = at,
         .step = eq.step,
         .length = step.length,
         .displacement = forms_.displacement(signals_[i]).polynomial(step.expansion),
         .velocity = eq.step * forms_.velocity(signals_[i]).polynomial(step.expansion),
         .speed_scale = of_masses + of_supports});
  }
}

// The contacts that stick from here on, and those that no longer do.
void Trajectory::note_mode(const periodic::Mode<Eigen::Dynamic, Eigen::Dynamic>& mode, double at,
                           const State& z) {
  const bool same_contacts = has_mode_ && mode.stuck == stuck_ && mode.positive == positive_;
  if (same_contacts && mode.beyond == beyond_) return;
  const auto& eq = flow_.equations();
  const State creeps_to = has_mode_ ? resting_state(z) : z;
  const ContactMask stopped = mode.stuck & ~stuck_, released = stuck_ & ~mode.stuck;
  for (Index j = 0; j < eq.contacts(); ++j) {
    auto& stops = stops_[static_cast<std::size_t>(j)];
    if (contains(released, j)) stops.back().release = at;
    if (!contains(stopped, j)) continue;
    stops.push_back({at, kNever});
    const double scale = periodic::kStepRate * std::sqrt(2.0 * eq.compliance[j]) * energy_scale_;
    if (has_mode_ && deceleration_[j] <= kCreeping * scale) {
      crept_ = true;
      creeps_to_ = creeps_to;
    }
  }
  if (released != 0) crept_ = false;
  const bool same_stuck = has_mode_ && mode.stuck == stuck_;
  stuck_ = mode.stuck;
  positive_ = mode.positive;
  beyond_ = mode.beyond;
  has_mode_ = true;
  if (same_stuck) return;
  find_free_directions();
  const bool held = free_directions_.cols() == 0;
  if (!held || std::isnan(held_since_)) held_since_ = held ? at : kNever;
}

// The directions in which the masses move while the contacts that are held stick.
void Trajectory::find_free_directions() {
  const auto& eq = flow_.equations();
  std::vector<Index> held;
  for (Index j = 0; j < eq.contacts(); ++j) {
    if (contains(stuck_ & eq.holding, j)) held.push_back(j);
  }
  free_directions_ = algebra::null_space(eq.W(Eigen::all, held).transpose());
}

void Trajectory::keep_samples(Step& step, double at) {
  const double h = flow_.equations().step, end = at + step.length * h;
  const auto& expansion = steps_.expand(step);
  for (; next_sample_ < samples_.time.size() && samples_.time[next_sample_] < end; ++next_sample_) {
    const double s = std::max(0.0, (samples_.time[next_sample_] - at) / h);
    State z;
    Flow::evaluate(expansion, s, z);
    const Oscillators u = expansion.u.transpose() * periodic::powers(s);
    keep_state(z, acceleration_in(expansion.z, flow_.equations().masses(), s), u,
               account_.dissipated_within(flow_.mode(step.mode), expansion, s));
  }
  if (!samples_.time.empty())
    acceleration_ = acceleration_in(expansion.z, flow_.equations().masses(), step.length);
}

void Trajectory::keep_state(const State& z, const Eigen::VectorXd& acceleration, const Oscillators& u,
                            const std::vector<double>& dissipated) {
  const Index n = flow_.equations().masses();
  const double h = flow_.equations().step;
  for (Index i = 0; i < n; ++i) {
    const auto mass = static_cast<std::size_t>(i);
    samples_.displacement[mass].push_back(z[i]);
    samples_.velocity[mass].push_back(z[n + i] / h);
    samples_.acceleration[mass].push_back(acceleration[i] / (h * h));
  }
  keep_signals(z, acceleration, u);
  for (std::size_t e = 0; e < dissipated.size(); ++e) {
    const auto& elements = assembly_.network().elements;
    if (e == elements.size() || mechanics::kind_of(elements[e]).dissipates)
      samples_.dissipated[e].push_back(dissipated[e]);
  }
}

// w^T q + p^T y at the next sample. In a run-up, while the forcing has one frequency omega_f,
//   y' = i k omega Y_k e^{i k phi},  y'' = (i k alpha - (k omega)^2) Y_k e^{i k phi}
// with the true omega are omega/omega_f and (omega/omega_f)^2 times the forcing's, and alpha/omega_f y' more.
void Trajectory::keep_signals(const State& z, const Eigen::VectorXd& acceleration, const Oscillators& u) {
  const auto& eq = flow_.equations();
  const Index n = eq.masses();
  const double h = eq.step;
  const double omega = omega_ + alpha_ * (samples_.time[next_sample_] - omega_since_);
  const double faster = omega / forcing_omega_;
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    const auto& [w, p] = signals_[i];
    const std::size_t place = static_cast<std::size_t>(n) + i;
    const double speed = p.dot(eq.motion_velocity * u) / h;  // of the forcing's support
    const double rise = p.dot(eq.motion_acceleration * u) / (h * h);
    samples_.displacement[place].push_back(w.dot(z.head(n)) + p.dot(eq.motion * u));
    samples_.velocity[place].push_back(w.dot(z.segment(n, n)) / h + faster * speed);
    samples_.acceleration[place].push_back(w.dot(acceleration) / (h * h) + faster * faster * rise +
                                           alpha_ / forcing_omega_ * speed);
  }
}

Trajectory::Oscillators Trajectory::oscillators_now() const {
  Oscillators u(flow_.equations().oscillators());
  flow_.equations().oscillators_at(phase_, flow_.orders(), u);
  return u;
}

double Trajectory::displacement(std::size_t coordinate) const {
  const auto& eq = flow_.equations();
  const Index n = eq.masses(), place = static_cast<Index>(coordinate);
  if (place < n) return z_[place];
  const auto& [w, p] = signals_[coordinate - static_cast<std::size_t>(n)];
  return w.dot(z_.head(n)) + p.dot(eq.motion * oscillators_now());
}

void Trajectory::come_to_rest() {
  z_ = tends_to();
  acceleration_.setZero(flow_.equations().masses());
}

void Trajectory::finish() {
  for (; next_sample_ < samples_.time.size(); ++next_sample_)
    keep_state(z_, acceleration_, oscillators_now(), account_.dissipated());
}

// With q = q_0 + B y, B the free directions, the forces balance along them:
//   B^T (K q - f_0 + W phi + D s) = 0,  phi_j = sigma_j F_j of the contacts that slide,
// K and f_0 with the bends of the displacement that are beyond their places,
// and of the internal forces s_i = s_0 + k D_i^T (q - q_0) where a slider sticks, 0 where a damper lets go.
Trajectory::State Trajectory::resting_state(const State& z) const {
  const auto& eq = flow_.equations();
  const Index n = eq.masses();
  Eigen::VectorXd stiffness = Eigen::VectorXd::Zero(eq.internal_forces()), s = stiffness;
  // If nothing sticks any start is right, and zero is free of rounding.
  const Eigen::VectorXd q =
      stuck_ == 0 ? Eigen::VectorXd(Eigen::VectorXd::Zero(n)) : Eigen::VectorXd(z.head(n));
  const ContactMask bent = beyond_ & ~eq.bends.of_velocity;
  const Eigen::MatrixXd K_bent = eq.stiffness_beyond(bent);
  Eigen::VectorXd force = eq.force_beyond(bent).col(0) - K_bent * q;
  for (Index j = 0; j < eq.contacts(); ++j) {
    const bool sticks = contains(stuck_, j);
    if (!sticks) force -= (contains(positive_, j) ? 1.0 : -1.0) * eq.limit[j] * eq.W.col(j);
    if (eq.holds(j)) continue;
    const Index internal = eq.internal_of[static_cast<std::size_t>(j)];
    s[internal] = z[2 * n + internal];
    if (!sticks) continue;
    stiffness[internal] = eq.internal_stiffness[internal];
    force -= s[internal] * eq.D.col(internal);
  }
  const Eigen::MatrixXd K = K_bent + eq.D * stiffness.asDiagonal() * eq.D.transpose();
  const Eigen::MatrixXd& B = free_directions_;
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(n);
  if (B.cols() > 0) {
    const Eigen::MatrixXd along = B.transpose() * K * B;  // bends may have made it indefinite
    const Eigen::VectorXd force_along = B.transpose() * force;
    moved =
        B * (bent == 0 ? algebra::solve_positive(along, force_along) : algebra::solve(along, force_along));
  }
  State rest = State::Zero(eq.states());
  rest.head(n) = q + moved;
  rest.tail(s.size()) = s + stiffness.cwiseProduct(eq.D.transpose() * moved);
  return rest;
}

Trajectory::State Trajectory::tends_to() const {
  return crept_ ? creeps_to_ : resting_state(z_);
}

double Trajectory::distance_from_rest() const {
  return flow_.equations().energy_norm(State(z_ - resting_state(z_)));
}

bool Trajectory::friction_slides() const {
  for (Index j = 0; j < flow_.equations().contacts(); ++j) {
    if (!contains(stuck_, j) && flow_.equations().limit[j] > 0.0) return true;
  }
  return false;
}

// Held masses are released only by forces that still change: those of Maxwell elements.
bool Trajectory::is_at_rest() const {
  const auto& eq = flow_.equations();
  constexpr double kRelaxed = 1e-12;
  const auto relaxing = (eq.internal_rate.array() > 0.0).select(z_.tail(eq.internal_forces()), 0.0);
  return has_mode_ && free_directions_.cols() == 0 && relaxing.matrix().norm() <= kRelaxed * eq.limit.norm();
}

}  // namespace frahm::transient
