// Flow: which contacts stick and which slide after an event. Included by flow.hpp.
namespace frahm::periodic {

template <int N, int H>
void Flow<N, H>::open_segment(Passage<N, H>& passage) {
  passage.segments.push_back({clock_, 0.0, mode_, left_.z});
}

template <int N, int H>
typename Sizes<N, H>::State Flow<N, H>::brought_to_rest(const typename S::State& z, double phase,
                                                        ContactMask contacts) {
  typename S::State held = z;
  typename S::Oscillators u(equations_.oscillators());
  equations_.oscillators_at(phase, orders_, u);
  configurations_[configuration_index(contacts)].hold(equations_, u, held);
  return held;
}

// The mode at the start of a passage, and the tangent that keeps its stuck contacts stuck.
template <int N, int H>
void Flow<N, H>::enter(const typename S::State& z, double phase, Passage<N, H>& passage) {
  const Eigen::Index n = equations_.masses();
  passage.segments.clear();
  passage.events = 0;
  passage.margin = 1.0;
  passage.failure = nullptr;
  passage.starts_at_event = false;
  clock_ = 0.0;
  fresh_ = just_released_ = 0;
  set_scales(z);

  mode_ = mode_index(0, 0);
  instant_at(z, phase, modes_[mode_], left_);
  ContactMask at_rest = 0, positive = 0;
  for (Eigen::Index j = 0; j < equations_.contacts(); ++j) {
    const double speed = sliding_speed(left_, j).value;
    if (std::abs(speed) <= kRest * speed_scale_[j])
      at_rest |= bit(j);
    else if (speed > 0.0)
      positive |= bit(j);
  }
  mode_ = mode_index(0, positive);
  if (at_rest != 0) choose_modes(at_rest, passage);
  configurations_[modes_[mode_].configuration].hold(equations_, left_.u, left_.z);
  accelerate(modes_[mode_], left_);
  release_at_limits();
  accelerate(modes_[mode_], left_);

  passage.starts_at_event = fresh_ != 0;
  passage.tangent.setIdentity(equations_.states(), equations_.states());
  passage.tangent.block(n, n, n, n) = configurations_[modes_[mode_].configuration].P;
  open_segment(passage);
}

// Sliding contacts that come to rest at this event: its own, and others that do at the same instant.
template <int N, int H>
ContactMask Flow<N, H>::arrivals(const Event& event) const {
  ContactMask arrived = event.release ? 0 : bit(event.contact);
  for (Eigen::Index j = 0; j < equations_.contacts(); ++j) {
    if (contains(modes_[mode_].stuck | arrived | fresh_, j)) continue;
    const ValueAndSlope speed = sliding_speed(left_, j);
    const double sign = modes_[mode_].sign(j);
    if (sign * speed.value <= kRest * speed_scale_[j] && sign * speed.slope < 0.0) arrived |= bit(j);
  }
  return arrived;
}

template <int N, int H>
void Flow<N, H>::pass_event(const Event& event, double phase, Passage<N, H>& passage) {
  // 1. Move to the event.
  const bool moved = event.at > 0.0;
  if (moved) {
    advance(event.at, passage);
    fresh_ = just_released_ = 0;
  }
  const double phase_now = phase + clock_ * fundamental_rate_;
  const Mode<N, H> mode_before = modes_[mode_];
  instant_at(typename S::State(left_.z), phase_now, mode_before, left_);
  passage.segments.back().length = clock_ - passage.segments.back().start;
  ++passage.events;
  const Instant<N, H> before = left_;

  // 2. Choose the modes of all contacts at rest together.
  const ContactMask arrived = arrivals(event);
  if (event.release) {
    const ValueAndSlope force = stuck_force(left_, mode_before, event.contact);
    passage.margin = std::min(passage.margin, std::abs(force.slope) / force_scale_[event.contact]);
    const ContactMask released = bit(event.contact);
    mode_ =
        mode_index(mode_before.stuck & ~released, mode_before.positive | (force.value > 0.0 ? released : 0));
    fresh_ |= released;
    just_released_ |= released;
  }
  if (arrived != 0)
    choose_modes((event.release ? modes_[mode_].stuck : mode_before.stuck) | arrived, passage);
  configurations_[modes_[mode_].configuration].hold(equations_, left_.u, left_.z);
  accelerate(modes_[mode_], left_);
  release_at_limits();
  accelerate(modes_[mode_], left_);

  // 3. Carry the tangent across.
  if (arrived != 0) saltate(arrived, before, mode_before, passage);
  if (passage.segments.back().length == 0.0) passage.segments.pop_back();
  open_segment(passage);
}

// Friction forces of all contacts at rest from one convex problem: with a_free the acceleration without them,
//   minimise 1/2 lambda^T G lambda - c^T lambda,  |lambda_j| <= F_j,  c = W^T a_free + relative support
//   acceleration.
// Inside its limit a contact sticks; at its limit it slides that way (Glocker 2001, ch. 9).
template <int N, int H>
void Flow<N, H>::choose_modes(ContactMask at_rest, Passage<N, H>& passage) {
  const StepEquations<N, H>& eq = equations_;
  const Mode<N, H> before = modes_[mode_];
  typename S::Contacts friction(eq.contacts());
  for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
    friction[j] = contains(at_rest | before.stuck, j) ? 0.0 : before.sign(j) * eq.limit[j];
  }
  const Eigen::Index n = eq.masses();
  typename S::Vector force_free =
      eq.force * left_.u - eq.K * left_.z.head(n) - eq.C * left_.z.segment(n, n) - eq.W * friction;
  if constexpr (S::kInternal != 0) force_free -= eq.D * left_.z.tail(eq.internal_forces());
  const typename S::Vector a_free = eq.M_inverse * force_free;

  const auto relative = [&](Eigen::Index j) {
    return eq.W.col(j).dot(a_free) + eq.support_acceleration.row(j).dot(left_.u);
  };

  ContactMask stuck = 0, positive = before.positive & ~at_rest;
  const auto slide = [&](Eigen::Index j, bool forward) {
    if (forward) positive |= bit(j);
    fresh_ |= bit(j);
    just_released_ &= ~bit(j);
  };
  const Eigen::Index m = __builtin_popcountll(at_rest);
  if (m == 1) {
    const Eigen::Index j = __builtin_ctzll(at_rest);
    const double force = relative(j) / eq.compliance[j], limit = eq.limit[j];
    if (limit > 0.0 && !contains(held_, j))
      passage.margin = std::min(passage.margin, std::abs(std::abs(force) - limit) / limit);
    if (contains(held_, j) || (std::abs(force) <= limit * (1.0 + kTie) && limit > 0.0))
      stuck = bit(j);
    else
      slide(j, force > 0.0);
  } else {
    std::vector<Eigen::Index> contacts;
    for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
      if (contains(at_rest, j)) contacts.push_back(j);
    }
    Eigen::MatrixXd G(m, m);
    Eigen::VectorXd c(m), limit(m);
    for (Eigen::Index i = 0; i < m; ++i) {
      const Eigen::Index j = contacts[static_cast<std::size_t>(i)];
      c[i] = relative(j);
      limit[i] = eq.limit[j];
      const typename S::Vector MWj = eq.M_inverse * eq.W.col(j);
      for (Eigen::Index k = 0; k < m; ++k) G(i, k) = MWj.dot(eq.W.col(contacts[static_cast<std::size_t>(k)]));
    }
    const Eigen::VectorXd weight = limit.unaryExpr([](double f) { return f > 0.0 ? f : 1.0; });
    constexpr double kWithoutLimit = 1e9;
    Eigen::VectorXd bound = limit;
    for (Eigen::Index i = 0; i < m; ++i) {
      if (contains(held_, contacts[static_cast<std::size_t>(i)])) bound[i] = kWithoutLimit * weight[i];
    }
    const Eigen::VectorXd force = box_minimum(G, c, -bound, bound, weight);
    const Eigen::VectorXd acceleration = c - G * force;
    for (Eigen::Index i = 0; i < m; ++i) {
      const Eigen::Index j = contacts[static_cast<std::size_t>(i)];
      const double scale = G(i, i) * weight[i] + std::abs(c[i]);
      const double pull = std::abs(acceleration[i]) / scale;
      const double room = (limit[i] - std::abs(force[i])) / weight[i];
      if (limit[i] > 0.0 && !contains(held_, j))
        passage.margin = std::min(passage.margin, std::max(pull, room));
      if (pull <= kTie && limit[i] > 0.0)
        stuck |= bit(j);
      else
        slide(j, limit[i] > 0.0 ? force[i] > 0.0 : acceleration[i] > 0.0);
    }
  }
  mode_ = mode_index(stuck, positive);
}

// A stuck contact whose force stands at its limit and grows lets go at once (two contacts released together,
// or one that came to rest in a tie).
template <int N, int H>
void Flow<N, H>::release_at_limits() {
  for (bool again = true; again;) {
    again = false;
    for (Eigen::Index j = 0; j < equations_.contacts(); ++j) {
      const Mode<N, H>& mode = modes_[mode_];
      if (!contains(mode.stuck & ~held_, j)) continue;
      const ValueAndSlope force = stuck_force(left_, mode, j);
      const double side = force.value > 0.0 ? 1.0 : -1.0;
      if (side * force.value < equations_.limit[j] * (1.0 - kTie) || side * force.slope <= 0.0) continue;
      fresh_ |= bit(j);
      just_released_ |= bit(j);
      mode_ = mode_index(mode.stuck & ~bit(j), mode.positive | (side > 0.0 ? bit(j) : 0));
      again = true;
    }
  }
}

// dv+ = dv- + (a+ - a-)(w^T dv-) / (w^T a- - a_node): exact for a crossing, and for a stop, where it is the
// M-orthogonal projection onto the stuck velocities (Leine and Nijmeijer, Dynamics and Bifurcations of
// Non-Smooth Mechanical Systems, 2004, ch. 7). Of contacts that arrive together each brings its own share.
template <int N, int H>
void Flow<N, H>::saltate(ContactMask arrived, const Instant<N, H>& before, const Mode<N, H>& mode_before,
                         Passage<N, H>& passage) {
  const StepEquations<N, H>& eq = equations_;
  const Eigen::Index n = eq.masses();
  const bool alone = __builtin_popcountll(arrived) == 1;
  auto dv = passage.tangent.middleRows(n, n);
  Eigen::Matrix<double, N, S::kState> correction;
  correction.setZero(n, eq.states());
  for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
    if (!contains(arrived, j)) continue;
    const double slope = sliding_speed(before, j).slope;
    const double steepness = std::abs(slope) / (kStepRate * speed_scale_[j]);
    passage.margin = std::min(passage.margin, steepness);
    if (slope == 0.0) continue;
    typename S::Vector change = left_.a - before.a;
    if (!alone) {
      const Mode<N, H>& mode = modes_[mode_];
      const double after = contains(mode.stuck, j) ? stuck_force(left_, mode, j).value : mode.friction[j];
      change = -(eq.M_inverse * eq.W.col(j)) * (after - mode_before.friction[j]);
    }
    correction += change * (eq.W.col(j).transpose() * dv) / slope;
  }
  dv += correction;
}

}  // namespace frahm::periodic
