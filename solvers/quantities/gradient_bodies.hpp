#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/modes.hpp"
#include "solvers/mechanics/system_derivative.hpp"
#include "solvers/quantities/bend_losses_derivative.hpp"
#include "solvers/quantities/gradient.hpp"

// Bodies of Gradient, for the files that instantiate it.
namespace frahm::periodic {

template <int N, int H>
const char* Gradient<N, H>::evaluate(const Orbit<N, H>& orbit, const mechanics::LinearSystem& system,
                                     const mechanics::NetworkValues& values,
                                     std::span<const mechanics::NetworkValues> directions,
                                     std::span<double> out) {
  std::fill(why_none_.begin(), why_none_.end(), "");
  const char* reason = why_no_orbit_derivative(orbit);
  if (*reason == '\0') reason = sensitivity_.prepare(orbit, steps_);
  if (*reason == '\0') measure(orbit, system);
  const std::size_t count = request_.quantities.size();
  for (std::size_t d = 0; d < directions.size() && *reason == '\0'; ++d) {
    reason = differentiate(orbit, values, directions[d]);
    if (*reason == '\0') report(out.subspan(d * count, count));
  }
  if (*reason == '\0') return reason;
  std::fill(out.begin(), out.end(), kNone);
  std::fill(why_none_.begin(), why_none_.end(), reason);
  return reason;
}

// What hangs on the instant of a change has no derivative where that instant is several.
template <int N, int H>
void Gradient<N, H>::report(std::span<double> out) {
  tell_derivatives(request_, measured_, measured_by_, out, why_none_);
  for (std::size_t i = 0; i < out.size() && sensitivity_.passage().has_apart(); ++i) {
    if (std::isnan(out[i]) && *why_none_[i] == '\0') why_none_[i] = kSeveralChange;
  }
}

template <int N, int H>
void Gradient<N, H>::measure(const Orbit<N, H>& orbit, const mechanics::LinearSystem& system) {
  const std::size_t traces = request_.traces.size();
  measurement_.measure(orbit, system, steps_, request_.needs, measured_);
  measured_.traces = &request_.traces;
  measured_.extremes.resize(traces);
  measured_.candidates.resize(traces);
  measured_by_.candidates.resize(traces);
  instants_.resize(traces);
  for (std::size_t i = 0; i < traces; ++i) {
    traced_.look(steps_, flow_, [this, i](const Mode<N, H>& mode) {
      return form_of(request_.traces[i], forms_, *measured_.system, mode);
    });
    measured_.extremes[i] = traced_.candidates(orbit.sign(), measured_.candidates[i]);
    place_instants(orbit, i);
  }
}

template <int N, int H>
void Gradient<N, H>::place_instants(const Orbit<N, H>& orbit, std::size_t trace) {
  instants_[trace].clear();
  for (const Candidate& candidate : measured_.candidates[trace]) {
    const PassageStep<N, H>& step = steps_.steps()[candidate.step];
    if (!candidate.stationary) {
      instants_[trace].push_back(candidate.s == 0.0 ? step.left : step.right);
      continue;
    }
    typename S::State z;
    Flow<N, H>::evaluate(step.expansion, candidate.s, z);
    const double phase = orbit.section + (step.start + candidate.s) * flow_.fundamental_rate();
    flow_.instant_at(z, phase, flow_.mode(step.mode), instants_[trace].emplace_back());
  }
}

template <int N, int H>
const char* Gradient<N, H>::differentiate(const Orbit<N, H>& orbit, const mechanics::NetworkValues& values,
                                          const mechanics::NetworkValues& direction) {
  const mechanics::LinearSystem& system = *measured_.system;
  mechanics::differentiate(assembly_, values, direction, system, system_by_);
  by_.set(flow_.equations(), system, system_by_);
  if (const char* reason = sensitivity_.differentiate(by_); *reason != '\0') return reason;
  measured_by_.system = &system_by_;
  measured_by_.log_period = by_.log_step;
  carry(orbit);
  if (request_.needs.integrals) integrate();
  if (request_.needs.energies || request_.needs.histories) follow_contacts(orbit);
  if (request_.needs.energies)
    measured_by_.bend_loss = bend_losses_derivative(steps_, flow_, sensitivity_.passage(), orbit.half_period);
  if (request_.needs.modes)
    modes_derivative(system, system_by_, measured_by_.natural_frequency, measured_by_.modal_damping);
  for (std::size_t i = 0; i < request_.traces.size(); ++i) differentiate_trace(i);
  return "";
}

// The drift, and the rate at which it carries free masses on [m/s].
template <int N, int H>
void Gradient<N, H>::carry(const Orbit<N, H>& orbit) {
  const StepEquations<N, H>& eq = flow_.equations();
  const Eigen::VectorXd& rate = sensitivity_.frame_by().rate;
  measured_by_.drift = rate * (eq.period / orbit.multiple);
  carried_by_ = rate;
  if (rate.size() > 0) carried_by_ = (rate - by_.log_step * steps_.frame().rate) / eq.step;
}

// d of the integral of y y^T dt: y is continuous at events, so that their shifts add nothing, and dt in
// seconds grows with the step. Of velocities in seconds, d(v/h) = dv/h - (v/h) dh/h.
template <int N, int H>
void Gradient<N, H>::integrate() {
  using Nodes = Eigen::Matrix<double, kTerms, kNodes>;
  const StepEquations<N, H>& eq = flow_.equations();
  const Eigen::Index n = eq.masses(), states = eq.states();
  Eigen::Matrix<double, Integrals<N, H>::kSize, kNodes> y(states + eq.oscillators(), kNodes);
  Eigen::Matrix<double, S::kState, kNodes> y_by(states, kNodes);
  typename Integrals<N, H>::Gram sum;
  sum.setZero(y.rows(), y.rows());
  const auto steps = steps_.steps();
  for (std::size_t i = 0; i < steps.size(); ++i) {
    Nodes at;
    for (int node = 0; node < kNodes; ++node) at.col(node) = powers(kNodeAt[node] * steps[i].length);
    y.topRows(states).noalias() = steps[i].expansion.z.transpose() * at;
    y.bottomRows(eq.oscillators()).noalias() = steps[i].expansion.u.transpose() * at;
    y_by.noalias() = sensitivity_.passage().polynomials(i).transpose() * at;
    for (int node = 0; node < kNodes; ++node) y_by.col(node) *= steps[i].length * kNodeWeight[node];
    sum.topRows(states).noalias() += y_by * y.transpose();
  }
  Eigen::MatrixXd& gram = measured_by_.gram;
  gram = (sum + sum.transpose()) * ((measured_.half_period ? 2.0 : 1.0) * eq.step);
  in_seconds(n, eq.step, gram);
  append_signals(signal_products_derivative(signals_, steps_, sensitivity_.passage(), flow_.equations(),
                                            measured_.half_period ? 2.0 : 1.0),
                 gram);
  gram += by_.log_step * measured_.gram;
  gram.middleRows(n, n) -= by_.log_step * measured_.gram.middleRows(n, n);
  gram.middleCols(n, n) -= by_.log_step * measured_.gram.middleCols(n, n);
  measured_by_.motion = by_.motion;
  measured_by_.motion_velocity = by_.motion_velocity;
  measured_by_.motion_velocity /= eq.step;
  measured_by_.motion_velocity -= by_.log_step * measured_.motion_velocity;
  if constexpr (S::kInternal != 0) {
    if (flow_.equations().joints.any()) measured_by_.joints = joint_rows_derivative(flow_.equations(), by_);
  }
}

// Distance slid: the sum of sigma (u(end) - u(start)) over the steps in which the contact slides. A shift of
// a slide's end adds nothing: the velocity there is zero. At its start the velocity is zero if it was held,
// but v for an internal force: a later start takes sigma v dt away. Time stuck: by the shifts of its ends.
template <int N, int H>
void Gradient<N, H>::follow_contacts(const Orbit<N, H>& orbit) {
  const Eigen::Index n = flow_.equations().masses();
  const double halves = orbit.half_period ? 2.0 : 1.0;
  const RidingFrame& carried = sensitivity_.frame_by();
  const auto steps = steps_.steps();
  const auto& segments = orbit.passage.segments;
  measured_by_.contacts.assign(assembly_.contacts(), {});
  for (std::size_t contact = 0; contact < assembly_.contacts(); ++contact) {
    const auto j = static_cast<Eigen::Index>(contact);
    ContactDerivative& its = measured_by_.contacts[contact];
    std::size_t changes = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const Mode<N, H>& mode = flow_.mode(steps[i].mode);
      const bool is_after_change = i > 0 && steps[i - 1].ends_segment;
      if (is_after_change) ++changes;
      if (contains(mode.stuck, j)) continue;
      if (is_after_change && contains(flow_.mode(steps[i - 1].mode).stuck, j)) {
        const double speed = flow_.sliding_speed(steps[i].left, j).value;
        const double shift = sensitivity_.passage().shift_of_contact(changes - 1, j);
        its.sliding_distance -= halves * mode.sign(j) * speed * shift;
      }
      const auto& p = sensitivity_.passage().polynomials(i);
      const typename S::State d = p.transpose() * powers(steps[i].length);
      double slid = by_.support_displacement.row(j).dot(steps[i].right.u - steps[i].left.u) +
                    by_.support_velocity(j, 0) * steps[i].length;  // of a belt, whose velocity is constant
      if (carried.moves()) slid += carried.rate_of(flow_.equations().W.col(j)) * steps[i].length;
      for (Eigen::Index q = 0; q < n; ++q) slid += flow_.equations().W(q, j) * (d[q] - p(0, q));
      its.sliding_distance += halves * mode.sign(j) * slid;
    }
    double stuck = 0.0;  // [steps]
    const auto rests = [&](std::size_t k) { return flow_.rests(flow_.mode(segments[k].mode), j); };
    for (std::size_t k = 0; k + 1 < segments.size(); ++k) {
      if (rests(k) == rests(k + 1)) continue;
      const double shift = sensitivity_.passage().shift_of_contact(k, j);
      stuck += rests(k) ? shift : -shift;
    }
    its.stuck_fraction = stuck * halves / flow_.equations().period;
  }
}

template <int N, int H>
void Gradient<N, H>::differentiate_trace(std::size_t trace) {
  const auto& candidates = measured_.candidates[trace];
  auto& list = measured_by_.candidates[trace];
  list.assign(candidates.size(), {});
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (is_asked(request_.uses[trace], candidates[i], measured_.extremes[trace], measured_.half_period))
      list[i] = of_candidate(trace, i);
  }
}

// The envelope theorem: at a stationary value only the trace itself changes; a one-sided limit moves with its
// event besides. A stationary displacement is where u'(t) = 0:  dt = -du' / u''.
template <int N, int H>
CandidateDerivative Gradient<N, H>::of_candidate(std::size_t trace, std::size_t i) {
  const Trace& what = request_.traces[trace];
  const Candidate& candidate = measured_.candidates[trace][i];
  const Instant<N, H>& x = instants_[trace][i];
  const InstantDerivative<N, H> d = sensitivity_.passage().at(candidate.step, candidate.s, x);
  look_at(x, d);
  if (what.kind == TraceKind::element_force || what.kind == TraceKind::support_force)
    look_at_forces(x, d, steps_.steps()[candidate.step].mode);
  CandidateDerivative result;
  result.value = trace_derivative(what, motion_, assembly_, *measured_.system, system_by_);
  result.state = d.z.norm() / x.z.norm();
  const double shift = candidate.change < 0  // [steps]
                           ? 0.0
                           : sensitivity_.passage().shift(static_cast<std::size_t>(candidate.change));
  // Where that instant is several, a value that stands still there asks for none of them.
  constexpr double kStandsStill = 1e-9;  // of the value, a step
  const bool stands_still =
      candidate.change < 0
          ? candidate.stationary
          : std::isnan(shift) && std::abs(candidate.slope) <= kStandsStill * std::abs(candidate.value);
  if (!stands_still) {
    result.value += candidate.slope * shift;
    result.angle = flow_.fundamental_rate() * shift;
  } else if (what.kind == TraceKind::displacement) {
    const double rate = flow_.fundamental_rate() / flow_.equations().step;  // [rad/s]
    const double carried = carried_by_.size() > 0 ? what.at.w.dot(carried_by_) : 0.0;
    result.angle =
        -rate * (velocity_derivative(what.at, motion_) - carried) / acceleration_of(what.at, motion_);
  }
  return result;
}

// In seconds:  d(v/h) = dv/h - (v/h) dh/h,  d(a/h^2) = da/h^2 - 2 (a/h^2) dh/h
template <int N, int H>
void Gradient<N, H>::look_at(const Instant<N, H>& x, const InstantDerivative<N, H>& d) {
  const StepEquations<N, H>& eq = flow_.equations();
  const Eigen::Index n = eq.masses();
  const double h = eq.step, h2 = h * h, log_step = by_.log_step;
  Kinematics &at = motion_.at, &by = motion_.by;
  at.q = x.z.head(n);
  by.q = d.z.head(n);
  at.v = x.z.segment(n, n) / h;
  by.v = d.z.segment(n, n) / h - log_step * at.v;
  at.a = x.a / h2;
  by.a = d.a / h2 - 2.0 * log_step * at.a;
  motion_.internal_by = d.z.tail(eq.internal_forces());
  at.y.noalias() = eq.motion * x.u;
  by.y.noalias() = by_.motion * x.u;
  at.y_velocity.noalias() = eq.motion_velocity * (x.u / h);
  by.y_velocity.noalias() = by_.motion_velocity * (x.u / h);
  by.y_velocity -= log_step * at.y_velocity;
  at.y_acceleration.noalias() = eq.motion_acceleration * (x.u / h2);
  by.y_acceleration.noalias() = by_.motion_acceleration * (x.u / h2);
  by.y_acceleration -= 2.0 * log_step * at.y_acceleration;
  if constexpr (S::kInternal != 0) {
    if (eq.joints.any()) look_at_joints(x, d);
  }
}

// x = B q + X s + offset u, with s' and s'' from  s' = k D^T v - rate s + drive u,  each product by its rule.
template <int N, int H>
void Gradient<N, H>::look_at_joints(const Instant<N, H>& x, const InstantDerivative<N, H>& d) {
  const StepEquations<N, H>& eq = flow_.equations();
  const Eigen::Index n = eq.masses(), internal = eq.internal_forces();
  const double h = eq.step, h2 = h * h, log_step = by_.log_step;
  const StepJoints &its = eq.joints, &changed = by_.joints;
  Kinematics &at = motion_.at, &by = motion_.by;
  const auto rates = [&](const Eigen::VectorXd& v, const Eigen::VectorXd& s) {
    return Eigen::VectorXd(eq.internal_stiffness.cwiseProduct(eq.D.transpose() * v) -
                           eq.internal_rate.cwiseProduct(s));
  };
  const auto sum = [&](const StepJoints& rows, const Eigen::VectorXd& q, const Eigen::VectorXd& s) {
    return Eigen::VectorXd(rows.B * q + rows.X * s);
  };
  const Eigen::VectorXd q = x.z.head(n), v = x.z.segment(n, n), s = x.z.tail(internal);
  const Eigen::VectorXd q_by = d.z.head(n), v_by = d.z.segment(n, n), s_by = d.z.tail(internal);
  // The derivative of s' is that of its formula, at z' = (v, a, s') that of s''.
  const Eigen::VectorXd s1 = rates(v, s) + eq.internal_drive * x.u;
  const Eigen::VectorXd s2 = rates(x.a, s1) + its.drive_rate * x.u;
  Eigen::VectorXd z1(eq.states());
  z1 << v, x.a, s1;
  const Eigen::VectorXd s1_by = rates(v_by, s_by) + by_.internal_by_state * x.z + by_.internal_drive * x.u;
  const Eigen::VectorXd s2_by = rates(d.a, s1_by) + by_.internal_by_state * z1 + changed.drive_rate * x.u;
  at.x = sum(its, q, s) + its.offset * x.u;
  by.x = sum(its, q_by, s_by) + sum(changed, q, s) + changed.offset * x.u;
  at.x_velocity = (sum(its, v, s1) + its.offset_velocity * x.u) / h;
  by.x_velocity = (sum(its, v_by, s1_by) + sum(changed, v, s1) + changed.offset_velocity * x.u) / h -
                  log_step * at.x_velocity;
  at.x_acceleration = (sum(its, x.a, s2) + its.offset_acceleration * x.u) / h2;
  by.x_acceleration =
      (sum(its, d.a, s2_by) + sum(changed, x.a, s2) + changed.offset_acceleration * x.u) / h2 -
      2.0 * log_step * at.x_acceleration;
}

template <int N, int H>
void Gradient<N, H>::look_at_forces(const Instant<N, H>& x, const InstantDerivative<N, H>& d,
                                    std::size_t mode_index) {
  const Mode<N, H>& mode = flow_.mode(mode_index);
  motion_.contacts.resize(assembly_.contacts());
  for (std::size_t contact = 0; contact < motion_.contacts.size(); ++contact) {
    const auto j = static_cast<Eigen::Index>(contact);
    ContactForce& its = motion_.contacts[contact];
    its = {flow_.rests(mode, j), mode.sign(j), 0.0, 0.0};
    if (!its.sticks) continue;
    if (!contains(mode.stuck, j)) {  // it carries its limit while others hold it
      its.force = mode.friction[j];
      its.force_by = mode.sign(j) * by_.static_limit[j];
      continue;
    }
    its.force = flow_.stuck_force(x, mode, j).value;
    its.force_by = sensitivity_.passage().stuck_force(mode_index, x, d.z, j);
  }
  const StepBends<N, H>& bends = flow_.equations().bends;
  motion_.bends_by.assign(static_cast<std::size_t>(bends.count()), 0.0);
  for (Eigen::Index j = 0; j < bends.count(); ++j) {
    if (contains(mode.beyond, j))
      motion_.bends_by[static_cast<std::size_t>(j)] =
          bend_force_derivative<N, H>(bends, by_.bends, x, d.z, j);
  }
}

}  // namespace frahm::periodic
