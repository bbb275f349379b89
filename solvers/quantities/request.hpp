#pragma once

#include <span>
#include <vector>

#include "solvers/quantities/quantity_table.hpp"

// From the requested quantities to the measurements they need, and from these back to the quantities.
namespace frahm::periodic {

// What is requested of a trace.
struct TraceUse {
  bool either = false, most = false, least = false;  // its largest value on these sides
  bool instant = false;                              // when it is first reached
};

struct Request {
  std::vector<Asked> quantities;
  std::vector<Trace> traces;   // each once
  std::vector<TraceUse> uses;  // of each trace
  Needs needs;
};

Request values_of(const std::vector<Quantity>& quantities, const mechanics::Assembly& assembly);
// The request for the derivatives of those quantities that have one.
Request derivatives_of(const std::vector<Quantity>& quantities, const mechanics::Assembly& assembly);

// out[i] is quantity i. Quantities that only a law with sticking has are missing for a law without.
void tell_values(const Request& request, const Measured& measured, std::span<double> out);
// For a point without a response.
void tell_missing(const Request& request, Status status, int unsettled, std::span<double> out);
// out[i] is the derivative of quantity i; where there is none, NaN, and why_none[i] says why.
void tell_derivatives(const Request& request, const Measured& measured, MeasuredDerivative& by,
                      std::span<double> out, std::span<const char*> why_none);

// Whether a requested derivative is that of this candidate. found: the extremes of all candidates.
bool is_asked(const TraceUse& use, const Candidate& candidate, const Extremes& found, bool half_period);

}  // namespace frahm::periodic
