#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "solvers/flow/sparse_system.hpp"

namespace frahm::periodic {

// A jump of small changes of the state, of rank one:  dv+ = dv- + change (w_contact^T dv-), or change (by^T
// dz-). Jumps at one instant see the same dz-.
template <class Vector, class State>
struct JumpOf {
  int contact = -1;  // -1: by a form of the state
  Vector change;     // size n
  State by;          // size 2n + s; unset where it is a contact's velocity
};

// What a passage does to small changes dz of the state from which it starts: stretches of the homogeneous
// flow, each ended by jumps of rank one. A passage of a large system records it, so that its tangent can be
// followed afterwards, if at all, and as exactly as its use requires.
struct TangentPath {
  using Jump = JumpOf<Eigen::VectorXd, Eigen::VectorXd>;
  struct Stretch {
    std::size_t mode = 0;
    double steps = 0.0;
    std::vector<Jump> jumps{};   // at its end
    std::vector<int> stopped{};  // internal forces that stay at their limit from its end on: ds+ = 0
  };

  std::size_t first_mode = 0;  // its contacts are stuck at the start: P dv
  std::vector<int> stopped{};  // the same at the start
  std::vector<Stretch> stretches{};
};

// Columns of changes (2n + s rows) at the start of a path become those at its end. held: at the start, then
// of each stretch.
void follow(const TangentPath& path, const SparseSystem& system, std::span<const HeldContacts* const> held,
            Eigen::MatrixXd& columns);
// The same to about 1e-3 of the largest number, in a quarter of the time.
void follow_roughly(const TangentPath& path, const SystemOf<float>& system,
                    std::span<const HeldContacts* const> held, Eigen::MatrixXd& columns);

}  // namespace frahm::periodic
