#pragma once

#include "solvers/flow/sizes.hpp"

namespace frahm::periodic {

// The bends of a system (laws/bend.hpp), with time counted in steps as in StepEquations: beyond its place D
// each adds k (u - D) + c u', or c (u' - D) of a velocity, u = b^T q + p^T y.
template <int N, int H>
struct StepBends {
  using S = Sizes<N, H>;

  typename S::VectorByContacts B, MB;  // directions, M^-1 B (n x number)
  Eigen::MatrixXd contact_pull;        // W^T M^-1 B, of a large system
  typename S::Contacts stiffness, damping, place;
  typename S::ContactsByOscillators motion, motion_velocity, motion_acceleration;  // p^T y(t) and its rates
  ContactMask of_velocity = 0;  // bends at a place of the velocity
  ContactMask pulling = 0;      // bends that end at their place
  ContactMask jumping = 0;      // bends whose force jumps where they begin, by c u'

  Eigen::Index count() const { return stiffness.size(); }

  // sum_j k_j b_j b_j^T and sum_j c_j b_j b_j^T over the bends of `beyond`, added to K and C.
  template <class Square>
  void add_stiffness(ContactMask beyond, Square& K) const {
    for (Eigen::Index j = 0; beyond != 0 && j < count(); ++j) {
      if (contains(beyond, j) && stiffness[j] != 0.0)
        K.noalias() += stiffness[j] * B.col(j) * B.col(j).transpose();
    }
  }
  template <class Square>
  void add_damping(ContactMask beyond, Square& C) const {
    for (Eigen::Index j = 0; beyond != 0 && j < count(); ++j) {
      if (contains(beyond, j) && damping[j] != 0.0)
        C.noalias() += damping[j] * B.col(j) * B.col(j).transpose();
    }
  }
  // The part of a bend's force that the masses do not move: k (p^T y - D) + c p^T y', or c (p^T y' - D).
  typename S::OscillatorRow support_force(Eigen::Index j) const {
    typename S::OscillatorRow row = damping[j] * motion_velocity.row(j);
    if (stiffness[j] != 0.0) row += stiffness[j] * motion.row(j);
    row[0] -= (contains(of_velocity, j) ? damping[j] : stiffness[j]) * place[j];
    return row;
  }
  // The forces on the masses that they do not move themselves, added to those of the excitation; along: B, or
  // M^-1 B for the accelerations.
  void add_force(ContactMask beyond, const typename S::VectorByContacts& along,
                 typename S::VectorByOscillators& force) const {
    for (Eigen::Index j = 0; beyond != 0 && j < count(); ++j) {
      if (contains(beyond, j)) force.noalias() -= along.col(j) * support_force(j);
    }
  }
};

}  // namespace frahm::periodic
