#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "solvers/identification/decay_extrema.hpp"
#include "solvers/identification/identification.hpp"

// The damping ratio of a freely vibrating mass from the logarithm of its extremes: delta = ln(x_i / x_{i+2}),
// a cycle apart, zeta = delta / sqrt(4 pi^2 + delta^2), to first order delta / (2 pi). For viscous damping.
namespace frahm::identification {

// Estimates, by regression of ln|x_i| over the extremes, weighed by their standard errors: log_decrement,
// damping_ratio, damping_ratio_first_order; from their times damped_frequency, natural_frequency [rad/s];
// from the first and the last extreme of the cycles alone: log_decrement_over_cycles,
// damping_ratio_over_cycles, damping_ratio_first_order_over_cycles. cycles: counted from the first extreme;
// absent: as many as there are. failure: fewer extremes than 2 cycles + 1 or than three, an oscillation that
// grows.
Identification log_decrement(const DecayExtrema& extrema, std::optional<std::size_t> cycles);
// The same from a trace [s], [m]; its extremes are a record of the result.
Identification log_decrement(std::span<const double> time, std::span<const double> displacement,
                             std::optional<std::size_t> cycles);

}  // namespace frahm::identification
