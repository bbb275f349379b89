#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "solvers/exact/response.hpp"
#include "solvers/quantities/quantity.hpp"

// Excitations whose orders have a common divisor g > 1: order 30 alone, or 4 and 6. The motion repeats g
// times in a period of the fundamental omega. So it is solved with the orders divided by g, at g omega: a
// search covers a g-th of the time, and each of its steps resolves the motion g times as well. The result is
// converted to the period of omega.
namespace frahm::periodic {

// For the orders above zero, a crank counting as its first; 1 where there is none.
int common_divisor(const mechanics::Network& network);

// A solver for a network whose orders have a common divisor, over one that `make` gives for the divided
// orders. For a period of the network's own fundamental: energies and counts are g times those of the shorter
// period, Floquet multipliers their power g, and omega t is a g-th of g omega t; the regime follows
// from the stops of the whole period. ResponseSummary::half_period is that of the shorter one. Where g does
// not divide the reference order the response has no component there: `harmonic` is 0, and what takes
// its phase or its ratio to another such component is NaN.
std::unique_ptr<ResponseSolver> divide_orders(
    const mechanics::Network& network, std::vector<Quantity> quantities,
    const std::function<std::unique_ptr<ResponseSolver>(const mechanics::Network&, std::vector<Quantity>)>&
        make);

}  // namespace frahm::periodic
