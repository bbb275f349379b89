#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "solvers/branches/corrector.hpp"
#include "solvers/quantities/observables.hpp"

namespace frahm::periodic {

// A branch with the map on which it is followed, so that orbits can be compared with it afterwards.
class FollowedBranch {
 public:
  FollowedBranch(const mechanics::Network& network, const std::vector<Quantity>& quantities,
                 const ValuesAlong& values, const BranchWanted& wanted);
  FollowedBranch(const FollowedBranch&) = delete;
  FollowedBranch& operator=(const FollowedBranch&) = delete;

  // Whether an orbit of a parameter, at phase 0 and in the units of the map's flow, is known already.
  using IsKnown = std::function<bool(double parameter, const AnyOrbit& orbit)>;

  // The map, to which the parameter of the first orbit is to be set.
  BranchMap& map() { return map_; }
  // Follows the branch both ways from an orbit of the parameter set, at phase 0, until its orbits are known.
  void follow(const AnyOrbit& orbit, const IsKnown& is_known, const BranchProgress& progress);

  const Branch& branch() const { return branch_; }
  Branch& branch() { return branch_; }

  // How many stable orbits of the branch there are at a value of the parameter; none where that is not clear:
  // its stability changes near there.
  std::optional<int> stable_at(double parameter) const;
  // Whether an orbit (as of IsKnown) is one of the branch.
  bool passes(double parameter, const AnyOrbit& orbit);

 private:
  // From one point to the next, at one section.
  struct Step {
    Eigen::VectorXd from, to;
    double section = 0.0, arclength = 0.0;  // at its end, negative before the first point
    bool from_stable = false, to_stable = false;

    bool is_near(double at) const;
  };
  // One way of the branch, from the first point on.
  struct OneWay {
    std::vector<BranchPoint> points;
    std::vector<SpecialPoint> special;
    BranchEnd end{};
  };

  BranchPoint tell(const Eigen::VectorXd& y);
  // sign: of the arclength.
  OneWay follow_way(const BranchPlace& first, bool stable, double sign, const IsKnown& is_known,
                    const BranchProgress& progress);
  bool is_known_after(const Step& step, const IsKnown& is_known);
  using StepFilter = std::function<bool(const Step&)>;
  bool passes(double parameter, const AnyOrbit& orbit, const StepFilter& counts);
  bool is_stable_in_the_middle(const Eigen::VectorXd& y);
  std::optional<BranchPlace> first_place(const Eigen::VectorXd& y);
  bool lies_on(const Step& step, const Eigen::VectorXd& y);

  BranchWanted wanted_;
  BranchMap map_;
  Observables<kAnySize, kAnySize> observables_;
  std::size_t quantities_;
  Branch branch_;
  std::vector<Step> steps_;
};

}  // namespace frahm::periodic
