#pragma once

#include <span>

#include "solvers/quantities/measured.hpp"

// The one table of the quantities: what they are called, what must be measured for them, and how they and
// their derivatives follow from that.
namespace frahm::periodic {

// The owner of a quantity; `mass` is a mass or a signal, `contact` an element with one contact, `sliders` one
// with several (iwan), `support` the ground or a prescribed node,
// `structure` the damping of the structure as a whole, where there is one, `coexistence` the search for
// several responses, where there may be, `offsets` the places of sliders (jenkins, iwan), where there are
// any.
enum class Owner { mass, element, contact, sliders, point, mode, support, structure, coexistence, offsets };

// Whether the standard record of an atlas has the quantity, and for which of its owners.
enum class StandardOf { none, masses, springs, contacts, point, coexistence, offsets };
struct Standard {
  StandardOf of = StandardOf::none;
  int rank = 0;  // position among those of one owner, from 1
};

// For which owners a page shows the quantity by default.
enum class Shown { no, of_all, of_springs, of_dissipating };

struct FlagMeaning {
  const char* meaning;
  int value;
};

// What is requested of a trace (trace.hpp).
enum class OfTrace {
  nothing,
  side,                // its largest value on one side, or on either
  range,               // both sides
  instant,             // when its largest value is first reached
  size,                // its magnitude: a component far below it is rounding
  size_in_derivative,  // the same, for the derivative alone
};

// What has to be measured in addition to traces.
struct Needs {
  bool integrals = false;  // the Gram matrix of state and oscillators
  bool energies = false;   // energy that friction takes, for the dissipation of each element
  bool input = false;      // the work of the excitation; derivatives do without: work in = energy lost
  bool histories = false;  // of the contacts: a law that never sticks has none
  bool stability = false;  // of the orbit: the spectrum of its period map
  bool modes = false;      // of the linear system

  Needs& operator|=(const Needs& other) {
    integrals |= other.integrals;
    energies |= other.energies;
    input |= other.input;
    histories |= other.histories;
    stability |= other.stability;
    modes |= other.modes;
    return *this;
  }
};

struct QuantityRow {
  Measure measure;
  Owner owner;
  bool of_free_masses = false;  // only of networks in which some mass may be held by no spring
  const char* suffix;
  const char* unit;     // UDUNITS form
  const char* meaning;  // {} stands for the owner's name
  QuantityKind kind = QuantityKind::real;
  std::span<const FlagMeaning> flags = {};
  bool of_a_period = false;  // over n periods n times as large
  Standard standard = {};
  Shown shown = Shown::no;
  bool stored_always = false;                 // whatever a study lists
  TraceKind trace = TraceKind::displacement;  // of what `of_trace` is asked
  OfTrace of_trace = OfTrace::nothing;
  Needs needs = {};
  double (*value)(const Measured&, const Asked&) = nullptr;
  // nullptr: not differentiated, because:
  Derivative (*derivative)(const Measured&, const MeasuredDerivative&, const Asked&) = nullptr;
  const char* why_not_differentiated = "";
};

std::span<const QuantityRow> quantity_table();  // in the order of Measure
const QuantityRow& row_of(Measure measure);

}  // namespace frahm::periodic
