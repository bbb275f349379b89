#include "solvers/transient/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/coordinates.hpp"
#include "solvers/transient/step_limits.hpp"

namespace frahm::transient {
namespace {

using Eigen::Index;
using periodic::contains;

void check_initial(double value, const char* what) {
  const double size = std::abs(value);
  if (std::isfinite(value) && (size == 0.0 || (size >= kSmallestInitial && size <= kLargestInitial))) return;
  std::ostringstream message;
  message << "an initial " << what << " is " << value << "; must be 0 or of a size from " << kSmallestInitial
          << " to " << kLargestInitial;
  throw mechanics::MechanicsError(message.str());
}

}  // namespace

std::vector<double> sample_times(double duration, int count) {
  std::vector<double> times;
  for (int i = 0; i < count; ++i) times.push_back(count > 1 ? duration * i / (count - 1) : 0.0);
  return times;
}

Trajectory::Trajectory(const mechanics::Assembly& assembly, std::vector<double> times, Watch watch, Kept kept)
    : assembly_(assembly),
      walk_(flow_),
      steps_(flow_),
      account_(assembly, flow_, kept.energies),
      kept_(kept),
      held_since_(kNone),
      forms_(assembly, flow_),
      signals_(mechanics::incidences_beyond_masses(assembly.network())),
      turning_points_(mechanics::coordinate_count(assembly.network())),
      stops_(assembly.contacts()),
      touches_(assembly.bends().law.size()),
      watch_(std::move(watch)) {
  samples_.time = std::move(times);
  samples_.displacement.resize(turning_points_.size());
  samples_.velocity.resize(turning_points_.size());
  samples_.acceleration.resize(turning_points_.size());
  samples_.dissipated.resize(account_.dissipated().size());
}

void Trajectory::set_system(const mechanics::LinearSystem& system, double phase) {
  const double energy = has_started() ? energy_now() : 0.0;
  const Eigen::VectorXd joints = joints_now();
  flow_.set_system(system);
  if (system.free_directions.cols() > 0 && kept_.rest) system_ = system;
  ways_.known = false;
  take_forcing(system, phase, energy, joints);
}

void Trajectory::set_forcing(const mechanics::LinearSystem& system, double phase) {
  take_forcing(system, phase, has_started() ? energy_now() : 0.0, joints_now());
}

void Trajectory::take_forcing(const mechanics::LinearSystem& system, double phase, double energy_before,
                              const Eigen::VectorXd& joints) {
  const double old_step = flow_.equations().step;
  flow_.set_forcing(system);
  account_.set_system(system);
  goes_on_ = false;
  if (kept_.largest != nullptr) kept_.largest->set_system(flow_);
  forcing_omega_ = system.omega;
  set_frequency(system.omega, 0.0);
  phase_ = phase;
  if (!has_started()) return;
  carry_over(old_step);
  if (joints.size() > 0) hold_joints(joints, system.joints.damped);
  account_.put_in(energy_now() - energy_before);
}

void Trajectory::set_recorded(const Eigen::VectorXd& numbers, double phase, bool jumps) {
  flow_.set_recorded(numbers, phase);
  if (jumps) goes_on_ = false;
  phase_ = phase;
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

Eigen::VectorXd Trajectory::joints_now() const {
  const auto& joints = flow_.equations().joints;
  if (!has_started() || !joints.any()) return {};
  const Index n = flow_.equations().masses();
  return joints.B * z_.head(n) + joints.X * z_.tail(joints.X.cols()) + joints.offset * oscillators_now();
}

// Where matrices or loads jump, dampers hold those combinations E^T x of joints that they strain:
// E^T x = E^T (B q + X s + offset u) is solved for those of s that joints have, the last. The others follow.
void Trajectory::hold_joints(const Eigen::VectorXd& x, const Eigen::MatrixXd& damped) {
  const auto& joints = flow_.equations().joints;
  const Index n = flow_.equations().masses(), d = damped.cols();
  if (d == 0) return;
  const Eigen::VectorXd beside = x - joints.B * z_.head(n) - joints.offset * oscillators_now();
  const Eigen::MatrixXd E_X = damped.transpose() * joints.X.rightCols(d);
  z_.tail(d) = E_X.partialPivLu().solve(damped.transpose() * beside);
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
  largest_speed_ = z_.segment(n, n).cwiseAbs();
  account_.open(energy_now());
}

bool Trajectory::advance(double duration, double phase) {
  const double length = without_rounding(duration / flow_.equations().step), start = time_;
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
  if (goes_on_)
    walk_.go_on(phase, length, passage_, &steps_);
  else
    walk_.pass(z_, phase, length, passage_, periodic::Tangent::none, 0, &steps_);
  goes_on_ = true;
  steps_taken_ += length;
  failure_ = passage_.failure;
  if (failure_ != nullptr) return false;
  energy_scale_ = passage_.energy_scale;
  energy_after_ = flow_.energy_scale(passage_.end, phase + length * flow_.fundamental_rate());
  for (Step& step : steps_.steps()) follow(step);
  z_ = passage_.end;
  phase_ = phase + length * flow_.fundamental_rate();
  if (flow_.equations().has_free_masses && kept_.rest) note_speeds();
  return true;
}

void Trajectory::follow(Step& step) {
  const auto& eq = flow_.equations();
  const double at = time_ + step.start * eq.step;
  const auto& mode = flow_.mode(step.mode);
  note_mode(mode, at, step.left.z);
  if (kept_.largest != nullptr) {
    const double energy = std::max(energy_scale_, energy_after_);
    kept_.largest->follow(flow_, steps_, step, at, energy);
  }
  if (kept_.extrema) follow_extrema(step, at);
  keep_samples(step, at);
  if (kept_.energies != EnergyDetail::none) follow_energies(step);
  for (Index j = 0; kept_.rest && j < eq.contacts(); ++j) {
    if (!contains(mode.stuck, j)) deceleration_[j] = std::abs(flow_.sliding_speed(step.right, j).slope);
  }
}

void Trajectory::follow_energies(Step& step) {
  const auto& mode = flow_.mode(step.mode);
  if (step.length == 1.0 && account_.follow_whole(mode, step.left, step.right)) return;
  account_.follow(mode, steps_.expand(step), step.length);
}

void Trajectory::follow_extrema(Step& step, double at) {
  const auto& eq = flow_.equations();
  const Index n = eq.masses();
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
}

// Against the speed of a signal's masses at the motion's energy, and of its supports.
void Trajectory::follow_signals(const Step& step, double at) {
  const auto& eq = flow_.equations();
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    const auto& [w, p, j] = signals_[i];
    double of_masses = std::sqrt(2.0 * w.dot(eq.M_inverse * w)) * energy_scale_;
    double of_supports = p.cwiseAbs().dot(eq.motion_velocity.cwiseAbs().rowwise().sum());
    if (signals_[i].has_joint()) {
      const periodic::StateRow row = periodic::velocity_row(eq, signals_[i]);
      of_masses = periodic::largest_rate(eq, row) * energy_scale_;
      of_supports = row.u.cwiseAbs().sum();
    }
    turning_points_[static_cast<std::size_t>(eq.masses()) + i].follow(
        {.start = at,
         .step = eq.step,
         .length = step.length,
         .displacement = forms_.displacement(signals_[i]).polynomial(step.expansion),
         .velocity = eq.step * forms_.velocity(signals_[i]).polynomial(step.expansion),
         .speed_scale = of_masses + of_supports});
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
  const mechanics::Incidence& at = signals_[coordinate - static_cast<std::size_t>(n)];
  if (at.has_joint()) {
    const periodic::StateRow row = periodic::displacement_row(eq, at);
    return row.z.dot(z_) + row.u.dot(oscillators_now());
  }
  const auto& [w, p, j] = at;
  return w.dot(z_.head(n)) + p.dot(eq.motion * oscillators_now());
}

}  // namespace frahm::transient
