#pragma once

#include "solvers/tuning/exchange/band_curve.hpp"

namespace frahm::tuning {

// Leaves `curve` solved, with these derivatives, at the design x and the first local maximum over the band of
// one of its sides uphill from `near`, within [from, to]. By the envelope theorem the maximum's derivatives
// by the design are those of the curve there. Where the curve jumps the climb ends at the highest point that
// it has met: the end of a stretch, of which the derivatives do not say how it moves with the design. Returns
// whether there is a response.
bool follow_maximum(BandCurve& curve, std::span<const double> x, double near, double from, double to,
                    std::size_t side, Derivatives derivatives);

}  // namespace frahm::tuning
