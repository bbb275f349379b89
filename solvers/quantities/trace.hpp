#pragma once

#include <optional>
#include <vector>

#include "solvers/flow/linear_form.hpp"
#include "solvers/quantities/quantity.hpp"

// What a quantity's extremes over a period are those of.
namespace frahm::periodic {

struct Trace {
  // amplitude (displacements of masses and elements), velocity_peak, acceleration_peak, force_peak,
  // transmitted_force
  Measure measure = Measure::amplitude;
  mechanics::Incidence at{};  // of the first three
  std::size_t element = 0;    // of force_peak
  mechanics::Node node{};     // of transmitted_force
};

bool operator==(const Trace& a, const Trace& b);

// Of a mass's own displacement.
mechanics::Incidence mass_incidence(const mechanics::Network& network, std::size_t mass);

// The trace of a quantity that is an extreme, or a phase, of one.
std::optional<Trace> trace_of(const Quantity& quantity, const mechanics::Assembly& assembly);

// The trace's place in `traces`, to which it is added where it is new.
std::size_t place_of(Trace trace, std::vector<Trace>& traces);

template <int N, int H>
LinearForm<N, H> form_of(const Trace& trace, const Forms<N, H>& forms,
                         const std::vector<mechanics::ElementCoefficients>& coefficients, const Mode<N, H>& mode) {
  switch (trace.measure) {
    case Measure::velocity_peak:
      return forms.velocity(trace.at);
    case Measure::acceleration_peak:
      return forms.acceleration(trace.at, mode);
    case Measure::force_peak:
      return forms.element_force(trace.element, coefficients[trace.element], mode);
    case Measure::transmitted_force:
      return forms.node_force(trace.node, coefficients, mode);
    default:
      return forms.displacement(trace.at);
  }
}

}  // namespace frahm::periodic
