#pragma once

#include <numbers>

#include "solvers/algebra/no_value.hpp"
#include "solvers/exact/stable_search.hpp"
#include "solvers/orbits/reasons.hpp"

namespace frahm::periodic {

// The motion that a slow sweep is on, of a system whose laws are not all monotone: a stable orbit as long as
// it goes on; where it ends, the one to which the motion from there comes. The sweep begins at rest.
template <int N, int H>
class SlowSweep {
 public:
  using S = Sizes<N, H>;

  // Both must outlive the sweep.
  SlowSweep(const mechanics::Assembly& assembly, Flow<N, H>& flow, int most_multiple)
      : flow_(flow), walk_(flow), search_(assembly, flow, most_multiple), most_multiple_(most_multiple) {}

  void begin() { has_begun_ = is_on_orbit_ = false; }  // at rest
  bool is_on_orbit() const { return is_on_orbit_; }

  // The flow is set to `system` but for its frequency. Whether the orbit goes on there: Newton's method leads
  // from it to a stable one close by.
  bool go_on(const mechanics::LinearSystem& system);
  // Follows the motion from where the orbit ended, slightly disturbed, or from rest.
  void follow(const mechanics::LinearSystem& system);
  // The only response there is: the sweep is on it.
  void stand_on(const Orbit<N, H>& orbit);
  // Sets `orbit` to the one it is on; the flow is then set to its multiple of the period.
  void tell(const mechanics::LinearSystem& system, Orbit<N, H>& orbit);

 private:
  void stand_at(const typename S::State& z, bool is_on_orbit);

  Flow<N, H>& flow_;
  Walk<N, H> walk_;
  StableSearch<N, H> search_;
  int most_multiple_;

  bool has_begun_ = false, is_on_orbit_ = false;
  typename S::State z_;  // of the motion, at phase 0
  double step_ = 0.0;    // [s], in which it counts the time
  int multiple_ = 1;
  int passages_ = 0, newton_iterations_ = 0;  // since the last orbit that was reported
  StableOrbits<N, H> found_;                  // at this frequency
  std::size_t on_ = 0;                        // of those
  Passage<N, H> passage_;
};

template <int N, int H>
bool SlowSweep<N, H>::go_on(const mechanics::LinearSystem& system) {
  constexpr double kClose = 0.1;  // of its size; a longer way is to be taken in shorter steps
  found_ = search_.begin(system);
  const typename S::State z = search_.in_steps(z_, step_);
  const auto near = search_.find_near(z, multiple_, system, found_);
  passages_ += found_.passages;
  newton_iterations_ += found_.newton_iterations;
  if (!near || search_.distance(z, found_.stable[*near]) > kClose) return false;
  on_ = *near;
  multiple_ = found_.stable[on_].multiple();
  stand_at(found_.stable[on_].returns.front(), true);
  return true;
}

template <int N, int H>
void SlowSweep<N, H>::follow(const mechanics::LinearSystem& system) {
  constexpr double kSlight = 1e-3;  // so that the motion leaves an orbit that has become unstable
  found_ = search_.begin(system);
  typename S::State z = S::State::Zero(flow_.equations().states());
  if (has_begun_) z = search_.in_steps(z_, step_);
  if (is_on_orbit_) z += disturbance(flow_, z, kSlight, 1);
  const auto there = search_.follow(z, search_.kOfSlowSweep, system, found_);
  passages_ += found_.passages;
  newton_iterations_ += found_.newton_iterations;
  if (there) {
    on_ = *there;
    multiple_ = found_.stable[on_].multiple();
    z = found_.stable[on_].returns.front();
  }
  stand_at(z, there.has_value());
}

// On to phase 0 of the next period.
template <int N, int H>
void SlowSweep<N, H>::stand_on(const Orbit<N, H>& orbit) {
  typename S::State z = orbit.z;
  if (orbit.section != 0.0) {
    const double steps = (2.0 * std::numbers::pi - orbit.section) / flow_.fundamental_rate();
    walk_.pass(orbit.z, orbit.section, steps, passage_, Tangent::none);
    if (passage_.failure == nullptr) z = passage_.end;
  }
  multiple_ = 1;
  stand_at(z, true);
}

template <int N, int H>
void SlowSweep<N, H>::stand_at(const typename S::State& z, bool is_on_orbit) {
  has_begun_ = true;
  is_on_orbit_ = is_on_orbit;
  z_ = z;
  step_ = flow_.equations().step;
}

template <int N, int H>
void SlowSweep<N, H>::tell(const mechanics::LinearSystem& system, Orbit<N, H>& orbit) {
  if (is_on_orbit_) {
    search_.tell(system, found_, on_, orbit);
    orbit.passages += passages_ - found_.passages;
    orbit.newton_iterations += newton_iterations_ - found_.newton_iterations;
  } else {
    orbit = {};
    orbit.status = found_.failure != nullptr ? Status::failed : Status::not_periodic;
    orbit.reason =
        found_.failure != nullptr ? found_.failure : not_settled(search_.kOfSlowSweep, most_multiple_);
    orbit.residual = kNone;
    orbit.coexisting = 0;
    orbit.passages = passages_;
    orbit.newton_iterations = newton_iterations_;
  }
  passages_ = newton_iterations_ = 0;
}

}  // namespace frahm::periodic
