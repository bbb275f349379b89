#pragma once

#include <Eigen/Core>
#include <string>

#include "solvers/identification/decay_extrema.hpp"
#include "solvers/identification/identification.hpp"
#include "solvers/identification/linear_fit.hpp"

// Common parts of the methods for free vibration.
namespace frahm::identification {

// "" where the extremes can be used: at least `least` of them, finite, times increasing and about
// evenly spaced, maxima and minima in turn, not growing; otherwise a sentence that says why not.
std::string unless_decaying(const DecayExtrema& extrema, std::size_t least);

// The standard errors of the extremes, or ones where they are not known.
Eigen::VectorXd displacement_sigma(const DecayExtrema& extrema);

// Appends damped_frequency, from the times of the extremes, half a period apart, and natural_frequency =
// omega_d / sqrt(1 - zeta^2) to a result whose damping_ratio is zeta; nothing where no times are known.
void add_frequencies(const DecayExtrema& extrema, double zeta, Identification& result);

// The measured extremes next to their fitted values.
FittedRecord extrema_record(const DecayExtrema& extrema, const Eigen::VectorXd& fitted);

}  // namespace frahm::identification
