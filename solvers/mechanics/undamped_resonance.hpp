#pragma once

#include <Eigen/Core>
#include <vector>

#include "solvers/mechanics/linear_system.hpp"

namespace frahm::periodic {

// A mode in which no damping acts, C phi = 0 and no Maxwell element is strained; phi^T M phi = 1.
struct UndampedMode {
  double frequency = 0.0;  // [rad/s]
  Eigen::VectorXd shape;
};

// All undamped modes of a system that oscillate, with its friction sliding, at velocities beyond the points
// of its dampers' tables. For several modes of one frequency: a basis of their undamped combinations.
std::vector<UndampedMode> undamped_modes(const mechanics::LinearSystem& system);

// Whether an undamped mode is driven at its resonance harder than friction can hold: n omega = omega_phi to
// 1e-12 and pi |p_n| >= 4 sum_j F_j |w_j^T phi|, p_n = phi^T f_n. In a cycle of amplitude X the force puts in
// pi |p_n| X and friction takes out 4 F X at most: no amplitude balances (Den Hartog 1931; one mass: F/P <=
// pi/4). F_j is the friction at high speed: of a curve over the speed its end, of a damper whose table ends
// level the force there. Of monotone laws no response exists then; under others motions that are large enough
// grow, though smaller ones may settle.
bool is_unbounded(const mechanics::LinearSystem& system, const std::vector<UndampedMode>& modes);

// The same with the static limits of the contacts: no force of friction balances this drive, however long the
// contacts stick, so that no response exists. Between the two limits one may: rest that static friction
// holds.
bool is_unbounded_even_held(const mechanics::LinearSystem& system, const std::vector<UndampedMode>& modes);

}  // namespace frahm::periodic
