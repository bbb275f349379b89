#pragma once

#include <algorithm>

#include "solvers/algebra/no_value.hpp"
#include "solvers/exact/stable_search.hpp"
#include "solvers/mechanics/steady_response.hpp"
#include "solvers/orbits/orbits_wanted.hpp"
#include "solvers/orbits/reasons.hpp"

// Orbits of a system whose laws are not all monotone: several may be stable, some take a multiple of the
// forcing's period, and none may be periodic at all. The search follows motions from many starts until they
// come near an orbit, which Newton's method then finds, and continues the orbits of neighbouring points. It
// may miss one.
namespace frahm::periodic {

template <int N, int H>
class Coexistence {
 public:
  using S = Sizes<N, H>;
  using Orbits = StableOrbits<N, H>;

  // Both must outlive the search.
  Coexistence(const mechanics::Assembly& assembly, Flow<N, H>& flow, const OrbitsWanted& wanted = {})
      : flow_(flow), search_(assembly, flow, wanted.most_multiple), wanted_(wanted) {}

  // From those of the point before, null where there is none, and from the starts; the flow is set to
  // `system` but for its frequency.
  Orbits find(const mechanics::LinearSystem& system, const Orbits* before);
  // Adds to `found`, which are those of `system`, the ones to which those of the point after lead.
  void add(const mechanics::LinearSystem& system, const Orbits& after, Orbits& found);
  // Sets `orbit` to the one to be reported; the flow is then set to its multiple of the period.
  void tell(const mechanics::LinearSystem& system, const Orbits& found, Orbit<N, H>& orbit);
  // The same for any of those found; if none was, of a motion that did not settle, over kMotion periods.
  void tell(const mechanics::LinearSystem& system, const Orbits& found, std::size_t which,
            Orbit<N, H>& orbit);

 private:
  typename S::State start(int index, bool large_ones_grow, const mechanics::LinearSystem& system) const;
  void continue_from(const Orbits& neighbours, const mechanics::LinearSystem& system, Orbits& found);

  Flow<N, H>& flow_;
  StableSearch<N, H> search_;
  OrbitsWanted wanted_;
};

template <int N, int H>
StableOrbits<N, H> Coexistence<N, H>::find(const mechanics::LinearSystem& system, const Orbits* before) {
  Orbits found = search_.begin(system);
  if (before != nullptr) continue_from(*before, system, found);
  for (int i = 0; found.failure == nullptr && i < wanted_.starts; ++i) {
    typename S::State z = start(i, found.large_ones_grow, system);
    if (!search_.follow(z, search_.kOfStart, system, found)) found.unsettled.push_back(z);
    if (found.failure != nullptr) found.not_followed = wanted_.starts - 1 - i;
  }
  search_.add_mirrors(system, found);
  return found;
}

template <int N, int H>
void Coexistence<N, H>::add(const mechanics::LinearSystem& system, const Orbits& after, Orbits& found) {
  search_.begin(system);
  continue_from(after, system, found);
  search_.add_mirrors(system, found);
}

template <int N, int H>
void Coexistence<N, H>::continue_from(const Orbits& neighbours, const mechanics::LinearSystem& system,
                                      Orbits& found) {
  for (const StableOrbit<N, H>& each : neighbours.stable)
    search_.find_near(search_.in_steps(each.returns.front(), neighbours.step), each.multiple(), system,
                      found);
}

template <int N, int H>
void Coexistence<N, H>::tell(const mechanics::LinearSystem& system, const Orbits& found, Orbit<N, H>& orbit) {
  if (found.stable.empty()) {
    orbit = {};
    if (found.failure != nullptr) {
      orbit.status = Status::failed;
      orbit.reason = found.failure;
    } else if (search_.grows(found)) {
      orbit.status = Status::unbounded;
      orbit.reason = kUnbounded;
    } else {
      orbit.status = Status::not_periodic;
      orbit.reason = none_stable(wanted_.starts, wanted_.most_multiple, found.found_unstable);
    }
    orbit.residual = kNone;
    orbit.coexisting = 0;
    orbit.unsettled = found.starts_unsettled();
    orbit.passages = found.passages;
    orbit.newton_iterations = found.newton_iterations;
    return;
  }
  const double sign = wanted_.show == OrbitsWanted::Show::smallest ? -1.0 : 1.0;
  const auto reported = std::ranges::max_element(
      found.stable, {}, [&](const StableOrbit<N, H>& each) { return sign * each.peak; });
  tell(system, found, static_cast<std::size_t>(reported - found.stable.begin()), orbit);
}

template <int N, int H>
void Coexistence<N, H>::tell(const mechanics::LinearSystem& system, const Orbits& found, std::size_t which,
                             Orbit<N, H>& orbit) {
  if (found.stable.empty()) return search_.tell_motion(system, found.unsettled[which], orbit);
  search_.tell(system, found, which, orbit);
  orbit.coexisting = static_cast<int>(found.stable.size());
  orbit.unsettled = found.starts_unsettled();
  if (orbit.coexisting > 1 && orbit.status == Status::ok) orbit.status = Status::several;
}

// The linear response, rest, and states of several times their displacements and the places of the bends.
template <int N, int H>
typename Sizes<N, H>::State Coexistence<N, H>::start(int index, bool large_ones_grow,
                                                     const mechanics::LinearSystem& system) const {
  constexpr double kReach[] = {1.5, 4.0, 8.0};
  const StepEquations<N, H>& eq = flow_.equations();
  const Eigen::Index n = eq.masses();
  typename S::State z = mechanics::steady_response(system, 0.0);
  z.segment(n, n) *= eq.step;
  if (!z.allFinite() || (large_ones_grow && search_.is_huge(z))) z.setZero();
  if (index == 0) return z;
  const double places = eq.bends.count() > 0 ? eq.bends.place.cwiseAbs().maxCoeff() : 0.0;
  const double at_rest = (eq.K_inverse * eq.force).cwiseAbs().rowwise().sum().maxCoeff();
  const double size = std::max({z.head(n).cwiseAbs().maxCoeff(), places, at_rest});
  z.setZero();
  return index == 1 ? z : scattered(flow_, index, size * kReach[index % 3]);
}

// Each once, in sized_solver_<N>_<H>.cpp.
extern template class Coexistence<1, 1>;
extern template class Coexistence<2, 1>;
extern template class Coexistence<Eigen::Dynamic, Eigen::Dynamic>;

}  // namespace frahm::periodic
