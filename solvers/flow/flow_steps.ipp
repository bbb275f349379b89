// Flow: stepping, and the search for events within a step. Included by flow.hpp.
namespace frahm::periodic {

template <int N, int H>
void Flow<N, H>::pass(const typename S::State& z, double phase, double length, Passage<N, H>& passage) {
  constexpr int kMostEvents = 20000;
  enter(z, phase, passage);
  int at_this_instant = 0;
  while (passage.failure == nullptr) {
    step(left_, modes_[mode_], right_);
    expanded_ = false;
    const Event event = first_event(passage);
    const double room = length - clock_;
    if (event.at < room && event.at <= 1.0) {
      at_this_instant = event.at > 0.0 ? 0 : at_this_instant + 1;
      pass_event(event, phase, passage);
      if (at_this_instant > 8 + 4 * equations_.contacts())
        passage.failure = "the contacts chatter at one instant";
      if (passage.events > kMostEvents) passage.failure = "more than 20000 events in one passage";
    } else if (room <= 1.0) {
      advance(room, passage);
      passage.segments.back().length = length - passage.segments.back().start;
      break;
    } else {
      passage.tangent = (configurations_[modes_[mode_].configuration].E * passage.tangent).eval();
      left_ = right_;
      clock_ += 1.0;
      fresh_ = just_released_ = 0;
    }
  }
  passage.end = left_.z;
  if (!passage.end.allFinite()) passage.failure = "the state is not finite";
}

template <int N, int H>
void Flow<N, H>::instant_at(const typename S::State& z, double phase, const Mode<N, H>& mode,
                            Instant<N, H>& at) const {
  const StepEquations<N, H>& eq = equations_;
  at.z = z;
  at.u.resize(eq.oscillators());
  at.du.resize(eq.oscillators());
  eq.oscillators_at(phase, orders_, at.u);
  at.du[0] = 0.0;
  for (Eigen::Index k = 0; k < eq.phase_rate.size(); ++k) {
    at.du[1 + 2 * k] = -eq.phase_rate[k] * at.u[2 + 2 * k];
    at.du[2 + 2 * k] = eq.phase_rate[k] * at.u[1 + 2 * k];
  }
  accelerate(mode, at);
}

// q'' = Aq q + Av v + As s + Au u + Af phi;  s' = k (D^T v + p^T y') - rate s
template <int N, int H>
void Flow<N, H>::accelerate(const Mode<N, H>& mode, Instant<N, H>& at) const {
  const Eigen::Index n = equations_.masses();
  const Configuration<N, H>& configuration = configurations_[mode.configuration];
  at.a.noalias() = configuration.Aq * at.z.head(n) + configuration.Av * at.z.segment(n, n);
  at.a.noalias() += configuration.Au * at.u;
  at.a += mode.acceleration;
  if constexpr (S::kInternal != 0) {
    const auto s = at.z.tail(equations_.internal_forces());
    at.a += configuration.As * s;
    at.ds = equations_.internal_stiffness.asDiagonal() * (equations_.D.transpose() * at.z.segment(n, n)) -
            equations_.internal_rate.asDiagonal() * s + equations_.internal_drive * at.u;
  }
}

template <int N, int H>
void Flow<N, H>::step(const Instant<N, H>& from, const Mode<N, H>& mode, Instant<N, H>& to) const {
  const StepEquations<N, H>& eq = equations_;
  const Configuration<N, H>& configuration = configurations_[mode.configuration];
  to.z.noalias() = configuration.E * from.z;
  to.z.noalias() += configuration.Eu * from.u;
  to.z += mode.step;
  to.u.resize(eq.oscillators());
  to.du.resize(eq.oscillators());
  to.u[0] = 1.0;
  to.du[0] = 0.0;
  for (Eigen::Index k = 0; k < eq.phase_rate.size(); ++k) {
    const double c = rotation_[2 * static_cast<std::size_t>(k)],
                 s = rotation_[2 * static_cast<std::size_t>(k) + 1];
    const double u_cos = from.u[1 + 2 * k], u_sin = from.u[2 + 2 * k];
    to.u[1 + 2 * k] = c * u_cos - s * u_sin;
    to.u[2 + 2 * k] = s * u_cos + c * u_sin;
    to.du[1 + 2 * k] = -eq.phase_rate[k] * to.u[2 + 2 * k];
    to.du[2 + 2 * k] = eq.phase_rate[k] * to.u[1 + 2 * k];
  }
  accelerate(mode, to);
}

template <int N, int H>
void Flow<N, H>::expand(const Instant<N, H>& at, const Mode<N, H>& mode, Expansion<N, H>& x) const {
  const StepEquations<N, H>& eq = equations_;
  const Configuration<N, H>& configuration = configurations_[mode.configuration];
  x.z.resize(kTerms, eq.states());
  Eigen::Map<typename S::Series> series(x.z.data(), x.z.size());
  series.noalias() = configuration.series_z * at.z;
  series.noalias() += configuration.series_u * at.u;
  series += mode.series;
  x.u.resize(kTerms, eq.oscillators());
  x.u.col(0).setZero();
  x.u(0, 0) = 1.0;
  for (Eigen::Index k = 0; k < eq.phase_rate.size(); ++k) {
    const double u_cos = at.u[1 + 2 * k], u_sin = at.u[2 + 2 * k];
    const Polynomial& c = rotation_series_[2 * static_cast<std::size_t>(k)];
    const Polynomial& s = rotation_series_[2 * static_cast<std::size_t>(k) + 1];
    x.u.col(1 + 2 * k) = u_cos * c - u_sin * s;
    x.u.col(2 + 2 * k) = u_sin * c + u_cos * s;
  }
}

template <int N, int H>
void Flow<N, H>::evaluate(const Expansion<N, H>& x, double s, typename S::State& z) {
  z.noalias() = x.z.transpose() * powers(s);
}

template <int N, int H>
typename Sizes<N, H>::State Flow<N, H>::state_within(const Segment<N, H>& segment, double section,
                                                     double elapsed) const {
  const Mode<N, H>& mode = modes_[segment.mode];
  Instant<N, H> at, next;
  instant_at(segment.z, section + segment.start * fundamental_rate_, mode, at);
  for (; elapsed >= 1.0; elapsed -= 1.0) {
    step(at, mode, next);
    at = next;
  }
  Expansion<N, H> x;
  expand(at, mode, x);
  typename S::State z;
  evaluate(x, elapsed, z);
  return z;
}

template <int N, int H>
const Expansion<N, H>& Flow<N, H>::expansion() {
  if (!expanded_) expand(left_, modes_[mode_], expansion_);
  expanded_ = true;
  return expansion_;
}

template <int N, int H>
ValueAndSlope Flow<N, H>::sliding_speed(const Instant<N, H>& at, Eigen::Index j) const {
  const Eigen::Index n = equations_.masses();
  const auto w = equations_.W.col(j);
  const auto support = equations_.support_velocity.row(j);
  return {w.dot(at.z.segment(n, n)) + support.dot(at.u), w.dot(at.a) + support.dot(at.du)};
}

template <int N, int H>
ValueAndSlope Flow<N, H>::stuck_force(const Instant<N, H>& at, const Mode<N, H>& mode, Eigen::Index j) const {
  const Eigen::Index n = equations_.masses();
  const Configuration<N, H>& c = configurations_[mode.configuration];
  ValueAndSlope force{c.Lq.row(j).dot(at.z.head(n)) + c.Lv.row(j).dot(at.z.segment(n, n)) +
                          c.Lu.row(j).dot(at.u) + mode.stuck_force[j],
                      c.Lq.row(j).dot(at.z.segment(n, n)) + c.Lv.row(j).dot(at.a) + c.Lu.row(j).dot(at.du)};
  if constexpr (S::kInternal != 0) {
    force.value += c.Ls.row(j).dot(at.z.tail(equations_.internal_forces()));
    force.slope += c.Ls.row(j).dot(at.ds);
  }
  return force;
}

template <int N, int H>
typename Flow<N, H>::Event Flow<N, H>::first_event(Passage<N, H>& passage) {
  Event first;
  for (Eigen::Index j = 0; j < equations_.contacts(); ++j) {
    const bool stuck = contains(modes_[mode_].stuck, j);
    const double at = stuck ? first_release(j, passage) : first_stop(j, passage);
    if (at < first.at) first = {at, j, stuck};
  }
  return first;
}

// The first sign change of p on (0, 1], or 2. Where there is none, its closest approach to zero is a margin.
template <int N, int H>
double Flow<N, H>::first_crossing(const Polynomial& p, double scale, Passage<N, H>& passage) const {
  if (!may_change_sign(p)) return 2.0;
  const Roots roots = sign_changes(p);
  if (roots.count > 0) return roots.at[0];
  const Roots extremes = sign_changes(derivative(p));
  for (int i = 0; i < extremes.count; ++i) {
    const double closest = std::abs(periodic::evaluate(p, extremes.at[static_cast<std::size_t>(i)]));
    passage.margin = std::min(passage.margin, closest / scale);
  }
  return 2.0;
}

// Where the room p that a stuck force has left to its limit turns negative by more than a tie, or 2: a force
// that only touches its limit lets nothing go.
template <int N, int H>
double Flow<N, H>::first_lasting_fall(const Polynomial& p, double limit, Passage<N, H>& passage) const {
  const double first = first_crossing(p, limit, passage);
  if (first > 1.0 || evaluate_with_slope(p, first).slope < -1e-4 * limit) return first;
  const Roots extremes = sign_changes(derivative(p));
  double deepest = periodic::evaluate(p, 1.0);
  for (int i = 0; i < extremes.count; ++i) {
    const double at = extremes.at[static_cast<std::size_t>(i)];
    if (at > first) deepest = std::min(deepest, periodic::evaluate(p, at));
  }
  if (deepest < -kTie * limit) return first;
  passage.margin = 0.0;
  return 2.0;
}

// When does sliding contact j come to rest within the step?
template <int N, int H>
double Flow<N, H>::first_stop(Eigen::Index j, Passage<N, H>& passage) {
  const auto polynomial = [&] {
    const Expansion<N, H>& x = expansion();
    Polynomial speed = x.velocity(equations_.W.col(j));
    if (moving_support_) speed.noalias() += x.u * equations_.support_velocity.row(j).transpose();
    return speed;
  };
  const double scale = speed_scale_[j];
  if (scale == 0.0) return 2.0;
  if (contains(fresh_, j)) {
    // The velocity starts like t, or like t^2 after a release: divide that root out.
    return first_crossing(deflate(polynomial(), contains(just_released_, j) ? 2 : 1), scale, passage);
  }
  const ValueAndSlope left = sliding_speed(left_, j), right = sliding_speed(right_, j);
  if (modes_[mode_].sign(j) * left.value <= 0.0) return 0.0;  // at the node itself, seen late by rounding
  constexpr double kFourthDerivative = 2.0 * kStepRate * kStepRate * kStepRate * kStepRate;
  switch (hermite_verdict(left, right, scale * kFourthDerivative / 384.0)) {
    case SignVerdict::no_change:
      return 2.0;
    case SignVerdict::one_change:
      return root_between(polynomial(), 0.0, 1.0);
    case SignVerdict::unclear:
      break;
  }
  return first_crossing(polynomial(), scale, passage);
}

// When does the force of stuck contact j reach its limit within the step?
template <int N, int H>
double Flow<N, H>::first_release(Eigen::Index j, Passage<N, H>& passage) {
  if (contains(held_, j)) return 2.0;
  const double limit = equations_.limit[j];
  const ValueAndSlope left = stuck_force(left_, modes_[mode_], j),
                      right = stuck_force(right_, modes_[mode_], j);
  constexpr double kFourthDerivative = 2.0 * kStepRate * kStepRate * kStepRate * kStepRate;
  const double margin = force_scale_[j] * kFourthDerivative / 384.0;
  const double largest =
      std::max(std::max(std::abs(left.value), std::abs(right.value)),
               std::max(std::abs(left.value + left.slope / 3.0), std::abs(right.value - right.slope / 3.0)));
  if (largest + margin < limit) return 2.0;

  const Expansion<N, H>& x = expansion();
  const Configuration<N, H>& c = configurations_[modes_[mode_].configuration];
  Polynomial force = x.displacement(c.Lq.row(j).transpose()) + x.velocity(c.Lv.row(j).transpose());
  force.noalias() += x.u * c.Lu.row(j).transpose();
  if constexpr (S::kInternal != 0) force += x.internal_force(c.Ls.row(j).transpose());
  force[0] += modes_[mode_].stuck_force[j];
  double first = 2.0;
  for (const double side : {1.0, -1.0}) {
    Polynomial room = -side * force;
    room[0] += limit;
    if (room[0] <= kTie * limit) {
      if (room[1] < 0.0) return 0.0;
      room = deflate(room, 1);  // just stuck with the force at its limit and falling
    }
    first = std::min(first, first_lasting_fall(room, limit, passage));
  }
  return first;
}

// left_ and the tangent `fraction` of a step later in the same mode; the oscillators of left_ are not moved.
template <int N, int H>
void Flow<N, H>::advance(double fraction, Passage<N, H>& passage) {
  evaluate(expansion(), fraction, left_.z);
  clock_ += fraction;

  // The tangent moves with the homogeneous flow.
  const Configuration<N, H>& configuration = configurations_[modes_[mode_].configuration];
  const Polynomial power = powers(fraction);
  const Eigen::Index size = passage.tangent.rows();
  typename S::StateSquare flow(size, size);
  for (Eigen::Index column = 0; column < size; ++column) {
    const Eigen::Map<const typename S::StatePolynomials> series(configuration.series_z.col(column).data(),
                                                                kTerms, size);
    flow.col(column).noalias() = series.transpose() * power;
  }
  passage.tangent = (flow * passage.tangent).eval();
}

}  // namespace frahm::periodic
