#pragma once

#include <optional>

#include "solvers/smooth/equation.hpp"

namespace frahm::smooth {

// Where the search for equivalent dampers begins. Under a curve that falls they may differ.
enum class Equivalents {
  from_rest,     // the tangents of the curves at rest
  from_sliding,  // the response without friction; at rest where there is none
};

// The steady state with the friction of each term replaced by its mean and by the damper that takes as much
// energy: that of harmonic balance, where the velocities have one harmonic. Not finite where there is none.
SteadyState equivalent_response(const Equation& equation, Equivalents begin);

// A start for the search of an orbit: that steady state at phase 0. None where it is infinite, or so large
// that it is all but so.
std::optional<Eigen::VectorXd> equivalent_start(const Equation& equation, Equivalents begin);

}  // namespace frahm::smooth
