// The state of a motion at given times.
#include <algorithm>
#include <vector>

#include "solvers/mechanics/element_table.hpp"
#include "solvers/transient/trajectory.hpp"

namespace frahm::transient {
namespace {

using Eigen::Index;

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

void Trajectory::keep_samples(Step& step, double at) {
  if (samples_.time.empty()) return;
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
  const JointMotion joints =
      eq.joints.any() ? joint_motion(z, acceleration, u, faster, alpha_ / forcing_omega_) : JointMotion{};
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    const auto& [w, p, j] = signals_[i];
    const std::size_t place = static_cast<std::size_t>(n) + i;
    const double speed = p.dot(eq.motion_velocity * u) / h;  // of the forcing's support
    const double rise = p.dot(eq.motion_acceleration * u) / (h * h);
    samples_.displacement[place].push_back(w.dot(z.head(n)) + p.dot(eq.motion * u));
    samples_.velocity[place].push_back(w.dot(z.segment(n, n)) / h + faster * speed);
    samples_.acceleration[place].push_back(w.dot(acceleration) / (h * h) + faster * faster * rise +
                                           alpha_ / forcing_omega_ * speed);
    if (!signals_[i].has_joint()) continue;
    samples_.displacement[place].back() += j.dot(joints.x);
    samples_.velocity[place].back() += j.dot(joints.velocity) / h;
    samples_.acceleration[place].back() += j.dot(joints.acceleration) / (h * h);
  }
}

// x = B q + X s + offset u,  s' = k D^T v - rate s + drive u,  and their rates; what supports and loads do is
// `faster` than the forcing, and gets faster as above.
Trajectory::JointMotion Trajectory::joint_motion(const State& z, const Eigen::VectorXd& a,
                                                 const Oscillators& u, double faster, double rising) const {
  const auto& eq = flow_.equations();
  const auto& its = eq.joints;
  const Index n = eq.masses();
  const auto rates = [&](const Eigen::VectorXd& v, const Eigen::VectorXd& s) {
    return Eigen::VectorXd(eq.internal_stiffness.cwiseProduct(eq.D.transpose() * v) -
                           eq.internal_rate.cwiseProduct(s));
  };
  const auto second = [&](const Eigen::MatrixXd& first_rate, const Eigen::MatrixXd& second_rate) {
    return Eigen::VectorXd(faster * faster * (second_rate * u) + rising * (first_rate * u));
  };
  const Eigen::VectorXd v = z.segment(n, n), s = z.tail(eq.internal_forces());
  const Eigen::VectorXd s1 = rates(v, s) + faster * (eq.internal_drive * u);
  const Eigen::VectorXd s2 = rates(a, s1) + second(eq.internal_drive, its.drive_rate);
  return {its.B * z.head(n) + its.X * s + its.offset * u,
          its.B * v + its.X * s1 + faster * (its.offset_velocity * u),
          its.B * a + its.X * s2 + second(its.offset_velocity, its.offset_acceleration)};
}

void Trajectory::finish() {
  for (; next_sample_ < samples_.time.size(); ++next_sample_)
    keep_state(z_, acceleration_, oscillators_now(), account_.dissipated());
}

}  // namespace frahm::transient
