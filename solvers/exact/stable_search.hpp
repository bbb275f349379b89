#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "solvers/algebra/no_value.hpp"
#include "solvers/exact/rest_search.hpp"
#include "solvers/exact/scattered_state.hpp"
#include "solvers/exact/stable_orbits.hpp"
#include "solvers/mechanics/undamped_resonance.hpp"
#include "solvers/orbits/certificate.hpp"
#include "solvers/orbits/period_multiple.hpp"
#include "solvers/orbits/reasons.hpp"
#include "solvers/orbits/shooting.hpp"

namespace frahm::periodic {

// Finds stable orbits of systems whose laws are not all monotone, near a state or by following the motion
// from it. The flow is set to the system each time, and again when an orbit took a multiple of its period.
template <int N, int H>
class StableSearch {
 public:
  using S = Sizes<N, H>;
  using Orbits = StableOrbits<N, H>;
  using Index = std::optional<std::size_t>;  // in Orbits::stable

  // Periods that a motion is followed for at most.
  static constexpr int kOfStart = 324;      // one of many
  static constexpr int kOfSlowSweep = 972;  // just beyond a fold it lingers where the orbit was

  // Both must outlive the search.
  StableSearch(const mechanics::Assembly& assembly, Flow<N, H>& flow, int most_multiple)
      : forms_(assembly, flow),
        flow_(flow),
        walk_(flow),
        shooting_(flow),
        steps_(flow),
        rest_(assembly, flow),
        most_multiple_(most_multiple) {}

  // Sets the flow to the frequency of `system`. Nothing is found yet.
  Orbits begin(const mechanics::LinearSystem& system) {
    flow_.set_forcing(system);
    Orbits found;
    found.step = flow_.equations().step;
    found.masses = flow_.equations().masses();
    found.large_ones_grow = is_unbounded(system, undamped_modes(system));
    if (flow_.equations().period > ShootingOptions{}.most_steps_a_period) found.failure = kTooManySteps;
    return found;
  }
  // Whether a state is far beyond what drives it. Where large motions grow, there is no orbit: what a period
  // adds is then lost in rounding.
  bool is_huge(const typename S::State& z) const {
    constexpr double kHuge = 1e6;  // of the static response
    return !(flow_.equations().energy_norm(z) <= kHuge * flow_.static_norm());
  }
  // A state that counts the time in `step` [s], at the flow's frequency.
  typename S::State in_steps(typename S::State z, double step) const {
    const Eigen::Index n = flow_.equations().masses();
    z.segment(n, n) *= flow_.equations().step / step;
    return z;
  }

  // The stable orbit to which Newton's method leads from here; it is added to `found`.
  Index find_near(const typename S::State& z, int multiple, const mechanics::LinearSystem& system,
                  Orbits& found) {
    return approach(z, multiple, system, found).orbit;
  }
  // The stable orbit to which the motion from z comes within so many periods; it is added too. z becomes the
  // motion's end.
  Index follow(typename S::State& z, int longest, const mechanics::LinearSystem& system, Orbits& found);
  // Adds the mirror image -z(t + T/2) of each stable orbit that is not its own, where it is an orbit too.
  void add_mirrors(const mechanics::LinearSystem& system, Orbits& found);
  // The orbit once more, in its own multiple of the period, to which the flow is left set.
  void tell(const mechanics::LinearSystem& system, const Orbits& found, std::size_t which,
            Orbit<N, H>& orbit);

  // Whether a motion that was given up grows: where large ones do, one that slides through a whole period
  // takes in more than friction takes out, and does so the more from then on.
  bool grows(const Orbits& found);

  // The motion from z over kMotion periods, as if it were an orbit of that multiple, to which the flow is
  // left set; the status of `orbit` stays.
  void tell_motion(const mechanics::LinearSystem& system, const typename S::State& z, Orbit<N, H>& orbit);
  static constexpr int kMotion = 64;  // several of the slow beats that motions without period show

  // Relative to the orbit's size or the static response, energy norm.
  double distance(const typename S::State& z, const StableOrbit<N, H>& orbit) const;

 private:
  struct Approach {
    Index orbit;
    double moved = 0.0;  // by Newton's method, before contacts were brought to rest; as distance()
  };
  Approach approach(const typename S::State& z, int multiple, const mechanics::LinearSystem& system,
                    Orbits& found);
  void coast(typename S::State& z) const;
  bool is_over(Orbits& found) const;
  Index known(const typename S::State& z, double within, const Orbits& found) const;
  int likely_multiple(const std::vector<typename S::State>& trail) const;
  void bring_to_rest(Orbit<N, H>& orbit, int& passages);
  Sequence sequence_of(const Orbit<N, H>& orbit) const;
  Index of_known_family(const StableOrbit<N, H>& orbit, const Orbits& found) const;
  bool is_stable(const Orbit<N, H>& orbit, const Orbit<N, H>& as_found, Orbits& found);
  bool is_edge_of_stable_family(const Orbit<N, H>& orbit, const Orbit<N, H>& as_found);
  bool dies_out(const typename S::State& by, const Orbit<N, H>& orbit, Orbits& found);
  double peak(const Orbit<N, H>& orbit);
  Index keep(const Orbit<N, H>& orbit, StableOrbit<N, H> kept, Orbits& found);

  Forms<N, H> forms_;
  Flow<N, H>& flow_;
  Walk<N, H> walk_;
  Shooting<N, H> shooting_;
  OrbitSteps<N, H> steps_;
  RestSearch<N, H> rest_;
  int most_multiple_;
  Passage<N, H> passage_;
};

template <int N, int H>
typename StableSearch<N, H>::Index StableSearch<N, H>::follow(typename S::State& z, int longest,
                                                              const mechanics::LinearSystem& system,
                                                              Orbits& found) {
  constexpr double kNear = 0.02, kThere = 1e-4;
  coast(z);
  std::vector<typename S::State> trail{z};
  int periods = 0;
  for (int at = 4; at <= longest; at *= 3) {
    for (; periods < at; ++periods) {
      if (is_over(found)) return std::nullopt;
      walk_.pass(z, 0.0, flow_.equations().period, passage_, Tangent::none);
      ++found.passages;
      if (passage_.failure != nullptr) return std::nullopt;
      z = passage_.end;
      trail.push_back(z);
      if (const Index there = known(z, kThere, found)) return there;
    }
    const auto [near, moved] = approach(z, likely_multiple(trail), system, found);
    if (near && (moved < kNear || distance(z, found.stable[*near]) < kNear)) return near;
  }
  return std::nullopt;
}

// Velocities that nothing takes up do not change but by the forcing: they begin as their orbit has them.
template <int N, int H>
void StableSearch<N, H>::coast(typename S::State& z) const {
  const StepEquations<N, H>& eq = flow_.equations();
  if (!eq.has_free_masses) return;
  typename S::Oscillators u(eq.oscillators());
  eq.oscillators_at(0.0, flow_.orders(), u);
  typename S::State residual = S::State::Zero(eq.states());
  Closing(eq.free, 0).apply(z, u, residual);
  z += residual;
}

// Whether all motions of a point together have taken the work that it may take.
template <int N, int H>
bool StableSearch<N, H>::is_over(Orbits& found) const {
  if (found.failure == nullptr && flow_.work().is_over()) found.failure = kSearchIsLong;
  return found.failure != nullptr;
}

// The multiple of the period after which the motion comes back closest.
template <int N, int H>
int StableSearch<N, H>::likely_multiple(const std::vector<typename S::State>& trail) const {
  constexpr double kMuchCloser = 0.2, kRounding = 1e-9;
  const auto gap = [&](int m) {
    return flow_.equations().energy_norm(trail.back() -
                                         trail[trail.size() - 1 - static_cast<std::size_t>(m)]);
  };
  const int most = std::min(most_multiple_, static_cast<int>(trail.size()) - 1);
  int best = 1;
  for (int m = 2; m <= most; ++m) {
    const bool is_back = gap(best) < kRounding * flow_.energy_scale(trail.back());
    if (!is_back && gap(m) < kMuchCloser * gap(best)) best = m;
  }
  return best;
}

template <int N, int H>
typename StableSearch<N, H>::Approach StableSearch<N, H>::approach(const typename S::State& z, int multiple,
                                                                   const mechanics::LinearSystem& system,
                                                                   Orbits& found) {
  if (is_over(found)) return {};
  Approach result;
  Orbit<N, H> orbit;
  orbit.z = z;
  orbit.multiple = multiple;
  if (multiple > 1) flow_.set_forcing(over_multiple(system, multiple));
  shooting_.find(orbit);
  found.passages += multiple * orbit.passages;
  found.newton_iterations += orbit.newton_iterations;
  bool stable = false;
  if (orbit.is_found() && !(found.large_ones_grow && is_huge(orbit.z))) {
    result.moved = flow_.equations().energy_norm(orbit.z - z) / flow_.energy_scale(orbit.z);
    Orbit<N, H> as_found;
    if (orbit.stuck_throughout != 0) {
      as_found = orbit;
      bring_to_rest(orbit, found.passages);
    }
    judge_stability(flow_, orbit);
    stable = is_stable(orbit, as_found, found);
    found.found_unstable = found.found_unstable || !stable;
  }
  StableOrbit<N, H> kept{.returns = {orbit.z}, .stuck_throughout = orbit.stuck_throughout};
  if (stable) {
    kept.peak = peak(orbit);
    kept.sequence = sequence_of(orbit);
  }
  if (multiple > 1) flow_.set_forcing(system);
  if (stable) result.orbit = keep(orbit, std::move(kept), found);
  return result;
}

// Moves an orbit with contacts that stick throughout to its rest position. The shift leaves the rest of the
// motion as it is, but where stops or springs bend: there the whole family of orbits is searched. Where that
// fails, as in loops of contacts, the orbit is found again from the shifted one, until both agree. Where they
// do not, or the contacts then slip, it stays where it was found.
template <int N, int H>
void StableSearch<N, H>::bring_to_rest(Orbit<N, H>& orbit, int& passages) {
  constexpr int kMostShifts = 30;
  constexpr double kAgrees = 1e-10;  // of the orbit's size
  if (flow_.equations().bends.count() == 0) {
    rest_.shift(orbit);
    return;
  }
  if (rest_.shift_bent(orbit, passages)) return;
  const Orbit<N, H> as_found = orbit;
  for (int shift = 0; shift < kMostShifts; ++shift) {
    const typename S::State before = orbit.z;
    rest_.shift(orbit);
    const double moved = flow_.equations().energy_norm(orbit.z - before);
    if (moved == 0.0) return;
    const Status status = orbit.status;  // grazing, where a force is at its limit
    shooting_.find(orbit);
    passages += orbit.multiple * orbit.passages;
    if (!orbit.is_found() || orbit.stuck_throughout != as_found.stuck_throughout) break;
    if (status == Status::grazing) orbit.status = status;
    if (moved <= kAgrees * flow_.energy_scale(orbit.z)) return;
  }
  orbit = as_found;
}

template <int N, int H>
Sequence StableSearch<N, H>::sequence_of(const Orbit<N, H>& orbit) const {
  Sequence sequence;
  for (const Segment<N, H>& segment : orbit.passage.segments)
    sequence.emplace_back(flow_.mode(segment.mode).stuck, flow_.mode(segment.mode).beyond);
  return sequence;
}

// Contacts that stick throughout may rest anywhere in an interval, and where stops are touched the motion
// differs from place to place: orbits that pass through the same states are then one.
template <int N, int H>
typename StableSearch<N, H>::Index StableSearch<N, H>::of_known_family(const StableOrbit<N, H>& orbit,
                                                                       const Orbits& found) const {
  if (orbit.stuck_throughout == 0 || flow_.equations().bends.count() == 0) return std::nullopt;
  for (std::size_t i = 0; i < found.stable.size(); ++i) {
    const StableOrbit<N, H>& other = found.stable[i];
    if (other.multiple() == orbit.multiple() && other.stuck_throughout == orbit.stuck_throughout &&
        other.sequence == orbit.sequence)
      return i;
  }
  return std::nullopt;
}

// Where an event only just happens, or a contact at rest only just holds, the multipliers do not exist or say
// nothing of the motions next to the orbit on one side; they are followed. as_found: the orbit before its
// contacts that stick throughout were brought to rest.
template <int N, int H>
bool StableSearch<N, H>::is_stable(const Orbit<N, H>& orbit, const Orbit<N, H>& as_found, Orbits& found) {
  constexpr double kSmall = 1e-4;
  const bool has_kink = orbit.status == Status::grazing || std::isnan(orbit.floquet_radius);
  if (!has_kink) return orbit.is_stable();
  if (is_edge_of_stable_family(orbit, as_found)) return true;
  if (known(orbit.z, kSmall, found)) return true;  // judged before
  for (const int index : {1, 2}) {
    const typename S::State by = disturbance(flow_, orbit.z, kSmall, index);
    if (!dies_out(by, orbit, found) || !dies_out(-by, orbit, found)) return false;
  }
  return true;
}

// Contacts that stick throughout may rest anywhere in an interval, and the rule may put them at its edge.
// What is beyond it says nothing of the motions that rest inside, which are judged in its place: a static
// force that just breaks away may throw the motion far, to rest at another place of the same family.
template <int N, int H>
bool StableSearch<N, H>::is_edge_of_stable_family(const Orbit<N, H>& orbit, const Orbit<N, H>& as_found) {
  if (orbit.stuck_throughout == 0) return false;
  Orbit<N, H> inside = as_found;
  if (inside.status == Status::grazing && !rest_.shift_to_middle(inside)) return false;
  if (inside.status == Status::grazing) return false;
  judge_stability(flow_, inside);
  return inside.is_stable();
}

// Whether the motion next to an orbit comes closer to it. The rest positions of contacts that stick
// throughout do not count.
template <int N, int H>
bool StableSearch<N, H>::dies_out(const typename S::State& by, const Orbit<N, H>& orbit, Orbits& found) {
  constexpr double kGone = 0.1, kGrown = 10.0;
  const StepEquations<N, H>& eq = flow_.equations();
  const Eigen::MatrixXd rest = shift_projector(rest_directions(eq, orbit.stuck_throughout));
  const auto size = [&](typename S::State off) {
    if (orbit.stuck_throughout != 0) off -= (rest * off).eval();
    return eq.energy_norm(off);
  };
  const double first = size(by);
  double now = first;
  typename S::State z = orbit.z + by;
  for (int times = 0; times < kOfStart && now > kGone * first; ++times) {
    walk_.pass(z, 0.0, eq.period, passage_, Tangent::none);
    found.passages += orbit.multiple;
    if (passage_.failure != nullptr) return false;
    z = passage_.end;
    now = size(z - orbit.z);
    if (now > kGrown * first) return false;
  }
  return now < first;
}

template <int N, int H>
double StableSearch<N, H>::peak(const Orbit<N, H>& orbit) {
  LinearForm<N, H> form = forms_.zero();
  form.z[0] = 1.0;
  steps_.lay_out(orbit);
  return find_extremes(steps_, flow_, orbit.section, [&](const Mode<N, H>&) { return form; }).magnitude();
}

// Adds a stable orbit to those known. None where a multiple of the period is that of a shorter orbit.
template <int N, int H>
typename StableSearch<N, H>::Index StableSearch<N, H>::keep(const Orbit<N, H>& orbit, StableOrbit<N, H> kept,
                                                            Orbits& found) {
  constexpr double kSame = 1e-7;
  if (const Index same = known(orbit.z, kSame, found)) return same;
  for (int m = 1; m < orbit.multiple; ++m) {
    walk_.pass(kept.returns.back(), 0.0, flow_.equations().period, passage_, Tangent::none);
    ++found.passages;
    if (passage_.failure != nullptr) return std::nullopt;
    const double gap = flow_.equations().energy_norm(passage_.end - orbit.z);
    if (gap < kSame * flow_.energy_scale(orbit.z)) return std::nullopt;
    kept.returns.push_back(passage_.end);
  }
  if (const Index family = of_known_family(kept, found)) return family;
  found.stable.push_back(std::move(kept));
  return found.stable.size() - 1;
}

// Under odd forcing, where the laws are odd too: whether they are, the motion from there shows, which closes.
template <int N, int H>
void StableSearch<N, H>::add_mirrors(const mechanics::LinearSystem& system, Orbits& found) {
  constexpr double kSame = 1e-7;
  if (!system.odd_forcing) return;
  const double period = flow_.equations().period;
  const std::size_t count = found.stable.size();
  for (std::size_t i = 0; i < count && found.failure == nullptr; ++i) {
    const int multiple = found.stable[i].multiple();
    walk_.pass(found.stable[i].returns.front(), 0.0, 0.5 * period, passage_, Tangent::none);
    ++found.passages;
    if (passage_.failure != nullptr) continue;
    const typename S::State mirrored = -passage_.end;
    if (known(mirrored, kSame, found)) continue;
    typename S::State z = mirrored;
    for (int m = 0; m < multiple && passage_.failure == nullptr; ++m, ++found.passages) {
      walk_.pass(z, 0.0, period, passage_, Tangent::none);
      z = passage_.end;
    }
    const double gap = flow_.equations().energy_norm(z - mirrored);
    if (passage_.failure != nullptr || !(gap < kSame * flow_.energy_scale(mirrored))) continue;
    const std::size_t before = found.stable.size();
    find_near(mirrored, multiple, system, found);
    // The same peak, so that of the pair the one that was found first counts as the larger.
    if (found.stable.size() > before) found.stable.back().peak = found.stable[i].peak;
  }
}

template <int N, int H>
void StableSearch<N, H>::tell(const mechanics::LinearSystem& system, const Orbits& found, std::size_t which,
                              Orbit<N, H>& orbit) {
  flow_.work().begin();
  const StableOrbit<N, H>& reported = found.stable[which];
  orbit = {};
  orbit.z = reported.returns.front();
  orbit.multiple = reported.multiple();
  if (orbit.multiple > 1) flow_.set_forcing(over_multiple(system, orbit.multiple));
  shooting_.find(orbit);
  int passages = orbit.passages + found.passages;
  if (orbit.stuck_throughout != 0) bring_to_rest(orbit, passages);
  judge_stability(flow_, orbit);
  orbit.passages = passages;
  orbit.newton_iterations += found.newton_iterations;
}

template <int N, int H>
bool StableSearch<N, H>::grows(const Orbits& found) {
  if (!found.large_ones_grow || flow_.equations().bends.count() > 0) return false;
  return std::ranges::any_of(found.unsettled, [&](const typename S::State& z) {
    walk_.pass(z, 0.0, flow_.equations().period, passage_, Tangent::none);
    return passage_.failure == nullptr &&
           std::ranges::all_of(passage_.segments,
                               [&](const Segment<N, H>& each) { return flow_.mode(each.mode).stuck == 0; });
  });
}

template <int N, int H>
void StableSearch<N, H>::tell_motion(const mechanics::LinearSystem& system, const typename S::State& z,
                                     Orbit<N, H>& orbit) {
  flow_.work().begin();
  flow_.set_forcing(over_multiple(system, kMotion));
  orbit.z = z;
  orbit.section = 0.0;
  orbit.half_period = false;
  orbit.multiple = kMotion;
  orbit.stuck_throughout = 0;
  orbit.contraction = orbit.error_bound = orbit.floquet_radius = kNone;
  walk_.pass(z, 0.0, flow_.equations().period, orbit.passage, Tangent::none);
}

template <int N, int H>
double StableSearch<N, H>::distance(const typename S::State& z, const StableOrbit<N, H>& orbit) const {
  double least = HUGE_VAL;
  for (const auto& state : orbit.returns)
    least = std::min(least, flow_.equations().energy_norm(z - state) / flow_.energy_scale(state));
  return least;
}

template <int N, int H>
typename StableSearch<N, H>::Index StableSearch<N, H>::known(const typename S::State& z, double within,
                                                             const Orbits& found) const {
  for (std::size_t i = 0; i < found.stable.size(); ++i) {
    if (distance(z, found.stable[i]) < within) return i;
  }
  return std::nullopt;
}

}  // namespace frahm::periodic
