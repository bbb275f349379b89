#include "solvers/branches/branch.hpp"

#include <utility>

#include "solvers/branches/branch_start.hpp"
#include "solvers/branches/followed_branch.hpp"

namespace frahm::periodic {
const char* kind_name(SpecialKind kind) {
  switch (kind) {
    case SpecialKind::fold:
      return "fold";
    case SpecialKind::branching:
      return "branching";
    case SpecialKind::period_doubling:
      return "period_doubling";
    case SpecialKind::torus:
      return "torus";
    case SpecialKind::stability_jump:
      return "stability_jump";
    case SpecialKind::grazing:
      return "grazing";
    case SpecialKind::corner:
      return "corner";
    case SpecialKind::jump:
      return "jump";
  }
  return "";
}

const char* end_name(BranchEnd end) {
  switch (end) {
    case BranchEnd::range:
      return "range";
    case BranchEnd::points:
      return "points";
    case BranchEnd::closed:
      return "closed";
    case BranchEnd::origin:
      return "origin";
    case BranchEnd::jump:
      return "jump";
    case BranchEnd::joined:
      return "joined";
    case BranchEnd::rule:
      return "rule";
    case BranchEnd::lost:
      return "lost";
    case BranchEnd::unbounded:
      return "unbounded";
    case BranchEnd::family:
      return "family";
  }
  return "";
}

const char* end_sentence(BranchEnd end) {
  switch (end) {
    case BranchEnd::range:
      return "the range of the parameter ends";
    case BranchEnd::points:
      return "the requested number of points is reached";
    case BranchEnd::closed:
      return "the branch is closed";
    case BranchEnd::origin:
      return "it meets the orbits of half its period, from which it branches off";
    case BranchEnd::jump:
      return "an event begins that takes the motion elsewhere";
    case BranchEnd::joined:
      return "it continues as a branch that was followed before";
    case BranchEnd::rule:
      return "beyond, a value breaks a rule";
    case BranchEnd::lost:
      return "no neighbouring orbit was found to continue it";
    case BranchEnd::unbounded:
      return "the response grows without bound";
    case BranchEnd::family:
      return "it meets a resonance of a multiple of the frequency that nothing damps, where a family of "
             "orbits exists";
  }
  return "";
}

void go_along(const Branch& branch,
              const std::function<void(const BranchPoint& at, const SpecialPoint* special)>& call) {
  auto special = branch.special.begin();
  for (std::size_t i = 0; i <= branch.points.size(); ++i) {
    for (; special != branch.special.end() && special->next == i; ++special) call(special->at, &*special);
    if (i < branch.points.size()) call(branch.points[i], nullptr);
  }
}

Branch follow_branch(const mechanics::Network& network, const std::vector<Quantity>& quantities,
                     const ValuesAlong& values, const BranchWanted& wanted, const BranchProgress& progress) {
  FollowedBranch followed(network, quantities, values, wanted);
  followed.map().set(wanted.start);
  const AnyOrbit orbit = find_start(followed.map(), wanted.multiple);
  if (orbit.is_found()) {
    followed.follow(orbit, {}, progress);
  } else {
    followed.branch().reason = orbit.reason;
  }
  return std::move(followed.branch());
}

}  // namespace frahm::periodic
