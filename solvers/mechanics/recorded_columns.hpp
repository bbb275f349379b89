#pragma once

#include "solvers/mechanics/linear_system.hpp"

// What a network's recorded excitations exert, as columns that multiply the numbers a record has at each
// instant: r, r', r'', r''' (LinearSystem::recorded_force and those next to it).
namespace frahm::mechanics {

inline constexpr Eigen::Index kRecordNumbers = 4;

// Whether number k of all records, one after the other, has its derivative after it: it is no r'''.
inline bool has_derivative(Eigen::Index k) {
  return k % kRecordNumbers + 1 < kRecordNumbers;
}

// Fills the recorded columns of a system with matrices; called by Assembly::set_forcing.
void set_recorded(const Network& network, const NetworkValues& values, LinearSystem& system);

// Their derivative; called by differentiate(), when matrices are differentiated.
void differentiate_recorded(const Network& network, const NetworkValues& values,
                            const NetworkValues& direction, const LinearSystem& system, LinearSystem& d);

}  // namespace frahm::mechanics
