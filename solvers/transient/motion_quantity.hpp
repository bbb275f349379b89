#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "solvers/mechanics/network.hpp"
#include "solvers/quantities/quantity.hpp"

// The quantities that a motion from given initial values is reported in: their names, units and meanings.
namespace frahm::transient {

enum class MotionMeasure {
  // of a mass or a signal
  peak,
  peak_time,
  velocity_peak,
  acceleration_peak,
  rms,
  velocity_rms,
  residual,
  // of a mass or a signal of an oscillator, a network of one mass
  pseudo_velocity,
  pseudo_acceleration,
  // of an element
  stroke,
  energy,
  energy_share,
  // of an element with a contact
  slips,
  // of a structure that damps
  damping_energy,
  damping_energy_share,
  // of the motion
  initial_energy,
  final_energy,
  energy_input,
  energy_balance,
  discretisation_error,
  status,
};

struct MotionQuantity {
  MotionMeasure measure = MotionMeasure::status;
  std::size_t index = 0;  // of the coordinate (mechanics/coordinates.hpp) or element

  friend bool operator==(const MotionQuantity&, const MotionQuantity&) = default;
};

// The status is not_computed, ok or failed, with the numbers of periodic::Status.
periodic::QuantityDescription describe(const MotionQuantity& quantity, const mechanics::Network& network,
                                       bool dimensionless);

// A quantity of any motion: "peak_time", "s", "time of the largest displacement of {}".
struct MotionQuantityWords {
  std::string_view suffix, unit, meaning;
  std::string_view owner;  // "NODE", a mass or a signal, "ELEMENT", or "" of the motion as a whole
};
std::vector<MotionQuantityWords> motion_quantity_words();

// Every quantity of a network's motion, in a fixed order. of_run_up: the frequency runs.
std::vector<MotionQuantity> all_motion_quantities(const mechanics::Network& network, bool of_run_up);

// Peak, acceleration peak and residual of each mass and signal; stroke of each spring; stroke, slips and
// energy of each element with a contact; the structure's energy; energy_input, energy_balance and status.
std::vector<MotionQuantity> standard_motion_quantities(const mechanics::Network& network, bool of_run_up);

// Whether a page shows the quantity of this name unasked: peaks of displacement and acceleration, strokes,
// residuals, shares of energy, slips and the status.
bool is_shown_of_motion(const std::string& name);

// The value of a quantity of a motion that is not computed.
double missing_value(const MotionQuantity& quantity);

}  // namespace frahm::transient
