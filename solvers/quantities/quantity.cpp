#include "solvers/quantities/quantity.hpp"

#include <algorithm>

#include "solvers/mechanics/element_table.hpp"

namespace frahm::periodic {
namespace {

using mechanics::Network;

enum class Owner { mass, element, contact, point, mode, support };

struct Row {
  Measure measure;
  Owner owner;
  const char* suffix;
  const char* unit;
  const char* meaning;  // {} stands for the owner's name
  QuantityKind kind = QuantityKind::real;
};

constexpr Row kRows[] = {
    {Measure::amplitude, Owner::mass, "amplitude", "m", "half the range of the displacement of {}"},
    {Measure::peak, Owner::mass, "peak", "m", "largest displacement of {}, either way"},
    {Measure::mean, Owner::mass, "mean", "m", "mean displacement of {}"},
    {Measure::rms, Owner::mass, "rms", "m", "root mean square displacement of {}"},
    {Measure::phase, Owner::mass, "phase", "rad", "phase lag of {} at the reference order"},
    {Measure::peak_phase, Owner::mass, "peak_phase", "rad",
     "omega t at which {} first reaches its largest displacement"},
    {Measure::velocity_peak, Owner::mass, "velocity_peak", "m s-1", "largest velocity of {}, either way"},
    {Measure::acceleration_peak, Owner::mass, "acceleration_peak", "m s-2",
     "largest acceleration of {}, either way"},
    {Measure::harmonic, Owner::mass, "harmonic", "m", "amplitude of {} at the reference order"},
    {Measure::magnification, Owner::mass, "magnification", "1",
     "amplitude of {} at the reference order over its static displacement under the same amplitudes"},
    {Measure::transmissibility, Owner::mass, "transmissibility", "1",
     "amplitude of {} at the reference order over that of the one support that moves"},
    {Measure::stroke, Owner::element, "stroke", "m", "largest relative displacement across {}, either way"},
    {Measure::element_phase, Owner::element, "phase", "rad",
     "phase lag of the relative displacement across {} at the reference order"},
    {Measure::force_peak, Owner::element, "force_peak", "N", "largest force of {}, either way"},
    {Measure::energy, Owner::element, "energy", "J", "energy dissipated by {} in a period"},
    {Measure::energy_share, Owner::element, "energy_share", "1",
     "share of {} in the energy dissipated in a period"},
    {Measure::stops, Owner::contact, "stops", "1", "stops of finite length of {} in a period",
     QuantityKind::count},
    {Measure::reversals, Owner::contact, "reversals", "1", "changes of sliding direction of {} in a period",
     QuantityKind::count},
    {Measure::stuck_fraction, Owner::contact, "stuck_fraction", "1",
     "share of the period for which {} sticks"},
    {Measure::regime, Owner::contact, "regime", "1", "stick-slip regime of {}", QuantityKind::flag},
    {Measure::status, Owner::point, "status", "1", "how the search for the periodic response ended",
     QuantityKind::flag},
    {Measure::floquet_radius, Owner::point, "floquet_radius", "1",
     "largest modulus of the Floquet multipliers of a period"},
    {Measure::energy_input, Owner::point, "energy_input", "J", "work of the excitation in a period"},
    {Measure::energy_balance, Owner::point, "energy_balance", "1",
     "energy put in less energy dissipated, relative"},
    {Measure::transmitted_force, Owner::support, "transmitted_force", "N",
     "largest force that all elements together exert on {}"},
    {Measure::force_transmissibility, Owner::point, "force_transmissibility", "1",
     "amplitude at the reference order of the force on all supports over that of the applied forces"},
    {Measure::residual, Owner::point, "residual", "1",
     "residual of the periodic condition, relative, energy norm"},
    {Measure::error_bound, Owner::point, "error_bound", "m",
     "bound of the error of every displacement at every time"},
    {Measure::newton_iterations, Owner::point, "newton_iterations", "1", "Newton steps of the search",
     QuantityKind::count},
    {Measure::events, Owner::point, "events", "1",
     "stops, releases and reversals of all contacts in a period", QuantityKind::count},
    {Measure::natural_frequency, Owner::mode, "natural_frequency", "rad s-1",
     "undamped natural frequency {} with all friction sliding"},
    {Measure::modal_damping, Owner::mode, "modal_damping", "1",
     "damping ratio of mode {} with all friction sliding"},
};

const Row& row_of(Measure measure) {
  return *std::find_if(std::begin(kRows), std::end(kRows),
                       [&](const Row& row) { return row.measure == measure; });
}

std::string owner_name(Owner owner, std::size_t index, const Network& network) {
  switch (owner) {
    case Owner::mass:
      return network.masses[index];
    case Owner::element:
    case Owner::contact:
      return network.elements[index].name;
    case Owner::mode:
      return std::to_string(index + 1);
    case Owner::support:
      return index == 0 ? "ground" : network.prescribed[index - 1];
    case Owner::point:
      break;
  }
  return "";
}

std::size_t owner_count(Owner owner, const Network& network) {
  switch (owner) {
    case Owner::mass:
    case Owner::mode:
      return network.masses.size();
    case Owner::element:
    case Owner::contact:
      return network.elements.size();
    case Owner::support:
      return 1 + network.prescribed.size();
    case Owner::point:
      break;
  }
  return 1;
}

std::string name_of(const Row& row, std::size_t index, const Network& network) {
  const std::string suffix = row.suffix;
  switch (row.owner) {
    case Owner::point:
      return suffix;
    case Owner::mode:
      return suffix + "_" + std::to_string(index + 1);
    case Owner::support:
      return index == 0 ? suffix : network.prescribed[index - 1] + "_" + suffix;
    case Owner::mass:
    case Owner::element:
    case Owner::contact:
      break;
  }
  return owner_name(row.owner, index, network) + "_" + suffix;
}

}  // namespace

QuantityDescription describe(const Quantity& quantity, const Network& network, bool dimensionless) {
  const Row& row = row_of(quantity.measure);
  QuantityDescription result;
  result.name = name_of(row, quantity.index, network);
  result.unit = dimensionless && std::string(row.unit) != "rad" ? "1" : row.unit;
  result.long_name = row.meaning;
  if (const auto place = result.long_name.find("{}"); place != std::string::npos) {
    result.long_name.replace(place, 2, owner_name(row.owner, quantity.index, network));
  }
  result.kind = row.kind;
  if (quantity.measure == Measure::status) {
    result.flags = {{"not_computed", 0}, {"ok", 1}, {"grazing", 2}, {"unbounded", 3}, {"failed", 4}};
  } else if (quantity.measure == Measure::regime) {
    result.flags = {{"not_computed", 0}, {"no_friction", 1}, {"non_stop", 2},
                    {"one_stop", 3},     {"multi_stop", 4},  {"stuck", 5}};
  }
  return result;
}

std::vector<Quantity> all_quantities(const Network& network) {
  std::vector<Quantity> result;
  for (const Row& row : kRows) {
    for (std::size_t i = 0; i < owner_count(row.owner, network); ++i) {
      if (row.owner == Owner::contact && !mechanics::has_contact(network.elements[i])) continue;
      result.push_back({row.measure, i});
    }
  }
  return result;
}

std::vector<Quantity> standard_quantities(const Network& network) {
  std::vector<Quantity> result;
  for (std::size_t i = 0; i < network.masses.size(); ++i) {
    for (const Measure measure :
         {Measure::peak, Measure::amplitude, Measure::mean, Measure::rms, Measure::phase}) {
      result.push_back({measure, i});
    }
  }
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    if (mechanics::kind_of(network.elements[e]).stroke_is_standard) result.push_back({Measure::stroke, e});
  }
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    if (!mechanics::has_contact(network.elements[e])) continue;
    for (const Measure measure :
         {Measure::stops, Measure::stuck_fraction, Measure::regime, Measure::energy}) {
      result.push_back({measure, e});
    }
  }
  for (const Measure measure : {Measure::status, Measure::floquet_radius, Measure::energy_balance,
                                Measure::residual, Measure::error_bound, Measure::transmitted_force}) {
    result.push_back({measure, 0});
  }
  return result;
}

bool is_differentiable(Measure measure) {
  switch (measure) {
    case Measure::floquet_radius:
    case Measure::energy_balance:
    case Measure::residual:
    case Measure::error_bound:
      return false;
    default:
      return row_of(measure).kind == QuantityKind::real;
  }
}

bool per_period(Measure measure) {
  switch (measure) {
    case Measure::energy:
    case Measure::energy_input:
    case Measure::stops:
    case Measure::reversals:
    case Measure::events:
      return true;
    default:
      return false;
  }
}

std::optional<Quantity> find_quantity(const std::string& name, const Network& network) {
  for (const Quantity& quantity : all_quantities(network)) {
    if (name_of(row_of(quantity.measure), quantity.index, network) == name) return quantity;
  }
  return std::nullopt;
}

}  // namespace frahm::periodic
