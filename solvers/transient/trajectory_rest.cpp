// What sticks in a motion, and where it comes to rest.
#include <algorithm>
#include <cmath>
#include <vector>

#include "solvers/algebra/no_value.hpp"
#include "solvers/algebra/null_space.hpp"
#include "solvers/algebra/solve.hpp"
#include "solvers/mechanics/free_directions.hpp"
#include "solvers/transient/step_limits.hpp"
#include "solvers/transient/trajectory.hpp"

namespace frahm::transient {

using Eigen::Index;
using periodic::contains, periodic::ContactMask;

namespace {

void add_row(const Eigen::VectorXd& row, Eigen::MatrixXd& rows) {
  rows.conservativeResize(rows.rows() + 1, row.size());
  rows.bottomRows(1) = row.normalized().transpose();
}

}  // namespace

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
  if (eq.has_free_masses) return resting_state_of_free(z);
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

// The largest speeds so far, of which the rounding of a momentum is a part.
void Trajectory::note_speeds() {
  const Index n = flow_.equations().masses();
  largest_speed_ = largest_speed_.cwiseMax(z_.segment(n, n).cwiseAbs());
}

// Of each element, the sum of a number over those of its bends that are beyond their places.
std::vector<double> Trajectory::bent(const Eigen::VectorXd& of_bends) const {
  std::vector<double> sum(system_.coefficients.size(), 0.0);
  for (Index j = 0; j < of_bends.size(); ++j) {
    if (contains(beyond_, j)) sum[system_.bends.element[static_cast<std::size_t>(j)]] += of_bends[j];
  }
  return sum;
}

const Trajectory::Ways& Trajectory::ways() const {
  if (ways_.known && ways_.stuck == stuck_ && ways_.beyond == beyond_) return ways_;
  const auto& eq = flow_.equations();
  const Index n = eq.masses();
  Eigen::VectorXd stiffness = Eigen::VectorXd::Zero(eq.internal_forces());
  Eigen::MatrixXd strained =
      mechanics::strained_combinations(assembly_, system_, bent(system_.bends.stiffness));
  for (Index j = 0; j < eq.contacts(); ++j) {
    if (!contains(stuck_, j)) continue;
    if (eq.holds(j)) {
      add_row(eq.W.col(j), strained);
    } else {
      const Index place = eq.internal_of[static_cast<std::size_t>(j)];
      stiffness[place] = eq.internal_stiffness[place];
      add_row(eq.D.col(place), strained);
    }
  }
  const Eigen::MatrixXd dampers =
      mechanics::damped_combinations(assembly_, system_, bent(system_.bends.damping));
  Eigen::MatrixXd all(strained.rows() + dampers.rows(), n);
  all << strained, dampers;
  const Eigen::VectorXd slack = (eq.internal_rate.array() > 0.0).select(eq.internal_rate.cwiseInverse(), 0.0);
  ways_ = {.known = true, .stuck = stuck_, .beyond = beyond_};
  ways_.free = mechanics::free_of(strained, eq.M);
  ways_.undamped = mechanics::free_of(all, eq.M);
  ways_.held = mechanics::beside(ways_.free, free_directions_, eq.M);
  ways_.damped = mechanics::beside(ways_.undamped, ways_.free, eq.M);
  ways_.K = eq.stiffness_beyond(beyond_ & ~eq.bends.of_velocity);
  ways_.C = eq.damping_beyond(beyond_) +
            eq.D * slack.cwiseProduct(eq.internal_stiffness).asDiagonal() * eq.D.transpose();
  const Eigen::MatrixXd K = ways_.K + eq.D * stiffness.asDiagonal() * eq.D.transpose();
  if (ways_.held.cols() > 0)
    ways_.compliance =
        ways_.held * algebra::inverse(ways_.held.transpose() * K * ways_.held) * ways_.held.transpose();
  if (ways_.damped.cols() > 0)
    ways_.admittance = ways_.damped * algebra::inverse(ways_.damped.transpose() * ways_.C * ways_.damped) *
                       ways_.damped.transpose();
  return ways_;
}

// As above, but some directions R of the masses that are not held strain nothing. Along these, while no force
// acts, the momentum and what dampers and Maxwell elements take up are constant,
//   R^T (M q' + C q - D s/rate + D (k/rate) D^T q) = const,
// which gives where the masses come to rest in those that are damped; in the others, U, they drift on with
// U^T M q'. Where a force acts along R, that of friction, the masses are still to be stopped: at rest where
// they are now is the best that can be said.
Trajectory::State Trajectory::resting_state_of_free(const State& z) const {
  constexpr double kRounding = 1e-11;  // of a momentum, after millions of steps
  const auto& eq = flow_.equations();
  const Ways& ways = this->ways();
  const Index n = eq.masses(), internal = eq.internal_forces();
  const Eigen::VectorXd q = z.head(n), v = z.segment(n, n), s_now = z.tail(internal);
  // If nothing sticks any start is right, and zero is free of rounding.
  const Eigen::VectorXd from = stuck_ == 0 ? Eigen::VectorXd(Eigen::VectorXd::Zero(n)) : q;
  const Eigen::VectorXd bent_force = eq.force_beyond(beyond_).col(0);
  Eigen::VectorXd pushed = bent_force, s = Eigen::VectorXd::Zero(internal), stiffness = s;
  double largest = bent_force.cwiseAbs().maxCoeff();
  for (Index j = 0; j < eq.contacts(); ++j) {
    const bool sticks = contains(stuck_, j);
    if (!sticks) {
      const Eigen::VectorXd friction = (contains(positive_, j) ? 1.0 : -1.0) * eq.limit[j] * eq.W.col(j);
      pushed -= friction;
      largest = std::max(largest, friction.cwiseAbs().maxCoeff());
    }
    if (eq.holds(j)) continue;
    const Index place = eq.internal_of[static_cast<std::size_t>(j)];
    s[place] = s_now[place];
    if (sticks) stiffness[place] = eq.internal_stiffness[place];
  }
  State rest = State::Zero(eq.states());

  // Beside R the springs decide.
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(n);
  if (ways.held.cols() > 0) {
    const Eigen::VectorXd of_sliders = (stiffness.array() > 0.0).select(s, 0.0);
    moved = ways.compliance * (pushed - ways.K * from - eq.D * of_sliders);
  }
  rest.tail(internal) = s + stiffness.cwiseProduct(eq.D.transpose() * moved);
  rest.head(n) = from + moved;
  const Eigen::MatrixXd& R = ways.free;
  if (R.cols() == 0) return rest;

  // Along R: where it is now, but for what dampers let go.
  rest.head(n) += R * (R.transpose() * (eq.M * (q - rest.head(n))));
  for (Index k = 0; k < R.cols(); ++k) {
    if (std::abs(R.col(k).dot(pushed)) > kRounding * largest * R.col(k).cwiseAbs().sum()) return rest;
  }
  for (Index k = 0; k < ways.undamped.cols(); ++k) {
    const auto u = ways.undamped.col(k);
    const double momentum = u.dot(eq.M * v), size = u.cwiseAbs().dot(eq.M.cwiseAbs() * largest_speed_);
    if (std::abs(momentum) > kRounding * size) rest.segment(n, n) += momentum * u;
  }
  if (ways.damped.cols() == 0) return rest;
  const Eigen::VectorXd slack = (eq.internal_rate.array() > 0.0).select(eq.internal_rate.cwiseInverse(), 0.0);
  rest.head(n) +=
      ways.admittance * (eq.M * v - eq.D * slack.cwiseProduct(s_now) - ways.C * (rest.head(n) - q));
  return rest;
}

// Of free masses: ordinary ones are held by springs of their own.
bool Trajectory::goes_on_freely() const {
  const auto& eq = flow_.equations();
  if (!eq.has_free_masses) return true;
  const Index n = eq.masses();
  const State end = tends_to();
  for (Index j = 0; j < eq.bends.count(); ++j) {
    if (contains(eq.bends.of_velocity, j)) continue;
    const bool is_beyond = contains(beyond_, j);
    const double past = eq.bends.B.col(j).dot(end.head(n)) - eq.bends.place[j];
    const double speed = eq.bends.B.col(j).dot(end.segment(n, n));
    if (is_beyond ? past < 0.0 || speed < 0.0 : past > 0.0 || speed > 0.0) return false;
  }
  return true;
}

Trajectory::State Trajectory::tends_to() const {
  return crept_ ? creeps_to_ : resting_state(z_);
}

double Trajectory::distance_from_rest() const {
  const auto& eq = flow_.equations();
  const State away = z_ - resting_state(z_);
  if (!eq.has_free_masses) return eq.energy_norm(away);
  // What is bent holds too.
  const Eigen::VectorXd q = away.head(eq.masses());
  const Eigen::MatrixXd K_bends =
      eq.stiffness_beyond(beyond_ & ~eq.bends.of_velocity) - Eigen::MatrixXd(eq.K);
  return std::hypot(eq.energy_norm(away), std::sqrt(std::max(0.0, 0.5 * q.dot(K_bends * q))));
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
