#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "solvers/algebra/no_value.hpp"
#include "solvers/exact/rest_forces.hpp"
#include "solvers/orbits/certificate.hpp"
#include "solvers/orbits/rest_position.hpp"
#include "solvers/orbits/shooting.hpp"
#include "solvers/quantities/integrals.hpp"
#include "solvers/quantities/orbit_steps.hpp"

namespace frahm::periodic {

// The rest position of an orbit whose contacts stick throughout: of all that their forces allow, that of
// least energy (orbits/rest_position.hpp).
template <int N, int H>
class RestSearch {
 public:
  // Both must outlive the search.
  RestSearch(const mechanics::Assembly& assembly, Flow<N, H>& flow)
      : forces_(assembly, flow), flow_(flow), walk_(flow), shooting_(flow), steps_(flow) {}

  // Moves the only orbit of a system to its rest position. Contacts that barely slide are held, if that gives
  // an orbit.
  void settle(Orbit<N, H>& orbit);

  // How far an orbit was from its rest position. Newton's method may leave a rest position far off; the orbit
  // has then lost digits and is searched again from the corrected position.
  enum class Shift { none, near, far };
  // Moves `orbit` to the rest position of least energy; if a force reaches its limit there, the orbit is
  // grazing. `orbit` is unchanged if no rest position keeps the forces within their limits.
  Shift shift(Orbit<N, H>& orbit);

  // The same where bends make the whole motion change with the rest position: that whose mean state has the
  // least energy. False, with `orbit` unchanged, where it is not found. passages: what it took is added.
  bool shift_bent(Orbit<N, H>& orbit, int& passages);

  // Moves `orbit` to the middle of its rest positions. False where the limits leave no room, or contacts
  // share forces; `orbit` is then of no use.
  bool shift_to_middle(Orbit<N, H>& orbit);

  // Whether an orbit exists with these contacts held by forces within their limits; sets `orbit` to it.
  bool try_held(ContactMask held, Orbit<N, H>& orbit);
  // Contacts that slide for less than this share of the passage, or by a negligible distance.
  ContactMask sliding_less_than(double share, const Orbit<N, H>& orbit) const;

 private:
  std::vector<StuckForce> forces_across(const std::vector<OrbitCut>& cuts, const Orbit<N, H>& orbit) {
    steps_.lay_out(orbit);
    return forces_.across(cuts, orbit, steps_);
  }
  struct Family : RestFamily {
    Eigen::MatrixXd directions;  // of the state at the section, states x contacts
  };
  bool measure(Orbit<N, H>& orbit, const std::vector<OrbitCut>& each, RestFamily& family);
  bool look_about(Orbit<N, H>& orbit, Family& family, int& passages);
  bool step_along(const typename Sizes<N, H>::State& by, Orbit<N, H>& orbit, int& passages);

  bool share_anew(Orbit<N, H>& orbit);
  bool shares_break_limits(const Orbit<N, H>& orbit);

  bool hold_some(ContactMask barely, Orbit<N, H>& orbit);
  ContactMask let_go(ContactMask contacts, const Orbit<N, H>& orbit);
  ContactMask varies_most(ContactMask held);
  ContactMask slides_longest(ContactMask contacts, const Orbit<N, H>& orbit) const;
  bool must_balance(const Orbit<N, H>& orbit) const;
  double time_slid(Eigen::Index contact, const Orbit<N, H>& orbit) const;
  void hold_all(Orbit<N, H>& orbit);

  static constexpr double kFar = 10.0;  // of the orbit's own size: a digit
  double distance_slid(Eigen::Index contact, const Orbit<N, H>& orbit) const;

  RestForces<N, H> forces_;
  Flow<N, H>& flow_;
  Walk<N, H> walk_;
  Shooting<N, H> shooting_;
  OrbitSteps<N, H> steps_;
  Integrals<N, H> integrals_;
  Orbit<N, H> trial_;
};

// How far a contact slides in a passage [m]; infinite on a moving support, where it is not needed.
template <int N, int H>
double RestSearch<N, H>::distance_slid(Eigen::Index j, const Orbit<N, H>& orbit) const {
  const StepEquations<N, H>& eq = flow_.equations();
  if (!eq.support_velocity.row(j).isZero(0.0)) return kInfinity;
  const auto& segments = orbit.passage.segments;
  double distance = 0.0;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (flow_.rests(flow_.mode(segments[i].mode), j)) continue;
    const auto& end = i + 1 < segments.size() ? segments[i + 1].z : orbit.passage.end;
    distance += std::abs(eq.W.col(j).dot((end - segments[i].z).head(eq.masses())));
  }
  return distance;
}

// How long a contact slides in a passage [steps].
template <int N, int H>
double RestSearch<N, H>::time_slid(Eigen::Index j, const Orbit<N, H>& orbit) const {
  double time = 0.0;
  for (const Segment<N, H>& segment : orbit.passage.segments) {
    if (!flow_.rests(flow_.mode(segment.mode), j)) time += segment.length;
  }
  return time;
}

template <int N, int H>
ContactMask RestSearch<N, H>::sliding_less_than(double share, const Orbit<N, H>& orbit) const {
  constexpr double kNothing = 1e-6;  // of the displacement that the orbit's energy can reach
  const StepEquations<N, H>& eq = flow_.equations();
  const double energy = std::max(eq.energy_norm(orbit.z), flow_.static_norm());
  ContactMask result = 0;
  for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
    if (eq.limit[j] == 0.0) continue;
    const double sliding = time_slid(j, orbit);
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
void RestSearch<N, H>::settle(Orbit<N, H>& orbit) {
  if (orbit.half_period) {
    if (!orbit.is_found()) hold_all(orbit);
    if (orbit.is_found() && orbit.stuck_throughout != 0) centre_rest_position(flow_, orbit);
    return;
  }
  ContactMask tried = 0;
  if (orbit.is_found() && orbit.stuck_throughout != 0) {
    tried = orbit.stuck_throughout;
    if (shift(orbit) == Shift::far) try_held(tried, orbit);
  }
  const ContactMask barely = sliding_less_than(orbit.is_found() ? 0.01 : 0.5, orbit);
  if (barely != tried && hold_some(barely, orbit)) return;
  const ContactMask rarely = sliding_less_than(0.1, orbit);
  if (rarely == 0 || rarely == tried || rarely == barely || !orbit.is_found()) return;
  judge_stability(flow_, orbit);
  if (std::isnan(orbit.error_bound)) try_held(rarely, orbit);
}

template <int N, int H>
bool RestSearch<N, H>::try_held(ContactMask held, Orbit<N, H>& orbit) {
  trial_ = orbit;
  trial_.z = flow_.brought_to_rest(trial_.z, trial_.section, held & flow_.equations().holding);
  Shift moved = Shift::far;
  for (int tries = 0; tries < 3 && moved == Shift::far; ++tries) {
    shooting_.find(trial_, held);
    moved = trial_.is_found() ? shift(trial_) : Shift::none;
  }
  if (moved == Shift::far || moved == Shift::none) return false;
  std::swap(orbit, trial_);
  return true;
}

// Holds of these contacts as many as forces within their limits can, and then those that barely slide in the
// orbit that this gives. False, with `orbit` unchanged, if none is held.
template <int N, int H>
bool RestSearch<N, H>::hold_some(ContactMask barely, Orbit<N, H>& orbit) {
  ContactMask tried = 0;
  bool holds = false;
  while ((barely & ~tried) != 0) {
    tried |= barely;
    while (barely != 0 && !try_held(barely, orbit)) barely &= ~let_go(barely, orbit);
    if (barely == 0) break;
    holds = true;
    barely = sliding_less_than(0.01, orbit);
  }
  return holds;
}

// For these contacts, which cannot all be held, one that is let go.
template <int N, int H>
ContactMask RestSearch<N, H>::let_go(ContactMask contacts, const Orbit<N, H>& orbit) {
  const ContactMask beyond = trial_.is_found() ? varies_most(contacts & trial_.stuck_throughout) : 0;
  return beyond != 0 ? beyond : slides_longest(contacts, orbit);
}

// For these contacts, which the last trial held, the one whose force varies most, if by more than its limits
// are apart: nothing that shifts the forces holds it. In a loop the others may, while it carries its limit.
template <int N, int H>
ContactMask RestSearch<N, H>::varies_most(ContactMask held) {
  const std::vector<OrbitCut> each = forces_.each_alone(held);
  const std::vector<StuckForce> forces = forces_across(each, trial_);
  ContactMask result = 0;
  double most = 1.0;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const double variation = (forces[i].most - forces[i].least) / (2.0 * forces[i].limit);
    if (variation <= most) continue;
    result = bit(each[i].contact);
    most = variation;
  }
  return result;
}

// For these contacts the one that slides longest.
template <int N, int H>
ContactMask RestSearch<N, H>::slides_longest(ContactMask contacts, const Orbit<N, H>& orbit) const {
  Eigen::Index longest = first(contacts);
  for (Eigen::Index j = longest; j < flow_.equations().contacts(); ++j) {
    if (contains(contacts, j) && time_slid(j, orbit) > time_slid(longest, orbit)) longest = j;
  }
  return bit(longest);
}

// Near a resonance without damping Newton's method may slide ever less and not arrive at an orbit whose
// contacts all stick. The symmetry of the orbit says where they rest, so that their forces alone decide.
template <int N, int H>
void RestSearch<N, H>::hold_all(Orbit<N, H>& orbit) {
  const ContactMask held = flow_.equations().holding;
  if (held == 0) return;
  trial_ = orbit;
  trial_.z = flow_.brought_to_rest(trial_.z, trial_.section, held);
  shooting_.find(trial_, held);
  if (!trial_.is_found() || trial_.stuck_throughout == 0) return;
  const OrbitCuts cuts = forces_.cuts_through(trial_.stuck_throughout, trial_);
  if (break_limits(forces_across(cuts.all, trial_))) return;
  if (cuts.in_loops && !share_anew(trial_)) return;
  std::swap(orbit, trial_);
}

// Follows the motion from here with no contact held: contacts in loops share the forces of other rest
// positions otherwise, up to other instants. False, with `orbit` unchanged, if contacts that rest throughout
// then slide.
template <int N, int H>
bool RestSearch<N, H>::share_anew(Orbit<N, H>& orbit) {
  Orbit<N, H> shared = orbit;
  shooting_.find(shared);
  if (!shared.is_found() || (orbit.stuck_throughout & ~shared.stuck_throughout) != 0) return false;
  std::swap(orbit, shared);
  return true;
}

template <int N, int H>
typename RestSearch<N, H>::Shift RestSearch<N, H>::shift(Orbit<N, H>& orbit) {
  if (orbit.stuck_throughout == 0) return Shift::none;  // a slider that was to be held slid from the start
  const StepEquations<N, H>& eq = flow_.equations();
  const OrbitCuts cuts = forces_.cuts_through(orbit.stuck_throughout, orbit);
  const std::vector<StuckForce> forces = forces_across(cuts.all, orbit);
  integrals_.integrate(steps_, flow_, orbit.half_period, {},
                       [](const auto&, auto& powers) { powers.clear(); });
  const double period = eq.period * eq.step;
  const Eigen::VectorXd mean = integrals_.gram().col(eq.states()).head(eq.states()) / period;
  const RestDirections rest = rest_directions(eq, orbit.stuck_throughout);
  const RestShift found = least_energy_shift(rest, mean, forces);
  if (found.verdict == RestShift::Verdict::none) return Shift::none;
  const typename Sizes<N, H>::State by = rest.E * found.delta;
  const bool is_inside = found.verdict == RestShift::Verdict::inside;
  if (cuts.in_loops) {
    Orbit<N, H> shifted = orbit;
    shift_orbit<N, H>(by, shifted);
    // With a force at its limit a contact may slip by rounding: then the shares told must do.
    if (!share_anew(shifted) && (is_inside || shares_break_limits(shifted))) return Shift::none;
    std::swap(orbit, shifted);
  } else {
    shift_orbit<N, H>(by, orbit);
    // The motion is followed once more where a force was at its limit before the shift.
    if (orbit.status == Status::grazing && is_inside) {
      shooting_.find(orbit);
      if (!orbit.is_found()) return Shift::none;
    }
  }
  if (!is_inside) orbit.status = Status::grazing;
  const double size = std::max(eq.energy_norm(orbit.z), flow_.static_norm());
  return eq.energy_norm(by) > kFar * size ? Shift::far : Shift::near;
}

// Mean state, and the forces of the contacts that stick throughout.
template <int N, int H>
bool RestSearch<N, H>::measure(Orbit<N, H>& orbit, const std::vector<OrbitCut>& each, RestFamily& family) {
  const StepEquations<N, H>& eq = flow_.equations();
  const std::vector<StuckForce> forces = forces_across(each, orbit);
  const auto m = static_cast<Eigen::Index>(forces.size());
  family.least.resize(m);
  family.most.resize(m);
  family.limit.resize(m);
  for (Eigen::Index i = 0; i < m; ++i) {
    const StuckForce& force = forces[static_cast<std::size_t>(i)];
    family.least[i] = force.least;
    family.most[i] = force.most;
    family.limit[i] = force.limit;
  }
  integrals_.integrate(steps_, flow_, false, {}, [](const auto&, auto& powers) { powers.clear(); });
  family.mean = integrals_.gram().col(eq.states()).head(eq.states()) / (eq.period * eq.step);
  return family.mean.allFinite();
}

// The family about an orbit: along each direction, in which the motion is periodic too, by central
// differences of the fourth order with the contacts held.
template <int N, int H>
bool RestSearch<N, H>::look_about(Orbit<N, H>& orbit, Family& family, int& passages) {
  constexpr double kPart = 1e-3;  // of a limit, and of the orbit
  const StepEquations<N, H>& eq = flow_.equations();
  const ContactMask stuck = orbit.stuck_throughout;
  const std::vector<OrbitCut> each = forces_.each_alone(stuck);
  if (!measure(orbit, each, family)) return false;
  follow_tangent(flow_, orbit);
  const RestDirections rest = rest_directions(eq, stuck);
  Eigen::MatrixXd B = shift_projector(rest) - Eigen::MatrixXd(orbit.passage.tangent);
  B.diagonal().array() += 1.0;
  family.directions = B.partialPivLu().solve(rest.E);
  if (!family.directions.allFinite()) return false;
  const Eigen::Index m = family.limit.size();
  family.of_mean.setZero(eq.states(), m);
  family.of_least.setZero(m, m);
  family.of_most.setZero(m, m);
  family.energy_of_mean.resize(eq.states(), m);
  for (Eigen::Index j = 0; j < m; ++j) {
    const typename Sizes<N, H>::State direction = family.directions.col(j);
    const double step =
        kPart * std::min(family.limit[j], flow_.energy_scale(orbit.z) / eq.energy_norm(direction));
    for (const auto& [at, weight] : {std::pair(-2.0, 1.0), {-1.0, -8.0}, {1.0, 8.0}, {2.0, -1.0}}) {
      Orbit<N, H> beside = orbit;
      beside.z += at * step * direction;
      walk_.pass(beside.z, beside.section, eq.period, beside.passage, Tangent::none, stuck);
      passages += orbit.multiple;
      RestFamily there;
      if (beside.passage.failure != nullptr || stuck_throughout(flow_, beside.passage) != stuck ||
          !measure(beside, each, there))
        return false;
      family.of_mean.col(j) += weight / (12.0 * step) * there.mean;
      family.of_least.col(j) += weight / (12.0 * step) * there.least;
      family.of_most.col(j) += weight / (12.0 * step) * there.most;
    }
    family.energy_of_mean.col(j) = eq.weighted_by_energy(typename Sizes<N, H>::State(family.of_mean.col(j)));
  }
  return true;
}

// As far along as an orbit with the same contacts held is found.
template <int N, int H>
bool RestSearch<N, H>::step_along(const typename Sizes<N, H>::State& by, Orbit<N, H>& orbit, int& passages) {
  constexpr int kMostHalvings = 6;
  double share = 1.0;
  for (int halvings = 0; halvings <= kMostHalvings; ++halvings, share *= 0.5) {
    Orbit<N, H> next = orbit;
    next.z += share * by;
    shooting_.find(next, orbit.stuck_throughout);
    passages += orbit.multiple * next.passages;
    if (!next.is_found() || next.stuck_throughout != orbit.stuck_throughout) continue;
    std::swap(orbit, next);
    return true;
  }
  return false;
}

template <int N, int H>
bool RestSearch<N, H>::shift_bent(Orbit<N, H>& orbit, int& passages) {
  constexpr int kMostSteps = 40;
  constexpr double kAgrees = 1e-11;  // of the orbit's size
  if (forces_.cuts_through(orbit.stuck_throughout, orbit).in_loops || must_balance(orbit)) return false;
  Orbit<N, H> moved = orbit;
  Family family;
  for (int step = 0; step < kMostSteps; ++step) {
    if (!look_about(moved, family, passages)) return false;
    const RestShift found = least_energy_step(family);
    if (found.verdict == RestShift::Verdict::none) return false;
    const typename Sizes<N, H>::State by = family.directions * found.delta;
    if (!step_along(by, moved, passages)) return false;
    if (flow_.equations().energy_norm(by) > kAgrees * flow_.energy_scale(moved.z)) continue;
    shooting_.find(moved);  // with none held
    passages += moved.multiple * moved.passages;
    if (!moved.is_found() || moved.stuck_throughout != orbit.stuck_throughout) return false;
    if (found.verdict == RestShift::Verdict::at_limit) moved.status = Status::grazing;
    std::swap(orbit, moved);
    return true;
  }
  return false;
}

// Whether mean forces of contacts that stick throughout must balance one another along free directions.
template <int N, int H>
bool RestSearch<N, H>::must_balance(const Orbit<N, H>& orbit) const {
  return rest_directions(flow_.equations(), orbit.stuck_throughout).balanced.rows() > 0;
}

template <int N, int H>
bool RestSearch<N, H>::shift_to_middle(Orbit<N, H>& orbit) {
  const ContactMask stuck = orbit.stuck_throughout;
  const OrbitCuts cuts = forces_.cuts_through(stuck, orbit);
  if (cuts.in_loops || must_balance(orbit)) return false;
  const RestShift found = middle_shift(forces_across(cuts.all, orbit));
  if (found.verdict != RestShift::Verdict::inside) return false;
  shift_orbit<N, H>(rest_directions(flow_.equations(), stuck).E * found.delta, orbit);
  shooting_.find(orbit);
  return orbit.is_found() && orbit.stuck_throughout == stuck;
}

// Whether the shares that contacts are said to carry break the limits of some.
template <int N, int H>
bool RestSearch<N, H>::shares_break_limits(const Orbit<N, H>& orbit) {
  return break_limits(forces_across(forces_.each_alone(flow_.equations().holding), orbit));
}

}  // namespace frahm::periodic
