#include "solvers/quantities/request.hpp"

#include "solvers/mechanics/coordinates.hpp"
#include "solvers/orbits/orbit.hpp"
#include "solvers/quantities/quantity_derivatives.hpp"

namespace frahm::periodic {
namespace {

// The trace that a quantity, or its derivative, is taken of.
Trace trace_of(const QuantityRow& row, std::size_t index, const mechanics::Assembly& assembly) {
  Trace trace{.kind = row.trace};
  switch (row.trace) {
    case TraceKind::displacement:
    case TraceKind::velocity:
    case TraceKind::acceleration:
      trace.at = row.owner == Owner::mass ? mechanics::coordinate_incidence(assembly.network(), index)
                                          : assembly.incidences()[index];
      break;
    case TraceKind::element_force:
      trace.element = index;
      trace.parts = assembly.network().elements[index].parts;
      break;
    case TraceKind::support_force:
      if (index > 0) trace.node = {mechanics::NodeKind::prescribed, index - 1};
      break;
  }
  return trace;
}

void note_use(const QuantityRow& row, Side side, TraceUse& use) {
  if (row.of_trace == OfTrace::range) use.most = use.least = true;
  if (row.of_trace == OfTrace::instant) use.instant = true;
  if (row.of_trace != OfTrace::side) return;
  (side == Side::most ? use.most : side == Side::least ? use.least : use.either) = true;
}

Request request_of(const std::vector<Quantity>& quantities, const mechanics::Assembly& assembly,
                   bool derivatives) {
  Request request;
  for (const Quantity& quantity : quantities) {
    const QuantityRow& row = row_of(quantity.measure);
    Asked asked{quantity};
    if (!derivatives || row.derivative != nullptr) {
      request.needs |= row.needs;
      const bool is_traced =
          row.of_trace != OfTrace::nothing && (derivatives || row.of_trace != OfTrace::size_in_derivative);
      if (is_traced) {
        asked.trace = place_of(trace_of(row, quantity.index, assembly), request.traces);
        request.uses.resize(request.traces.size());
        note_use(row, quantity.side, request.uses[asked.trace]);
      }
    }
    request.quantities.push_back(asked);
  }
  if (derivatives) request.needs.input = false;
  return request;
}

}  // namespace

Request values_of(const std::vector<Quantity>& quantities, const mechanics::Assembly& assembly) {
  return request_of(quantities, assembly, false);
}

Request derivatives_of(const std::vector<Quantity>& quantities, const mechanics::Assembly& assembly) {
  return request_of(quantities, assembly, true);
}

void tell_values(const Request& request, const Measured& measured, std::span<double> out) {
  for (std::size_t i = 0; i < request.quantities.size(); ++i) {
    const Asked& asked = request.quantities[i];
    const QuantityRow& row = row_of(asked.quantity.measure);
    const bool is_missing = row.needs.histories && measured.histories.empty();
    out[i] = is_missing ? missing_value(row.kind) : row.value(measured, asked);
  }
}

bool is_asked(const TraceUse& use, const Candidate& candidate, const Extremes& found, bool half_period) {
  const auto is_extreme = [&](Side side) {
    return is_most(candidate, found, side) || is_least(candidate, found, side);
  };
  if (use.instant) return true;
  if (half_period) return (use.either || use.most || use.least) && is_extreme(Side::either);
  return (use.either && is_extreme(Side::either)) || (use.most && is_extreme(Side::most)) ||
         (use.least && is_extreme(Side::least));
}

void tell_missing(const Request& request, Status status, int unsettled, std::span<double> out) {
  for (std::size_t i = 0; i < request.quantities.size(); ++i) {
    const Measure measure = request.quantities[i].quantity.measure;
    const bool is_counted = measure == Measure::unsettled && status == Status::not_periodic;
    out[i] = is_counted ? unsettled : missing_value(measure, status);
  }
}

void tell_derivatives(const Request& request, const Measured& measured, MeasuredDerivative& by,
                      std::span<double> out, std::span<const char*> why_none) {
  if (request.needs.energies) derivative_of::add_up_losses(measured, by);
  for (std::size_t i = 0; i < request.quantities.size(); ++i) {
    const Asked& asked = request.quantities[i];
    const QuantityRow& row = row_of(asked.quantity.measure);
    const Derivative derivative = row.derivative != nullptr
                                      ? row.derivative(measured, by, asked)
                                      : Derivative{.why_none = row.why_not_differentiated};
    out[i] = derivative.value;
    if (*derivative.why_none != '\0') why_none[i] = derivative.why_none;
  }
}

}  // namespace frahm::periodic
