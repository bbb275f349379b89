#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "solvers/branches/branch.hpp"
#include "solvers/branches/branch_events.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "solvers/orbits/orbit.hpp"
#include "solvers/orbits/shooting.hpp"
#include "solvers/quantities/sensitivity_sizes.hpp"

namespace frahm::periodic {

// The period map's residual at a place y of the scaled space, and all that its passage tells.
struct Shot {
  bool failed = false;
  Eigen::VectorXd residual;    // R (g(z, p) - z) / scale
  Eigen::MatrixXd derivative;  // by y, states x (states + 1)
  AnyPassage passage;
  ContactMask stuck_throughout = 0;
  Closing closing;
  Eigen::MatrixXd to_rest;  // projects onto what keeps its rest position; empty: nothing does
};

// The period map of a network along one parameter p. Places of a branch are y = (R z / scale, (p - low) /
// (high - low)): z the state in SI at a section, |R z| / sqrt(2) its energy norm in the system at the
// start, scale that of the first orbit. So both the orbit and the parameter move by parts of one.
class BranchMap {
 public:
  BranchMap(const mechanics::Network& network, const ValuesAlong& values, double low, double high);

  // Throws mechanics::MechanicsError for values that break a rule.
  void set(double parameter);
  // Takes scale, period and symmetry of this orbit, which belongs to the parameter set and starts at phase 0.
  // Returns its place.
  Eigen::VectorXd begin(const AnyOrbit& orbit);
  // The place of another orbit of the parameter set that takes as many periods and starts at phase 0.
  Eigen::VectorXd place_of(const AnyOrbit& orbit) const;
  int multiple() const { return multiple_; }  // of the excitation's period

  // The motion from a place over the map's length, and whether it closes. Leaves the flow set to the
  // parameter of y. Failed, too, where the parameter's values break a rule.
  Shot pass(const Eigen::VectorXd& y, Tangent tangent);
  // With the derivative by y.
  Shot shoot(const Eigen::VectorXd& y);

  // omega t of the section [rad], 0 at first.
  double section() const { return section_; }
  void set_section(double section) { section_ = section; }
  // The place of the same orbit at another section; empty where the motion there cannot be followed.
  Eigen::VectorXd moved(const Eigen::VectorXd& y, double section);
  // For an orbit of a multiple of the period that `part` divides: how far the motion is from y after this
  // part of its time, scaled as y. Zero where the orbit takes only so long. Empty where the motion cannot be
  // followed.
  Eigen::VectorXd gap_after(int part, const Eigen::VectorXd& y);
  // For an orbit at whose section sliders slip, where their forces cannot follow a change of their limits:
  // the middle of its longest stretch with the fewest that slip; none where none has fewer.
  std::optional<double> section_of_least_slip(const Eigen::VectorXd& y);
  // Where an event has come within 2 % of the map's length: a section that is far from all; otherwise none.
  std::optional<double> better_section(const Shot& shot) const;

  Eigen::VectorXd state(const Eigen::VectorXd& y) const;  // in the units of the flow
  double parameter(const Eigen::VectorXd& y) const { return low_ + (high_ - low_) * y[y.size() - 1]; }
  // The orbit of a shot that closes, at the parameter set.
  AnyOrbit orbit(const Eigen::VectorXd& y, Shot&& shot);
  // The place of the orbit of a shot that closes, its contacts that stick throughout in the middle of where
  // they may rest. Empty where that is not found. Leaves the flow set to the parameter of y.
  Eigen::VectorXd at_rest_in_the_middle(const Eigen::VectorXd& y);
  // Floquet multipliers of what can move, over the whole period, the largest first.
  Eigen::VectorXcd multipliers(const Shot& shot);

  const mechanics::Assembly& assembly() const { return assembly_; }
  // The period map of the same system for orbits of any multiple, without one yet.
  BranchMap another() const { return {assembly_.network(), values_, low_, high_}; }
  const mechanics::LinearSystem& system() const { return multiple_ > 1 ? longer_ : system_; }
  AnyFlow& flow() { return flow_; }
  const AnyFlow& flow() const { return flow_; }

 private:
  double length() const { return (half_period_ ? 0.5 : 1.0) * flow_.equations().period; }
  Eigen::MatrixXd scaled(const Eigen::MatrixXd& by_state) const;
  Eigen::VectorXd by_parameter(const Shot& shot);
  Eigen::VectorXd oscillators_at_section() const;
  double middle_of(const Segment<kAnySize, kAnySize>& stretch) const;
  int slipping_sliders(const Segment<kAnySize, kAnySize>& stretch) const;

  mechanics::Assembly assembly_;
  ValuesAlong values_;
  double low_, high_, at_ = 0.0;  // at_: the parameter set
  mechanics::NetworkValues last_;
  bool has_last_ = false;
  mechanics::LinearSystem system_, longer_;
  AnyFlow flow_;
  Walk<kAnySize, kAnySize> walk_;
  PassageSteps<kAnySize, kAnySize> steps_;  // of the last shot
  PassageSensitivity<kAnySize, kAnySize> sensitivity_;

  int multiple_ = 1;
  bool half_period_ = false;
  double scale_ = 1.0, section_ = 0.0;
  Eigen::MatrixXd root_, root_inverse_;  // R of states in SI
};

}  // namespace frahm::periodic
