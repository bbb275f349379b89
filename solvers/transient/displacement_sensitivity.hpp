#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "solvers/mechanics/network.hpp"
#include "solvers/transient/motion.hpp"
#include "solvers/transient/record.hpp"

namespace frahm::transient {

// The displacement of a mass or signal at given times, and its exact derivatives at fixed time: through
// stops, releases and reversals.
//
// So a peak has derivatives too. Where |x| is largest its time t* moves with a parameter, but x'(t*) = 0, or
// t* is an end of the motion:  d|x(t*)|/dp = sign(x) dx/dp at the fixed time t*  (envelope theorem).
struct DisplacementSensitivity {
  std::string failure;           // why the motion could not be followed; empty: it could
  std::string why_none;          // why there is no derivative, where one was asked for; empty: there is one
  Eigen::VectorXd displacement;  // at each time [m]
  Eigen::MatrixXd by;            // times x directions: its derivatives
};

// For a motion from rest under records, together with which constant forces may act.
// coordinate: the mass or signal (mechanics/coordinates.hpp).  times: ascending [s], >= 0, at least one.
// along: directions, derivatives of the values (mechanics/system_derivative.hpp); may be empty.
// Throws mechanics::MechanicsError for values and records without a meaning, for another excitation, and for
// a direction that changes the frequency, which such a motion does not have.
DisplacementSensitivity displacement_sensitivity(const mechanics::Network& network,
                                                 const mechanics::NetworkValues& values,
                                                 std::span<const mechanics::NetworkValues> along,
                                                 std::span<const RecordedExcitation> records,
                                                 std::size_t coordinate, std::span<const double> times,
                                                 const Watch& watch);

}  // namespace frahm::transient
