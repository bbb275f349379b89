#pragma once

#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "solvers/algebra/no_value.hpp"
#include "solvers/exact/rest_search.hpp"
#include "solvers/mechanics/undamped_resonance.hpp"
#include "solvers/orbits/certificate.hpp"
#include "solvers/orbits/continuation.hpp"
#include "solvers/orbits/reasons.hpp"
#include "solvers/orbits/runaway.hpp"

namespace frahm::periodic {

// Finds the periodic orbit of a system that has one alone: continuation and shooting, the rest position of
// contacts that stick throughout, and the certificate. Where there may be several: coexistence.hpp,
// slow_sweep.hpp.
template <int N, int H>
class OrbitSearch {
 public:
  // Both must outlive the search.
  OrbitSearch(const mechanics::Assembly& assembly, Flow<N, H>& flow)
      : assembly_(assembly), flow_(flow), continuation_(flow), rest_(assembly, flow) {}

  void forget() { continuation_.forget(); }
  void begin_row() { continuation_.begin_row(); }

  // Whether a system has one orbit at most.
  static bool serves(const mechanics::Assembly& assembly, const mechanics::LinearSystem& system,
                     const std::vector<UndampedMode>& undamped) {
    return system.monotone || !why_none(assembly, system, undamped).empty();
  }
  // Finds the orbit of the flow, which is set to `system`. certify: also multipliers and error bound.
  void find(const mechanics::LinearSystem& system, const std::vector<UndampedMode>& undamped, bool certify,
            Orbit<N, H>& orbit);

  // The same in another of kOtherWays, after `orbit` has failed a check. False, with `orbit` unchanged, if
  // this way finds none.
  static constexpr int kOtherWays = 2;
  bool find_otherwise(int way, const mechanics::LinearSystem& system, bool certify, Orbit<N, H>& orbit);

 private:
  void fail_unbounded(const std::string& reason, Orbit<N, H>& orbit);
  // "" where there may be an orbit.
  static std::string why_none(const mechanics::Assembly& assembly, const mechanics::LinearSystem& system,
                              const std::vector<UndampedMode>& undamped) {
    if ((system.monotone || system.bends.count() == 0) && is_unbounded_even_held(system, undamped))
      return kUnbounded;
    return runaway(assembly, system);
  }

  const mechanics::Assembly& assembly_;
  Flow<N, H>& flow_;
  Continuation<N, H> continuation_;
  RestSearch<N, H> rest_;
};

template <int N, int H>
void OrbitSearch<N, H>::find(const mechanics::LinearSystem& system, const std::vector<UndampedMode>& undamped,
                             bool certify, Orbit<N, H>& orbit) {
  if (const std::string reason = why_none(assembly_, system, undamped); !reason.empty())
    return fail_unbounded(reason, orbit);
  continuation_.find(system, orbit);
  rest_.settle(orbit);
  if (certify && orbit.is_found()) judge_stability(flow_, orbit);
}

// Way 0: contacts that stick for most of the period are held. Way 1: the search starts from the response
// without friction, as if no orbit were known, at a section a quarter of a period later.
template <int N, int H>
bool OrbitSearch<N, H>::find_otherwise(int way, const mechanics::LinearSystem& system, bool certify,
                                       Orbit<N, H>& orbit) {
  if (way == 0) {
    const ContactMask held = rest_.sliding_less_than(0.5, orbit);
    if (held == 0 || orbit.half_period || !rest_.try_held(held, orbit)) return false;
  } else {
    Orbit<N, H> other = orbit;
    continuation_.forget();
    continuation_.find_from(0.5 * std::numbers::pi, system, other);
    rest_.settle(other);
    if (!other.is_found()) return false;
    std::swap(orbit, other);
  }
  if (certify) judge_stability(flow_, orbit);
  return true;
}

template <int N, int H>
void OrbitSearch<N, H>::fail_unbounded(const std::string& reason, Orbit<N, H>& orbit) {
  orbit.status = Status::unbounded;
  orbit.reason = reason;
  orbit.residual = kNone;
  orbit.newton_iterations = orbit.passages = 0;
  continuation_.forget();
}

// Each once, in sized_solver_<N>_<H>.cpp.
extern template class OrbitSearch<1, 1>;
extern template class OrbitSearch<2, 1>;
extern template class OrbitSearch<Eigen::Dynamic, Eigen::Dynamic>;

}  // namespace frahm::periodic
