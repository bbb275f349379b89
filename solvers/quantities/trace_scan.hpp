#pragma once

#include <functional>
#include <span>
#include <vector>

#include "solvers/flow/polynomial.hpp"
#include "solvers/quantities/candidate.hpp"

// The extremes of a trace that is known over the steps of an orbit: stationary points solved, never the
// largest sample, and both one-sided limits wherever the mode changes.
namespace frahm::periodic {

// Values and slopes (a step) at both ends of a step, seen from inside its mode.
struct TraceStep {
  double start = 0.0, length = 1.0;  // [steps]
  ValueAndSlope left{}, right{};
  bool starts_segment = false, ends_segment = false;
};

// The trace's Taylor polynomial over a step, called where an extreme may lie within.
using StepPolynomial = std::function<Polynomial(std::size_t step)>;

// The stationary points of a step's polynomial, fractions of a whole step. After a stop or a release its
// slope starts from zero like s or s^2: that root is the step's end, and is divided out.
Roots stationary_points(const Polynomial& p);

// section: omega t where the steps begin [rad]; rate: omega t per step [rad].
Extremes scan_extremes(std::span<const TraceStep> trace, double section, double rate,
                       const StepPolynomial& polynomial);

// The same extremes with all candidates for them; their phases are left out. section_sign: of the trace
// beyond the last step.
Extremes scan_candidates(std::span<const TraceStep> trace, double section_sign,
                         const StepPolynomial& polynomial, std::vector<Candidate>& candidates);

}  // namespace frahm::periodic
