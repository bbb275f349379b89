#pragma once

#include <vector>

#include "solvers/mechanics/linear_system.hpp"

// A quantity that varies over a period, and whose extremes are requested.
namespace frahm::periodic {

enum class TraceKind { displacement, velocity, acceleration, element_force, support_force };

struct Trace {
  TraceKind kind = TraceKind::displacement;
  mechanics::Incidence at{};  // of displacement, velocity and acceleration
  std::size_t element = 0;    // of element_force
  std::size_t parts = 1;      // of that element
  mechanics::Node node{};     // of support_force
};

bool operator==(const Trace& a, const Trace& b);

// Index of the trace in `traces`; a new trace is added.
std::size_t place_of(Trace trace, std::vector<Trace>& traces);

// The force of an element and of the parts that follow it.
template <class Forms, class... Mode>
auto force_form(const Forms& forms, std::size_t element, std::size_t parts,
                const mechanics::LinearSystem& system, const Mode&... mode) {
  auto form = forms.element_force(element, system.coefficients[element], mode...);
  for (std::size_t e = element + 1; e < element + parts; ++e)
    form.add(1.0, forms.element_force(e, system.coefficients[e], mode...));
  return form;
}

// The linear form of a trace by the forms of a law (flow/linear_form.hpp, smooth/forms.hpp). mode...: what
// the law's accelerations and forces depend on in addition to the state.
template <class Forms, class... Mode>
auto form_of(const Trace& trace, const Forms& forms, const mechanics::LinearSystem& system,
             const Mode&... mode) {
  switch (trace.kind) {
    case TraceKind::velocity:
      return forms.velocity(trace.at);
    case TraceKind::acceleration:
      return forms.acceleration(trace.at, mode...);
    case TraceKind::element_force:
      return force_form(forms, trace.element, trace.parts, system, mode...);
    case TraceKind::support_force:
      return forms.node_force(trace.node, system, mode...);
    case TraceKind::displacement:
      break;
  }
  return forms.displacement(trace.at);
}

}  // namespace frahm::periodic
