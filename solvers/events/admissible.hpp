#pragma once

#include <Eigen/Core>
#include <functional>

#include "solvers/flow/sizes.hpp"

// Who slides, of contacts at rest at one instant whose forces act on one another, where some hold more at
// rest than they do sliding (F_s > F). Each sticks, |lambda| <= F_s, or slides with lambda = +-F the way that
// its relative acceleration c - G lambda, or its first derivative that is not zero, goes. A choice for all is
// admissible when each does what it claims under the forces that all together give. There may be several: a
// force that falls from F_s to F takes along what it held. One there always is, that for which F_s = F
// (box_minimum.hpp). The choice made is, of the admissible ones, that in which most stick; of these that
// which keeps most of what stuck before; then that of least sum (lambda / F_s)^2.
namespace frahm::periodic {

// An entry for each contact; in masks entry i is bit(i).
struct ContactsAtRest {
  Eigen::MatrixXd G;             // W^T M^-1 W
  Eigen::VectorXd free;          // c, their relative accelerations if they had no friction
  Eigen::VectorXd kinetic;       // F > 0
  Eigen::VectorXd limit;         // F_s >= F
  bool has_loops = false;        // G may be singular
  ContactMask held = 0;          // those that stick whatever their force
  ContactMask stuck_before = 0;  // up to this instant
  ContactMask letting_go = 0;    // whose force has reached its limit and is about to exceed it
};

struct RestChoice {
  bool found = false;
  ContactMask stuck = 0, forward = 0;
  // Whose claim the instant itself does not decide: a force at its limit, an acceleration of zero.
  ContactMask on_edge = 0;
  Eigen::VectorXd force, acceleration;  // lambda, c - G lambda
  double margin = 1.0;  // relative distance of the forces and accelerations from another choice
  int trials = 0;       // choices looked at, each about the work of an event
};

// Those of choice.on_edge that do not do just after the instant what they claim.
using BrokenClaims = std::function<ContactMask(const RestChoice& choice)>;

// By trial of all choices, those with most contacts stuck first, where bounds leave at most 3^8 of them.
// Otherwise by an active set that looks at every contact again after each change; where it comes back to a
// choice, that for F_s = F is taken. Some other admissible choice may then be preferable. found = false:
// claims that the instant does not decide are broken in all choices.
RestChoice admissible_choice(const ContactsAtRest& rest, const BrokenClaims& broken);

}  // namespace frahm::periodic
