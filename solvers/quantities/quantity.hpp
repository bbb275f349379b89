#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "solvers/mechanics/network.hpp"

// The quantities that a periodic response is reported in: their names, units and meanings.
namespace frahm::periodic {

enum class Measure {
  // of a mass or a signal
  amplitude,
  peak,
  mean,
  rms,
  phase,
  peak_phase,
  velocity_peak,
  acceleration_peak,
  harmonic,
  drift,
  mean_velocity,
  magnification,
  transmissibility,
  // of an element
  stroke,
  element_phase,
  force_peak,
  energy,
  energy_share,
  // of a Coulomb element
  stops,
  reversals,
  stuck_fraction,
  regime,
  // of an iwan element
  slipping,
  // of the response
  status,
  floquet_radius,
  coexisting,
  period_multiple,
  unsettled,
  continuum,
  energy_input,
  energy_balance,
  damping_energy,
  damping_energy_share,
  transmitted_force,
  force_transmissibility,
  residual,
  error_bound,
  newton_iterations,
  events,
  natural_frequency,
  modal_damping,
};

enum class Regime {
  not_computed = 0,
  no_friction = 1,
  non_stop = 2,
  one_stop = 3,
  multi_stop = 4,
  stuck = 5
};

// For a peak: the larger of both, the largest value, or the least with its sign turned. One side alone is for
// an optimiser, for which the larger of both has a kink; it has no name of its own, and all_quantities() does
// not list it.
enum class Side { either, most, least };

struct Quantity {
  Measure measure = Measure::status;
  // For the coordinate (mechanics/coordinates.hpp) or element; of a mode from 0; for transmitted_force 0 =
  // ground, 1 + s = prescribed node s.
  std::size_t index = 0;
  // For peak, stroke, velocity_peak, acceleration_peak, force_peak, transmitted_force.
  Side side = Side::either;

  friend bool operator==(const Quantity&, const Quantity&) = default;
};

enum class QuantityKind { real, count, flag };

enum class Status;  // solvers/orbits/orbit.hpp

struct QuantityDescription {
  std::string name;       // "main_peak"
  std::string unit;       // UDUNITS form; "1" where `dimensionless`
  std::string long_name;  // "largest displacement of main, either way"
  QuantityKind kind = QuantityKind::real;
  std::vector<std::pair<std::string, int>> flags;  // of a flag: meaning and value
};

// Everything below is read from one table (quantity_table.hpp).

QuantityDescription describe(const Quantity& quantity, const mechanics::Network& network, bool dimensionless);

// Every quantity that a network has, in a fixed order. Under smooth laws nothing ever sticks: stops,
// reversals and events are -1 (not computed), stuck_fraction is NaN and the regime not_computed; nor is there
// an error_bound, as that of the integration is not one.
std::vector<Quantity> all_quantities(const mechanics::Network& network);

// Record of an atlas: peak, amplitude, mean, rms and phase of each mass and signal; stroke of each spring;
// stops, stuck fraction, regime and energy of each element with a contact (of an iwan element how many
// sliders slip, and their energy); status, floquet_radius, energy_balance, residual, error_bound,
// transmitted_force.
std::vector<Quantity> standard_quantities(const mechanics::Network& network);

// These, and after them what every record has, whatever is listed: how the search ended, and whether its
// response is all there is.
std::vector<Quantity> with_always_stored(std::vector<Quantity> listed, const mechanics::Network& network);

// Whether the page of an atlas shows the quantity unasked: peaks of masses and signals, strokes of the
// springs, stops and regimes, the shares of what dissipates, and the status.
bool is_shown(const Quantity& quantity, const mechanics::Network& network);
// The same for a name whose network is not known: by its suffix, of any element.
bool is_shown(const std::string& name);

std::optional<Quantity> find_quantity(const std::string& name, const mechanics::Network& network);

// The value of a quantity that is not computed: NaN for a real, -1 for a count, 0 for a flag.
double missing_value(QuantityKind kind);
bool is_missing(QuantityKind kind, double value);
// The same for a response that ended in this status, the one quantity that has a value then.
double missing_value(Measure measure, Status status);

// Why PeriodicResponse::gradient() does not differentiate a quantity: it is a count, a flag or a number about
// the computation itself, or would take the second derivative of the period map. "" where it does.
const char* why_not_differentiated(Measure measure);
inline bool is_differentiable(Measure measure) {
  return *why_not_differentiated(measure) == '\0';
}

bool is_angle(Measure measure);  // [rad], the same after a turn
// Whether the quantity is the larger of two sides, and so has a kink where they are equal (Side).
bool has_sides(Measure measure);
// Whether the quantity is counted per period: over n periods it is n times as large.
bool is_of_a_period(Measure measure);

}  // namespace frahm::periodic
