#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "solvers/algebra/no_value.hpp"
#include "solvers/algebra/null_space.hpp"
#include "solvers/flow/linear_form.hpp"
#include "solvers/orbits/certificate.hpp"
#include "solvers/orbits/rest_position.hpp"
#include "solvers/orbits/shooting.hpp"
#include "solvers/quantities/extremes.hpp"
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
      : forms_(assembly, flow), flow_(flow), shooting_(flow), steps_(flow) {}

  // Moves the only orbit of a system to its rest position. Contacts that barely slide are held, if that gives
  // an orbit.
  void settle(Orbit<N, H>& orbit);

  // How far an orbit was from its rest position. Newton's method may leave a rest position far off; the orbit
  // has then lost digits and is searched again from the corrected position.
  enum class Shift { none, near, far };
  // Moves `orbit` to the rest position of least energy; if a force reaches its limit there, the orbit is
  // grazing. `orbit` is unchanged if no rest position keeps the forces within their limits.
  Shift shift(Orbit<N, H>& orbit) { return shift(orbit, Forces::all); }

  // Whether an orbit exists with these contacts held by forces within their limits; sets `orbit` to it.
  bool try_held(ContactMask held, Orbit<N, H>& orbit);
  // Contacts that slide for less than this share of the passage, or by a negligible distance.
  ContactMask sliding_less_than(double share, const Orbit<N, H>& orbit) const;

 private:
  // Which forces must stay within their limits: in a loop they may be shared otherwise than they are told.
  enum class Forces { all, outside_loops };
  Shift shift(Orbit<N, H>& orbit, Forces which);
  bool rests_with_other_shares(ContactMask held);

  bool hold_some(ContactMask barely, Orbit<N, H>& orbit);
  ContactMask let_go(ContactMask contacts, const Orbit<N, H>& orbit);
  ContactMask varies_most(ContactMask held);
  ContactMask slides_longest(ContactMask contacts, const Orbit<N, H>& orbit) const;
  double time_slid(Eigen::Index contact, const Orbit<N, H>& orbit) const;
  void hold_all(Orbit<N, H>& orbit);
  ContactMask at_rest(const Mode<N, H>& mode) const;
  ContactMask in_loops(const Mode<N, H>& mode) const;
  bool rests_in_loops(const Orbit<N, H>& orbit) const;

  static constexpr double kFar = 10.0;  // of the orbit's own size: a digit
  std::vector<StuckForce> stuck_forces(ContactMask contacts, const Orbit<N, H>& orbit,
                                       Forces which = Forces::all);
  double distance_slid(Eigen::Index contact, const Orbit<N, H>& orbit) const;

  Forms<N, H> forms_;
  Flow<N, H>& flow_;
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
  if (moved == Shift::far || (moved == Shift::none && !rests_with_other_shares(held))) return false;
  std::swap(orbit, trial_);
  return true;
}

// Held contacts take any share of a loop's forces, be it beyond their limits, where they might carry less. So
// the forces outside loops alone say where they rest, and the motion that is followed from there, with none
// held, shows whether the loops can share what is left.
template <int N, int H>
bool RestSearch<N, H>::rests_with_other_shares(ContactMask held) {
  if (!trial_.is_found() || !rests_in_loops(trial_)) return false;
  if (shift(trial_, Forces::outside_loops) != Shift::near) return false;
  return std::ranges::all_of(trial_.passage.segments, [&](const Segment<N, H>& segment) {
    return (held & ~at_rest(flow_.mode(segment.mode))) == 0;
  });
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

// Of these contacts, which cannot all be held, one that is let go.
template <int N, int H>
ContactMask RestSearch<N, H>::let_go(ContactMask contacts, const Orbit<N, H>& orbit) {
  const ContactMask beyond = trial_.is_found() ? varies_most(contacts & trial_.stuck_throughout) : 0;
  return beyond != 0 ? beyond : slides_longest(contacts, orbit);
}

// Of these contacts, which the last trial held, the one whose force varies most, if by more than its limits
// are apart: nothing that shifts the forces holds it. In a loop the others may, while it carries its limit.
template <int N, int H>
ContactMask RestSearch<N, H>::varies_most(ContactMask held) {
  ContactMask result = 0;
  double most = 1.0;
  for (Eigen::Index j = 0; j < flow_.equations().contacts(); ++j) {
    if (!contains(held, j)) continue;
    const StuckForce force = stuck_forces(bit(j), trial_).front();
    const double variation = (force.most - force.least) / (2.0 * force.limit);
    if (variation <= most) continue;
    result = bit(j);
    most = variation;
  }
  return result;
}

// Of these contacts the one that slides longest.
template <int N, int H>
ContactMask RestSearch<N, H>::slides_longest(ContactMask contacts, const Orbit<N, H>& orbit) const {
  Eigen::Index longest = first(contacts);
  for (Eigen::Index j = longest; j < flow_.equations().contacts(); ++j) {
    if (contains(contacts, j) && time_slid(j, orbit) > time_slid(longest, orbit)) longest = j;
  }
  return bit(longest);
}

// Beside a resonance without damping Newton's method may slide ever less and not arrive at an orbit whose
// contacts all stick. The symmetry of the orbit says where they rest, so that their forces alone decide.
template <int N, int H>
void RestSearch<N, H>::hold_all(Orbit<N, H>& orbit) {
  const ContactMask held = flow_.equations().holding;
  if (held == 0) return;
  trial_ = orbit;
  trial_.z = flow_.brought_to_rest(trial_.z, trial_.section, held);
  shooting_.find(trial_, held);
  if (!trial_.is_found() || trial_.stuck_throughout == 0) return;
  if (std::ranges::any_of(stuck_forces(trial_.stuck_throughout, trial_), &StuckForce::breaks_limit)) return;
  std::swap(orbit, trial_);
}

// The forces of these contacts over the orbit, while they stick; what is not told of one counts as the first
// of its forces that is.
template <int N, int H>
std::vector<StuckForce> RestSearch<N, H>::stuck_forces(ContactMask contacts, const Orbit<N, H>& orbit,
                                                       Forces which) {
  steps_.lay_out(orbit);
  const auto is_told = [&](Eigen::Index j, const Mode<N, H>& mode) {
    return contains(mode.stuck, j) && (which == Forces::all || !contains(in_loops(mode), j));
  };
  std::vector<StuckForce> forces;
  for (Eigen::Index j = 0; j < flow_.equations().contacts(); ++j) {
    if (!contains(contacts, j)) continue;
    LinearForm<N, H> first_told = forms_.zero();
    const auto steps = steps_.steps();
    const auto told =
        std::ranges::find_if(steps, [&](const auto& step) { return is_told(j, flow_.mode(step.mode)); });
    if (told != steps.end())
      first_told.u[0] = forms_.stuck_contact_force(j, flow_.mode(told->mode)).at(told->left).value;
    const auto form = [&](const Mode<N, H>& mode) {
      return is_told(j, mode) ? forms_.stuck_contact_force(j, mode) : first_told;
    };
    const Extremes force = find_extremes(steps_, flow_, orbit.section, form);
    forces.push_back({force.least, force.most, flow_.equations().static_limit[j]});
  }
  return forces;
}

template <int N, int H>
ContactMask RestSearch<N, H>::at_rest(const Mode<N, H>& mode) const {
  ContactMask result = 0;
  for (Eigen::Index j = 0; j < flow_.equations().contacts(); ++j) {
    if (flow_.rests(mode, j)) result |= bit(j);
  }
  return result;
}

// The contacts whose velocity is held at rest in this mode and that are part of a loop of such.
template <int N, int H>
ContactMask RestSearch<N, H>::in_loops(const Mode<N, H>& mode) const {
  constexpr double kNoPart = 1e-9;  // of a loop of length 1: rounding
  const StepEquations<N, H>& eq = flow_.equations();
  if (!eq.has_loops) return 0;
  const ContactMask contacts = at_rest(mode) & eq.holding;
  std::vector<Eigen::Index> resting;
  for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
    if (contains(contacts, j)) resting.push_back(j);
  }
  if (resting.size() < 2) return 0;
  const Eigen::MatrixXd loops = algebra::null_space(eq.W(Eigen::all, resting));
  ContactMask result = 0;
  for (std::size_t i = 0; i < resting.size(); ++i) {
    if (loops.row(static_cast<Eigen::Index>(i)).norm() > kNoPart) result |= bit(resting[i]);
  }
  return result;
}

// Whether contacts that rest at one time form a loop.
template <int N, int H>
bool RestSearch<N, H>::rests_in_loops(const Orbit<N, H>& orbit) const {
  return std::ranges::any_of(orbit.passage.segments, [&](const Segment<N, H>& segment) {
    return in_loops(flow_.mode(segment.mode)) != 0;
  });
}

template <int N, int H>
typename RestSearch<N, H>::Shift RestSearch<N, H>::shift(Orbit<N, H>& orbit, Forces which) {
  if (orbit.stuck_throughout == 0) return Shift::none;  // a slider that was to be held slid from the start
  const StepEquations<N, H>& eq = flow_.equations();
  const std::vector<StuckForce> forces = stuck_forces(orbit.stuck_throughout, orbit, which);
  integrals_.integrate(steps_, flow_, orbit.half_period, {},
                       [](const auto&, auto& powers) { powers.clear(); });
  const double period = eq.period * eq.step;
  const Eigen::VectorXd mean = integrals_.gram().col(eq.states()).head(eq.states()) / period;
  const RestDirections rest = rest_directions(eq, orbit.stuck_throughout);
  const RestShift found = least_energy_shift(rest, mean, forces);
  if (found.verdict == RestShift::Verdict::none) return Shift::none;
  const typename Sizes<N, H>::State by = rest.E * found.delta;
  shift_orbit<N, H>(by, orbit);
  // Where contacts rest in loops they share its forces, up to other instants than before. So the motion is
  // followed once more from the shifted state; also where a force was at its limit before the shift. With a
  // force at its limit now a contact may slip by rounding: then only if the shares told break a limit.
  const bool is_inside = found.verdict == RestShift::Verdict::inside;
  const bool stood_at_limit = orbit.status == Status::grazing && is_inside;
  const bool shares_anew = which == Forces::outside_loops ||
                           (!by.isZero(0.0) && rests_in_loops(orbit) &&
                            (is_inside || std::ranges::any_of(stuck_forces(flow_.equations().holding, orbit),
                                                              &StuckForce::breaks_limit)));
  if (stood_at_limit || shares_anew) {
    shooting_.find(orbit);
    if (!orbit.is_found()) return Shift::none;
  }
  if (found.verdict == RestShift::Verdict::at_limit) orbit.status = Status::grazing;
  const double size = std::max(eq.energy_norm(orbit.z), flow_.static_norm());
  return eq.energy_norm(by) > kFar * size ? Shift::far : Shift::near;
}

}  // namespace frahm::periodic
