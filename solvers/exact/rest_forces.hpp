#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "solvers/flow/linear_form.hpp"
#include "solvers/orbits/contact_cuts.hpp"
#include "solvers/orbits/rest_position.hpp"
#include "solvers/quantities/extremes.hpp"
#include "solvers/quantities/orbit_steps.hpp"

namespace frahm::periodic {

// A cut through contacts at rest (orbits/contact_cuts.hpp), or a contact by itself. The motion tells its
// force while exactly the contacts of one of these sets rest; of a contact by itself, while it rests.
struct OrbitCut {
  Eigen::VectorXd shares;     // of all contacts
  Eigen::Index contact = -1;  // by itself
  std::vector<ContactMask> resting;
};

// The cuts that tell where contacts may rest.
struct OrbitCuts {
  std::vector<OrbitCut> all;
  bool in_loops = false;  // contacts share forces: how, only the motion followed from there shows
};

// The forces that contacts at rest carry over an orbit, alone or together across a cut.
template <int N, int H>
class RestForces {
 public:
  // Both must outlive the forces.
  RestForces(const mechanics::Assembly& assembly, const Flow<N, H>& flow)
      : forms_(assembly, flow), flow_(flow) {}

  // These contacts, each by itself: in a loop its force is a share, which motion says nothing of.
  std::vector<OrbitCut> each_alone(ContactMask contacts) const;
  // The cuts through contacts that rest in each mode, if they tell the forces of some of these contacts,
  // which rest throughout. If a loop has too many, these contacts each by itself, with their shares as they
  // are: their places of rest then lie within those that are possible.
  OrbitCuts cuts_through(ContactMask contacts, const Orbit<N, H>& orbit) const;
  // The forces across these cuts over the orbit, which is laid out in `steps`, while the motion tells them;
  // at other times one counts as the first that is reported.
  std::vector<StuckForce> across(const std::vector<OrbitCut>& cuts, const Orbit<N, H>& orbit,
                                 OrbitSteps<N, H>& steps) const;

 private:
  bool add_cuts(ContactMask resting, ContactMask contacts, OrbitCuts& cuts) const;
  bool is_defined(const OrbitCut& cut, const Mode<N, H>& mode) const;
  LinearForm<N, H> form(const OrbitCut& cut, const Mode<N, H>& mode) const;

  Forms<N, H> forms_;
  const Flow<N, H>& flow_;
};

template <int N, int H>
std::vector<OrbitCut> RestForces<N, H>::each_alone(ContactMask contacts) const {
  std::vector<OrbitCut> cuts;
  for (const Eigen::Index j : list_of(contacts))
    cuts.push_back({Eigen::VectorXd::Unit(flow_.equations().contacts(), j), j, {}});
  return cuts;
}

template <int N, int H>
OrbitCuts RestForces<N, H>::cuts_through(ContactMask contacts, const Orbit<N, H>& orbit) const {
  const StepEquations<N, H>& eq = flow_.equations();
  const ContactMask by_themselves = eq.has_loops ? contacts & ~eq.holding : contacts;
  OrbitCuts cuts{.all = each_alone(by_themselves)};
  if (by_themselves == contacts) return cuts;
  std::vector<ContactMask> seen;
  for (const Segment<N, H>& segment : orbit.passage.segments) {
    const ContactMask resting = flow_.at_rest(flow_.mode(segment.mode)) & eq.holding;
    if (std::ranges::find(seen, resting) != seen.end()) continue;
    seen.push_back(resting);
    if (!add_cuts(resting, contacts, cuts)) return {.all = each_alone(contacts), .in_loops = true};
  }
  return cuts;
}

// Adds the cuts through the contacts that rest at one time if they pass through some of `contacts`. False if
// there are too many.
template <int N, int H>
bool RestForces<N, H>::add_cuts(ContactMask resting, ContactMask contacts, OrbitCuts& cuts) const {
  constexpr double kSame = 1e-9;
  const StepEquations<N, H>& eq = flow_.equations();
  const std::vector<Eigen::Index> list = list_of(resting);
  const std::optional<std::vector<Eigen::VectorXd>> here = contact_cuts(eq.W(Eigen::all, list));
  if (!here) return false;
  for (const Eigen::VectorXd& of_list : *here) {
    Eigen::VectorXd shares = Eigen::VectorXd::Zero(eq.contacts());
    shares(list) = of_list;
    if (shares(list_of(contacts)).isZero(0.0)) continue;
    cuts.in_loops = cuts.in_loops || (shares.array() != 0.0).count() > 1;
    const auto known = std::ranges::find_if(cuts.all, [&](const OrbitCut& cut) {
      return cut.contact < 0 && std::min((cut.shares - shares).norm(), (cut.shares + shares).norm()) < kSame;
    });
    if (known == cuts.all.end())
      cuts.all.push_back({std::move(shares), -1, {resting}});
    else
      known->resting.push_back(resting);
  }
  return true;
}

// The force across a cut in a mode in which its contacts rest: those that stick, and those that carry their
// limits while others hold them.
template <int N, int H>
LinearForm<N, H> RestForces<N, H>::form(const OrbitCut& cut, const Mode<N, H>& mode) const {
  LinearForm<N, H> sum = forms_.zero();
  for (Eigen::Index j = 0; j < cut.shares.size(); ++j) {
    const double share = cut.shares[j];
    if (share == 0.0) continue;
    if (contains(mode.stuck, j))
      sum.add(share, forms_.stuck_contact_force(j, mode));
    else
      sum.u[0] += share * mode.friction[j];
  }
  return sum;
}

template <int N, int H>
bool RestForces<N, H>::is_defined(const OrbitCut& cut, const Mode<N, H>& mode) const {
  const ContactMask resting = flow_.at_rest(mode);
  if (cut.contact >= 0) return contains(resting, cut.contact);
  return std::ranges::find(cut.resting, resting & flow_.equations().holding) != cut.resting.end();
}

template <int N, int H>
std::vector<StuckForce> RestForces<N, H>::across(const std::vector<OrbitCut>& cuts, const Orbit<N, H>& orbit,
                                                 OrbitSteps<N, H>& steps) const {
  std::vector<StuckForce> forces;
  for (const OrbitCut& cut : cuts) {
    const auto all = steps.steps();
    const auto first =
        std::ranges::find_if(all, [&](const auto& step) { return is_defined(cut, flow_.mode(step.mode)); });
    LinearForm<N, H> first_value = forms_.zero();
    if (first != all.end()) first_value.u[0] = form(cut, flow_.mode(first->mode)).at(first->left).value;
    const Extremes force = find_extremes(steps, flow_, orbit.section, [&](const Mode<N, H>& mode) {
      return is_defined(cut, mode) ? form(cut, mode) : first_value;
    });
    const auto& eq = flow_.equations();
    const bool falls = (eq.static_limit - eq.limit).dot(cut.shares.cwiseAbs()) > 0.0;
    forces.push_back({cut.shares(list_of(orbit.stuck_throughout)), force.least, force.most,
                      cut.shares.cwiseAbs().dot(eq.static_limit),
                      falls || (eq.bends.count() > 0 && !eq.monotone)});
  }
  return forces;
}

}  // namespace frahm::periodic
