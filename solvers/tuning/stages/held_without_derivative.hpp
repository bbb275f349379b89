#pragma once

#include <string>
#include <vector>

#include "solvers/tuning/exchange/band_scan.hpp"

namespace frahm::tuning {

// Where several responses may exist: what holds a design although no derivative says how it moves with the
// design, as a sentence without its full stop; "" if nothing does. scan: of the design's curves.
std::string held_without_derivative(const Scan& scan, const std::vector<CurveKind>& curves);

}  // namespace frahm::tuning
