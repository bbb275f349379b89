#pragma once

#include <Eigen/Core>
#include <vector>

#include "solvers/events/least_shares.hpp"
#include "solvers/flow/sizes.hpp"

namespace frahm::periodic {

// Contacts at rest at one instant as one problem, an entry each [N, a step].
struct RestProblem {
  std::vector<Eigen::Index> contacts;
  Eigen::MatrixXd W, G;  // their directions, and W^T M^-1 W
  Eigen::VectorXd bound,
      weight;                   // of their forces; a contact that sticks regardless of its force has no bound
  Eigen::VectorXd force, rate;  // those that let none move, if forces had no bounds
  ContactMask letting_go = 0;   // contacts whose forces have reached their bounds, whatever rounding says

  ContactMask at(Eigen::Index i) const { return bit(contacts[static_cast<std::size_t>(i)]); }
};

// What they do just after the instant.
struct RestOutcome {
  bool found = true;        // otherwise too many changes of an active set
  ContactMask slides = 0;   // contacts that begin to slide
  ContactMask forward = 0;  // those of them that slide forward
  bool is_slow = false;     // their accelerations are zero at the instant itself
  LeastShares shares;       // of the forces that hold the contacts, if none slides
};

// Forces within the bounds that leave no acceleration are sought; where there are none contacts slide at
// once. Otherwise the same is asked of the rates: the force of a contact at its bound cannot grow.
RestOutcome outcome_of(const RestProblem& rest);

}  // namespace frahm::periodic
