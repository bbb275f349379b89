// What sticks in a motion, and where it comes to rest.
#include <cmath>
#include <vector>

#include "solvers/algebra/no_value.hpp"
#include "solvers/algebra/null_space.hpp"
#include "solvers/algebra/solve.hpp"
#include "solvers/transient/step_limits.hpp"
#include "solvers/transient/trajectory.hpp"

namespace frahm::transient {

using Eigen::Index;
using periodic::contains, periodic::ContactMask;

// The contacts that rest from here on, and those that no longer do. One that others hold rests too.
void Trajectory::note_mode(const periodic::Mode<Eigen::Dynamic, Eigen::Dynamic>& mode, double at,
                           const State& z) {
  const ContactMask resting = flow_.at_rest(mode);
  const bool same_contacts = has_mode_ && resting == stuck_ && mode.positive == positive_;
  if (same_contacts && mode.beyond == beyond_) return;
  const auto& eq = flow_.equations();
  const State creeps_to = has_mode_ && kept_.rest ? resting_state(z) : z;
  const ContactMask stopped = resting & ~stuck_, released = stuck_ & ~resting;
  for (Index j = 0; j < eq.contacts(); ++j) {
    auto& stops = stops_[static_cast<std::size_t>(j)];
    if (contains(released, j)) stops.back().release = at;
    if (!contains(stopped, j)) continue;
    stops.push_back({at, kNone});
    const double scale = periodic::kStepRate * std::sqrt(2.0 * eq.compliance[j]) * energy_scale_;
    if (has_mode_ && kept_.rest && deceleration_[j] <= kCreeping * scale) {
      crept_ = true;
      creeps_to_ = creeps_to;
    }
  }
  if (released != 0) crept_ = false;
  const bool same_stuck = has_mode_ && resting == stuck_;
  stuck_ = resting;
  positive_ = mode.positive;
  note_touches(mode.beyond, at);
  has_mode_ = true;
  if (same_stuck || !kept_.rest) return;
  find_free_directions();
  const bool held = free_directions_.cols() == 0;
  if (!held || std::isnan(held_since_)) held_since_ = held ? at : kNone;
}

// The bends that are beyond their places from here on, and those that no longer are.
void Trajectory::note_touches(ContactMask beyond, double at) {
  const ContactMask changed = beyond ^ beyond_;
  for (std::size_t j = 0; changed != 0 && j < touches_.size(); ++j) {
    const auto bend = static_cast<Index>(j);
    if (!contains(changed, bend)) continue;
    if (contains(beyond, bend)) {
      touches_[j].push_back({at, kNone});
    } else {
      touches_[j].back().end = at;
    }
  }
  beyond_ = beyond;
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

void Trajectory::come_to_rest() {
  z_ = tends_to();
  goes_on_ = false;
  acceleration_.setZero(flow_.equations().masses());
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
