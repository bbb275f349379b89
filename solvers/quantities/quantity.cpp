#include "solvers/quantities/quantity.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string_view>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/bends.hpp"
#include "solvers/mechanics/coordinates.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/free_directions.hpp"
#include "solvers/mechanics/rotation.hpp"
#include "solvers/mechanics/structural_damping.hpp"
#include "solvers/quantities/quantity_table.hpp"

namespace frahm::periodic {
namespace {

using mechanics::Network;

bool has_slider(const mechanics::Element& element) {
  return element.type == mechanics::ElementType::jenkins;
}

std::string owner_name(Owner owner, std::size_t index, const Network& network) {
  switch (owner) {
    case Owner::mass:
      return mechanics::coordinate_name(network, index);
    case Owner::element:
    case Owner::contact:
    case Owner::sliders:
      return network.elements[index].name;
    case Owner::mode:
      return std::to_string(index + 1);
    case Owner::support:
      return index == 0 ? "ground" : network.prescribed[index - 1];
    case Owner::point:
    case Owner::structure:
    case Owner::coexistence:
    case Owner::offsets:
      break;
  }
  return "";
}

std::size_t owner_count(Owner owner, const Network& network) {
  switch (owner) {
    case Owner::mass:
      return mechanics::coordinate_count(network);
    case Owner::mode:
      return network.masses.size();
    case Owner::element:
    case Owner::contact:
    case Owner::sliders:
      return network.elements.size();
    case Owner::support:
      return 1 + network.prescribed.size();
    case Owner::structure:
      return mechanics::has_structural_damping(network) ? 1 : 0;
    case Owner::coexistence:
      return mechanics::may_have_several_responses(network) ? 1 : 0;
    case Owner::offsets:
      return std::ranges::any_of(network.elements, has_slider) ? 1 : 0;
    case Owner::point:
      break;
  }
  return 1;
}

std::string joined(std::string first, const std::string& second) {
  first += '_';
  first += second;
  return first;
}

std::string name_of(const QuantityRow& row, std::size_t index, const Network& network) {
  switch (row.owner) {
    case Owner::point:
    case Owner::structure:
    case Owner::coexistence:
    case Owner::offsets:
      return row.suffix;
    case Owner::mode:
      return joined(row.suffix, std::to_string(index + 1));
    case Owner::support:
      return index == 0 ? row.suffix : joined(network.prescribed[index - 1], row.suffix);
    case Owner::mass:
    case Owner::element:
    case Owner::contact:
    case Owner::sliders:
      break;
  }
  return joined(owner_name(row.owner, index, network), row.suffix);
}

std::string unit_of(const QuantityRow& row, std::size_t index, const Network& network) {
  const bool all_rotate = std::ranges::all_of(network.rotation, std::identity{}) && !network.rotation.empty();
  switch (row.owner) {
    case Owner::mass:
      if (row.measure == Measure::transmissibility && mechanics::coordinate_rotates(network, index))
        return "rad m-1";
      return std::string(mechanics::coordinate_unit(network, index, row.unit));
    case Owner::element:
    case Owner::contact:
    case Owner::sliders:
      return std::string(mechanics::unit_of_element(network.elements[index], row.unit));
    case Owner::support:
      return std::string(index == 0 && mechanics::ground_takes_torque(network)
                             ? mechanics::unit_of_rotation(row.unit)
                             : row.unit);
    case Owner::point:
      return std::string(all_rotate ? mechanics::unit_of_rotation(row.unit) : row.unit);
    case Owner::mode:
    case Owner::structure:
    case Owner::coexistence:
    case Owner::offsets:
      break;
  }
  return row.unit;
}

// Whether an element has the quantities of such an owner. The parts of another have none.
bool is_owner(Owner owner, const mechanics::Element& element) {
  switch (owner) {
    case Owner::element:
      return element.parts > 0;
    case Owner::contact:
      return mechanics::has_own_contact(element);
    case Owner::sliders:
      return element.parts > 1;
    default:
      return false;
  }
}

bool is_owned_by_elements(Owner owner) {
  return owner == Owner::element || owner == Owner::contact || owner == Owner::sliders;
}

// The indices of the owners that have a quantity in the standard record.
std::vector<std::size_t> owners(StandardOf of, const Network& network) {
  std::vector<std::size_t> result;
  const std::size_t count = of == StandardOf::coexistence ? owner_count(Owner::coexistence, network)
                            : of == StandardOf::offsets   ? owner_count(Owner::offsets, network)
                            : of == StandardOf::point     ? 1
                            : of == StandardOf::masses    ? mechanics::coordinate_count(network)
                                                          : network.elements.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (of == StandardOf::springs && !mechanics::kind_of(network.elements[i]).stroke_is_standard) continue;
    if (of == StandardOf::contacts && !mechanics::has_contact(network.elements[i])) continue;
    result.push_back(i);
  }
  return result;
}

// The row of a quantity by the end of its name; of several matches the longest, as in main_velocity_peak.
const QuantityRow* row_named(const std::string& name) {
  const QuantityRow* best = nullptr;
  for (const QuantityRow& row : quantity_table()) {
    const std::string_view suffix = row.suffix;
    const bool stands_alone = row.owner == Owner::point || row.owner == Owner::structure ||
                              row.owner == Owner::coexistence || row.owner == Owner::offsets;
    const bool is_own = stands_alone && name == suffix;
    const bool is_owned = !stands_alone && name.ends_with(joined("", row.suffix));
    if (!is_own && !is_owned) continue;
    if (best == nullptr || suffix.size() > std::string_view(best->suffix).size()) best = &row;
  }
  return best;
}

// For an element's displacement, which has no end on a belt.
bool is_of_displacement(const QuantityRow& row) {
  return row.measure == Measure::stroke || row.measure == Measure::element_phase;
}

// For a displacement, of which free masses that drift have a part that repeats.
bool is_beside_drift(const QuantityRow& row) {
  return row.owner == Owner::mass && row.trace == TraceKind::displacement && !row.of_free_masses;
}

}  // namespace

QuantityDescription describe(const Quantity& quantity, const Network& network, bool dimensionless) {
  const QuantityRow& row = row_of(quantity.measure);
  QuantityDescription result;
  result.name = name_of(row, quantity.index, network);
  result.unit = dimensionless && !is_angle(quantity.measure) ? "1" : unit_of(row, quantity.index, network);
  result.long_name = row.meaning;
  if (const auto braces = result.long_name.find("{}"); braces != std::string::npos) {
    result.long_name.replace(braces, 2, owner_name(row.owner, quantity.index, network));
  }
  result.kind = row.kind;
  if (is_beside_drift(row) && mechanics::may_have_free_masses(network))
    result.long_name += ", beside its drift";
  for (const FlagMeaning& flag : row.flags) result.flags.emplace_back(flag.meaning, flag.value);
  return result;
}

std::vector<Quantity> all_quantities(const Network& network) {
  std::vector<Quantity> result;
  const bool has_free = mechanics::may_have_free_masses(network);
  for (const QuantityRow& row : quantity_table()) {
    if (row.of_free_masses && !has_free) continue;
    for (std::size_t i = 0; i < owner_count(row.owner, network); ++i) {
      if (is_owned_by_elements(row.owner) && !is_owner(row.owner, network.elements[i])) continue;
      if (is_of_displacement(row) && mechanics::is_on_belt(network, network.elements[i].along)) continue;
      result.push_back({row.measure, i});
    }
  }
  return result;
}

std::vector<Quantity> with_always_stored(std::vector<Quantity> listed, const Network& network) {
  for (const Quantity& each : all_quantities(network))
    if (row_of(each.measure).stored_always && std::ranges::find(listed, each) == listed.end())
      listed.push_back(each);
  return listed;
}

std::vector<Quantity> standard_quantities(const Network& network) {
  std::vector<Quantity> result;
  const bool has_free = mechanics::may_have_free_masses(network);
  for (const StandardOf of : {StandardOf::masses, StandardOf::springs, StandardOf::contacts,
                              StandardOf::point, StandardOf::coexistence, StandardOf::offsets}) {
    std::vector<const QuantityRow*> rows;
    for (const QuantityRow& row : quantity_table()) {
      if (row.standard.of == of && (has_free || !row.of_free_masses)) rows.push_back(&row);
    }
    std::ranges::sort(rows, {}, [](const QuantityRow* row) { return row->standard.rank; });
    for (const std::size_t owner : owners(of, network)) {
      for (const QuantityRow* row : rows) {
        if (is_owned_by_elements(row->owner) && !is_owner(row->owner, network.elements[owner])) continue;
        result.push_back({row->measure, owner});
      }
    }
  }
  return result;
}

bool is_shown(const Quantity& quantity, const Network& network) {
  switch (row_of(quantity.measure).shown) {
    case Shown::no:
      return false;
    case Shown::of_all:
      return true;
    case Shown::of_springs:
      return mechanics::kind_of(network.elements[quantity.index]).stroke_is_standard;
    case Shown::of_dissipating:
      return mechanics::kind_of(network.elements[quantity.index]).dissipates;
  }
  return false;
}

bool is_shown(const std::string& name) {
  const QuantityRow* row = row_named(name);
  return row != nullptr && row->shown != Shown::no;
}

std::optional<Quantity> find_quantity(const std::string& name, const Network& network) {
  for (const Quantity& quantity : all_quantities(network)) {
    if (name_of(row_of(quantity.measure), quantity.index, network) == name) return quantity;
  }
  return std::nullopt;
}

double missing_value(QuantityKind kind) {
  switch (kind) {
    case QuantityKind::real:
      break;
    case QuantityKind::count:
      return -1.0;
    case QuantityKind::flag:
      return 0.0;
  }
  return kNone;
}

bool is_missing(QuantityKind kind, double value) {
  return kind == QuantityKind::real ? std::isnan(value) : value == missing_value(kind);
}

double missing_value(Measure measure, Status status) {
  return measure == Measure::status ? static_cast<double>(status) : missing_value(row_of(measure).kind);
}

const char* why_not_differentiated(Measure measure) {
  return row_of(measure).why_not_differentiated;
}

bool is_angle(Measure measure) {
  return std::string_view(row_of(measure).unit) == "rad";
}

bool has_sides(Measure measure) {
  return row_of(measure).of_trace == OfTrace::side;
}

bool is_of_a_period(Measure measure) {
  return row_of(measure).of_a_period;
}

}  // namespace frahm::periodic
