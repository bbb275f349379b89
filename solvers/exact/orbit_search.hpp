#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "solvers/algebra/no_value.hpp"
#include "solvers/flow/linear_form.hpp"
#include "solvers/mechanics/undamped_resonance.hpp"
#include "solvers/orbits/certificate.hpp"
#include "solvers/orbits/coexistence.hpp"
#include "solvers/orbits/continuation.hpp"
#include "solvers/orbits/reasons.hpp"
#include "solvers/orbits/rest_position.hpp"
#include "solvers/quantities/extremes.hpp"
#include "solvers/quantities/integrals.hpp"
#include "solvers/quantities/orbit_steps.hpp"

namespace frahm::periodic {

// Finds the periodic orbit of a system: continuation and shooting, the rest position of contacts that stick
// throughout, and the certificate.
template <int N, int H>
class OrbitSearch {
 public:
  // Both must outlive the search.
  OrbitSearch(const mechanics::Assembly& assembly, Flow<N, H>& flow, const OrbitsWanted& wanted = {})
      : forms_(assembly, flow),
        flow_(flow),
        continuation_(flow),
        shooting_(flow),
        steps_(flow),
        coexistence_(
            flow, [this](Orbit<N, H>& orbit) { settle_rest_position(orbit); },
            [this](const Orbit<N, H>& orbit) { return first_peak(orbit); }, wanted) {}

  void forget() {
    continuation_.forget();
    coexistence_.forget();
  }
  void begin_row() {
    continuation_.begin_row();
    coexistence_.forget();
  }

  // Finds the orbit of the flow, which is set to `system`. certify: also multipliers and error bound.
  void find(const mechanics::LinearSystem& system, const std::vector<UndampedMode>& undamped, bool certify,
            Orbit<N, H>& orbit);

  // The same in another of kOtherWays, after `orbit` has failed a check. False, with `orbit` unchanged, if
  // this way finds none.
  static constexpr int kOtherWays = 2;
  bool find_otherwise(int way, const mechanics::LinearSystem& system, bool certify, Orbit<N, H>& orbit);

  // Of a system that may have several orbits: the stable ones that the last find() found.
  const auto& stable() const { return coexistence_.stable(); }

  // Peak of the first mass over an orbit [m].
  double first_peak(const Orbit<N, H>& orbit);

 private:
  void fail_unbounded(Orbit<N, H>& orbit);
  void settle(Orbit<N, H>& orbit);
  // How far an orbit was from its rest position. Newton's method may leave a rest position far off; the orbit
  // has then lost digits and is searched again from the corrected position.
  enum class Shift { none, near, far };
  static constexpr double kFar = 10.0;  // of the orbit's own size: a digit
  std::vector<StuckForce> stuck_forces(ContactMask contacts, const Orbit<N, H>& orbit);
  Shift settle_rest_position(Orbit<N, H>& orbit);
  bool try_held(ContactMask held, Orbit<N, H>& orbit);
  double distance_slid(Eigen::Index contact, const Orbit<N, H>& orbit) const;
  ContactMask sliding_less_than(double share, const Orbit<N, H>& orbit) const;

  Forms<N, H> forms_;
  Flow<N, H>& flow_;
  Continuation<N, H> continuation_;
  Shooting<N, H> shooting_;
  OrbitSteps<N, H> steps_;
  Integrals<N, H> integrals_;
  Orbit<N, H> trial_;
  Coexistence<N, H> coexistence_;
};

template <int N, int H>
void OrbitSearch<N, H>::find(const mechanics::LinearSystem& system, const std::vector<UndampedMode>& undamped,
                             bool certify, Orbit<N, H>& orbit) {
  if (system.bends.count() == 0 && is_unbounded(system, undamped)) return fail_unbounded(orbit);
  if (!system.monotone) return coexistence_.find(system, orbit);
  continuation_.find(system, orbit);
  settle(orbit);
  if (certify && orbit.is_found()) judge_stability(flow_, orbit);
}

// Way 0: contacts that stick for most of the period are held. Way 1: the search starts from the response
// without friction, as if no orbit were known, at a section a quarter of a period later.
template <int N, int H>
bool OrbitSearch<N, H>::find_otherwise(int way, const mechanics::LinearSystem& system, bool certify,
                                       Orbit<N, H>& orbit) {
  if (way == 0) {
    const ContactMask held = sliding_less_than(0.5, orbit);
    if (held == 0 || orbit.half_period || !try_held(held, orbit)) return false;
  } else {
    Orbit<N, H> other = orbit;
    continuation_.forget();
    continuation_.find_from(0.5 * std::numbers::pi, system, other);
    settle(other);
    if (!other.is_found()) return false;
    std::swap(orbit, other);
  }
  if (certify) judge_stability(flow_, orbit);
  return true;
}

template <int N, int H>
double OrbitSearch<N, H>::first_peak(const Orbit<N, H>& orbit) {
  LinearForm<N, H> form = forms_.zero();
  form.z[0] = 1.0;
  steps_.lay_out(orbit);
  return find_extremes(steps_, flow_, orbit.section, [&](const Mode<N, H>&) { return form; }).magnitude();
}

template <int N, int H>
void OrbitSearch<N, H>::fail_unbounded(Orbit<N, H>& orbit) {
  orbit.status = Status::unbounded;
  orbit.reason = kUnbounded;
  orbit.residual = kNone;
  orbit.newton_iterations = orbit.passages = 0;
  continuation_.forget();
}

// How far a contact slides in a passage [m]; infinite on a moving support, where it is not needed.
template <int N, int H>
double OrbitSearch<N, H>::distance_slid(Eigen::Index j, const Orbit<N, H>& orbit) const {
  const StepEquations<N, H>& eq = flow_.equations();
  if (!eq.support_velocity.row(j).isZero(0.0)) return kInfinity;
  const auto& segments = orbit.passage.segments;
  double distance = 0.0;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (contains(flow_.mode(segments[i].mode).stuck, j)) continue;
    const auto& end = i + 1 < segments.size() ? segments[i + 1].z : orbit.passage.end;
    distance += std::abs(eq.W.col(j).dot((end - segments[i].z).head(eq.masses())));
  }
  return distance;
}

// Contacts that slide for less than this share of the passage, or by a negligible distance.
template <int N, int H>
ContactMask OrbitSearch<N, H>::sliding_less_than(double share, const Orbit<N, H>& orbit) const {
  constexpr double kNothing = 1e-6;  // of the displacement that the orbit's energy can reach
  const StepEquations<N, H>& eq = flow_.equations();
  const double energy = std::max(eq.energy_norm(orbit.z), flow_.static_norm());
  ContactMask result = 0;
  for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
    if (eq.limit[j] == 0.0) continue;
    double sliding = 0.0;
    for (const Segment<N, H>& segment : orbit.passage.segments) {
      if (!contains(flow_.mode(segment.mode).stuck, j)) sliding += segment.length;
    }
    const double reach = std::sqrt(2.0 * eq.W.col(j).dot(eq.K_inverse * eq.W.col(j))) * energy;
    if (sliding < share * eq.period || distance_slid(j, orbit) < kNothing * reach) result |= bit(j);
  }
  return result;
}

// Contacts that stick throughout rest where the energy is least. The search may end on the edge of the set of
// such orbits and accept ever smaller slips as the answer (the residual falls like slip^1.5). So contacts
// that barely slide are held; if their forces then stay within their limits, this is the orbit, as there is
// only one. In an orbit without an error bound, contacts that slide rarely are held too.
template <int N, int H>
void OrbitSearch<N, H>::settle(Orbit<N, H>& orbit) {
  if (orbit.half_period) {
    if (orbit.is_found() && orbit.stuck_throughout != 0) centre_rest_position(flow_, orbit);
    return;
  }
  ContactMask tried = 0;
  if (orbit.is_found() && orbit.stuck_throughout != 0) {
    tried = orbit.stuck_throughout;
    if (settle_rest_position(orbit) == Shift::far) try_held(tried, orbit);
  }
  const ContactMask barely = sliding_less_than(orbit.is_found() ? 0.01 : 0.5, orbit);
  if (barely != 0 && barely != tried && try_held(barely, orbit)) return;
  const ContactMask rarely = sliding_less_than(0.1, orbit);
  if (rarely == 0 || rarely == tried || rarely == barely || !orbit.is_found()) return;
  judge_stability(flow_, orbit);
  if (std::isnan(orbit.error_bound)) try_held(rarely, orbit);
}

// Whether an orbit exists with these contacts held by forces within their limits; sets `orbit` to it.
template <int N, int H>
bool OrbitSearch<N, H>::try_held(ContactMask held, Orbit<N, H>& orbit) {
  trial_ = orbit;
  trial_.z = flow_.brought_to_rest(trial_.z, trial_.section, held & flow_.equations().holding);
  Shift shift = Shift::far;
  for (int tries = 0; tries < 3 && shift == Shift::far; ++tries) {
    shooting_.find(trial_, held);
    shift = trial_.is_found() ? settle_rest_position(trial_) : Shift::none;
  }
  if (shift != Shift::near) return false;
  std::swap(orbit, trial_);
  return true;
}

// The forces of these contacts over the orbit, while they stick.
template <int N, int H>
std::vector<StuckForce> OrbitSearch<N, H>::stuck_forces(ContactMask contacts, const Orbit<N, H>& orbit) {
  steps_.lay_out(orbit);
  std::vector<StuckForce> forces;
  for (Eigen::Index j = 0; j < flow_.equations().contacts(); ++j) {
    if (!contains(contacts, j)) continue;
    const auto form = [&](const Mode<N, H>& mode) {
      return contains(mode.stuck, j) ? forms_.stuck_contact_force(j, mode) : forms_.zero();
    };
    const Extremes force = find_extremes(steps_, flow_, orbit.section, form);
    forces.push_back({force.least, force.most, flow_.equations().static_limit[j]});
  }
  return forces;
}

// Moves `orbit` to the rest position of least energy; if a force reaches its limit there, the orbit is
// grazing. `orbit` is unchanged if no rest position keeps the forces within their limits.
template <int N, int H>
typename OrbitSearch<N, H>::Shift OrbitSearch<N, H>::settle_rest_position(Orbit<N, H>& orbit) {
  const StepEquations<N, H>& eq = flow_.equations();
  const std::vector<StuckForce> forces = stuck_forces(orbit.stuck_throughout, orbit);
  integrals_.integrate(steps_, flow_, orbit.half_period, {},
                       [](const auto&, auto& powers) { powers.clear(); });
  const double period = eq.period * eq.step;
  const Eigen::VectorXd mean = integrals_.gram().col(eq.states()).head(eq.states()) / period;
  const RestDirections rest = rest_directions(eq, orbit.stuck_throughout);
  const RestShift shift = least_energy_shift(rest, mean, forces);
  if (shift.verdict == RestShift::Verdict::none) return Shift::none;
  const typename Sizes<N, H>::State by = rest.E * shift.delta;
  shift_orbit<N, H>(by, orbit);
  // Part of the shift's forces may strain a loop alone; no state contains this part. If the reported shares
  // then break a limit, or a force was at its limit before the shift, the motion is followed once more from
  // the shifted state.
  const bool stood_at_limit = orbit.status == Status::grazing && shift.verdict == RestShift::Verdict::inside;
  const bool breaks_limit =
      eq.has_loops && std::ranges::any_of(stuck_forces(eq.holding, orbit), &StuckForce::breaks_limit);
  if (stood_at_limit || breaks_limit) {
    shooting_.find(orbit);
    if (!orbit.is_found()) return Shift::none;
  }
  if (shift.verdict == RestShift::Verdict::at_limit) orbit.status = Status::grazing;
  const double size = std::max(eq.energy_norm(orbit.z), flow_.static_norm());
  return eq.energy_norm(by) > kFar * size ? Shift::far : Shift::near;
}

// Each once, in sized_solver_<N>_<H>.cpp.
extern template class Coexistence<1, 1>;
extern template class Coexistence<1, 2>;
extern template class Coexistence<2, 1>;
extern template class Coexistence<Eigen::Dynamic, Eigen::Dynamic>;
extern template class OrbitSearch<1, 1>;
extern template class OrbitSearch<1, 2>;
extern template class OrbitSearch<2, 1>;
extern template class OrbitSearch<Eigen::Dynamic, Eigen::Dynamic>;

}  // namespace frahm::periodic
