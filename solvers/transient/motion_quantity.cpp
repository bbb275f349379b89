#include "solvers/transient/motion_quantity.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <string_view>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/coordinates.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/rotation.hpp"
#include "solvers/mechanics/structural_damping.hpp"
#include "solvers/orbits/orbit.hpp"

namespace frahm::transient {
namespace {

using mechanics::Network;
using periodic::QuantityKind;

enum class Owner { coordinate, oscillator, element, dissipating, contact, structure, run_up, motion };

struct Row {
  MotionMeasure measure;
  Owner owner;
  std::string_view suffix;
  std::string_view unit;  // of a translation
  std::string_view meaning;
  bool standard = false;
  bool shown = false;
  QuantityKind kind = QuantityKind::real;
};

using enum MotionMeasure;
constexpr Row kTable[] = {
    {peak, Owner::coordinate, "peak", "m", "largest displacement of {} in either direction", true, true},
    {peak_time, Owner::coordinate, "peak_time", "s", "time of the largest displacement of {}"},
    {velocity_peak, Owner::coordinate, "velocity_peak", "m s-1",
     "largest velocity of {} in either direction"},
    {acceleration_peak, Owner::coordinate, "acceleration_peak", "m s-2",
     "largest acceleration of {} in either direction", true, true},
    {rms, Owner::coordinate, "rms", "m", "root mean square of the displacement of {} over the motion"},
    {velocity_rms, Owner::coordinate, "velocity_rms", "m s-1",
     "root mean square of the velocity of {} over the motion"},
    {residual, Owner::coordinate, "residual", "m", "displacement of {} at the end", true, true},
    {pseudo_velocity, Owner::oscillator, "pseudo_velocity", "m s-1",
     "largest displacement of {} times the natural angular frequency", false, true},
    {pseudo_acceleration, Owner::oscillator, "pseudo_acceleration", "m s-2",
     "largest displacement of {} times the square of the natural angular frequency", false, true},
    {stroke, Owner::element, "stroke", "m", "largest relative displacement across {} in either direction",
     true, true},
    {energy, Owner::dissipating, "energy", "J", "energy dissipated by {}", true},
    {energy_share, Owner::dissipating, "energy_share", "1", "share of {} in the energy dissipated", false,
     true},
    {slips, Owner::contact, "slips", "1", "number of phases in which {} slides", true, true,
     QuantityKind::count},
    {damping_energy, Owner::structure, "damping_energy", "J",
     "energy dissipated by the damping of the structure", true},
    {damping_energy_share, Owner::structure, "damping_energy_share", "1",
     "share of the damping of the structure in the energy dissipated", false, true},
    {initial_energy, Owner::motion, "initial_energy", "J", "kinetic and potential energy at the start"},
    {final_energy, Owner::motion, "final_energy", "J", "kinetic and potential energy at the end"},
    {energy_input, Owner::motion, "energy_input", "J", "work of the excitation", true},
    {energy_balance, Owner::motion, "energy_balance", "1",
     "energy at the start plus energy put in, minus energy dissipated and energy at the end, relative", true},
    {discretisation_error, Owner::run_up, "discretisation_error", "m",
     "largest change of any displacement when the frequency steps of the run-up were last halved", true},
    {status, Owner::motion, "status", "", "how the computation of the motion ended", true, true,
     QuantityKind::flag},
};

const Row& row_of(MotionMeasure measure) {
  return *std::ranges::find(kTable, measure, &Row::measure);
}

bool is_of_coordinates(Owner owner) {
  return owner == Owner::coordinate || owner == Owner::oscillator;
}

bool is_of_elements(Owner owner) {
  return owner == Owner::element || owner == Owner::dissipating || owner == Owner::contact;
}

// How many there are, of elements all.
std::size_t owner_count(Owner owner, const Network& network, bool of_run_up) {
  if (owner == Owner::oscillator && network.masses.size() != 1) return 0;
  if (is_of_coordinates(owner)) return mechanics::coordinate_count(network);
  if (is_of_elements(owner)) return network.elements.size();
  if (owner == Owner::structure) return mechanics::has_structural_damping(network) ? 1 : 0;
  return owner == Owner::run_up && !of_run_up ? 0 : 1;
}

// Whether an element has the quantity. The parts of another have none, and a stroke has no end on a belt.
bool has(const Row& row, const Network& network, const mechanics::Element& element) {
  if (element.parts == 0) return false;
  if (row.owner == Owner::dissipating) return mechanics::kind_of(element).dissipates;
  if (row.owner == Owner::contact) return mechanics::has_own_contact(element);
  return !mechanics::is_on_belt(network, element.along);
}

// For springs the stroke, of elements with a contact all.
bool is_standard_of(const Row& row, const mechanics::Element& element) {
  const bool is_spring = mechanics::kind_of(element).stroke_is_standard && row.measure == stroke;
  return is_spring || mechanics::has_contact(element);
}

std::string owner_name(const Row& row, std::size_t index, const Network& network) {
  if (is_of_coordinates(row.owner)) return mechanics::coordinate_name(network, index);
  return is_of_elements(row.owner) ? network.elements[index].name : "";
}

std::string_view unit_of(const Row& row, std::size_t index, const Network& network) {
  const bool is_motion = row.unit.starts_with("m");
  if (!is_motion) return row.unit;
  if (is_of_coordinates(row.owner)) return mechanics::coordinate_unit(network, index, row.unit);
  if (row.owner == Owner::element) return mechanics::unit_of_element(network.elements[index], row.unit);
  const bool all_rotate = std::ranges::all_of(network.rotation, std::identity{}) && !network.rotation.empty();
  return all_rotate ? mechanics::unit_of_rotation(row.unit) : row.unit;
}

std::string joined(std::string first, std::string_view second) {
  first += '_';
  first += second;
  return first;
}

template <class Wanted>
std::vector<MotionQuantity> quantities_where(const Network& network, bool of_run_up, const Wanted& wanted) {
  std::vector<MotionQuantity> result;
  for (const Row& row : kTable) {
    for (std::size_t i = 0; i < owner_count(row.owner, network, of_run_up); ++i) {
      if (is_of_elements(row.owner) && !has(row, network, network.elements[i])) continue;
      if (wanted(row, i)) result.push_back({row.measure, i});
    }
  }
  return result;
}

}  // namespace

periodic::QuantityDescription describe(const MotionQuantity& quantity, const Network& network,
                                       bool dimensionless) {
  const Row& row = row_of(quantity.measure);
  const std::string owner = owner_name(row, quantity.index, network);
  periodic::QuantityDescription result{
      .name = owner.empty() ? std::string(row.suffix) : joined(owner, row.suffix),
      .unit = dimensionless ? "1" : std::string(unit_of(row, quantity.index, network)),
      .long_name = std::string(row.meaning),
      .kind = row.kind,
      .flags = {}};
  if (const auto braces = result.long_name.find("{}"); braces != std::string::npos)
    result.long_name.replace(braces, 2, owner);
  if (row.measure == status) {
    using periodic::Status;
    result.flags = {{"not_computed", static_cast<int>(Status::not_computed)},
                    {"ok", static_cast<int>(Status::ok)},
                    {"failed", static_cast<int>(Status::failed)}};
  }
  return result;
}

std::vector<MotionQuantityWords> motion_quantity_words() {
  std::vector<MotionQuantityWords> words;
  for (const Row& row : kTable)
    words.push_back({row.suffix, row.unit, row.meaning,
                     is_of_coordinates(row.owner) ? "NODE"
                     : is_of_elements(row.owner)  ? "ELEMENT"
                                                  : ""});
  return words;
}

std::vector<MotionQuantity> all_motion_quantities(const Network& network, bool of_run_up) {
  return quantities_where(network, of_run_up, [](const Row&, std::size_t) { return true; });
}

std::vector<MotionQuantity> standard_motion_quantities(const Network& network, bool of_run_up) {
  return quantities_where(network, of_run_up, [&](const Row& row, std::size_t i) {
    return row.standard && (!is_of_elements(row.owner) || is_standard_of(row, network.elements[i]));
  });
}

bool is_shown_of_motion(const std::string& name) {
  const Row* best = nullptr;
  for (const Row& row : kTable) {
    if (name != row.suffix && !name.ends_with(joined("", row.suffix))) continue;
    if (best == nullptr || row.suffix.size() > best->suffix.size()) best = &row;
  }
  return best != nullptr && best->shown;
}

double missing_value(const MotionQuantity& quantity) {
  if (quantity.measure == status) return static_cast<double>(periodic::Status::failed);
  return periodic::missing_value(row_of(quantity.measure).kind);
}

}  // namespace frahm::transient
