#include "solvers/branches/branch_start.hpp"

#include <algorithm>
#include <numbers>
#include <string>
#include <utility>

#include "solvers/exact/orbit_search.hpp"

namespace frahm::periodic {
namespace {

// Searches among the orbits of one multiple of the period. Contacts that stick throughout stay where the
// motion has left them.
void find_of_multiple(BranchMap& map, int multiple, AnyOrbit& orbit) {
  OrbitSearch<kAnySize, kAnySize> search(map.assembly(), map.flow());
  const auto peak_of = [&](const AnyOrbit& each) {
    return each.multiple == multiple ? search.first_peak(each) : -1.0;
  };
  OrbitsWanted wanted;
  wanted.starts = 64;  // a subharmonic often has a small basin
  wanted.most_multiple = std::max(wanted.most_multiple, multiple);
  Coexistence<kAnySize, kAnySize> coexistence(
      map.flow(), [](AnyOrbit&) {}, peak_of, wanted);
  coexistence.find(map.system(), orbit);
  if (!orbit.is_found() || orbit.multiple == multiple) return;
  orbit.status = Status::failed;
  orbit.reason = "no stable orbit of " + std::to_string(multiple) + " periods was found from " +
                 std::to_string(wanted.starts) + " starts";
}

// On to phase 0 of the next period.
void move_to_phase_0(BranchMap& map, AnyOrbit& orbit) {
  if (orbit.section == 0.0) return;
  const double steps = (2.0 * std::numbers::pi - orbit.section) / map.flow().fundamental_rate();
  Walk<kAnySize, kAnySize>(map.flow()).pass(orbit.z, orbit.section, steps, orbit.passage, Tangent::none);
  orbit.z = orbit.passage.end;
  orbit.section = 0.0;
}

}  // namespace

AnyOrbit find_start(BranchMap& map, int multiple) {
  AnyOrbit orbit;
  const mechanics::LinearSystem& system = map.system();
  if (multiple > 0 && !system.monotone) {
    find_of_multiple(map, multiple, orbit);
  } else {
    OrbitSearch<kAnySize, kAnySize> search(map.assembly(), map.flow());
    search.find(system, undamped_modes(system), true, orbit);
    if (orbit.is_found() && multiple > 0 && orbit.multiple != multiple) {
      orbit.status = Status::failed;
      orbit.reason = "the orbit found takes " + std::to_string(orbit.multiple) + " periods";
    }
  }
  if (orbit.is_found()) move_to_phase_0(map, orbit);
  return orbit;
}

std::vector<AnyOrbit> find_stable(BranchMap& map, double parameter, const OrbitsWanted& wanted) {
  std::vector<AnyOrbit> orbits;
  try {
    map.set(parameter);
  } catch (const mechanics::MechanicsError&) {
    return orbits;
  }
  const mechanics::LinearSystem& system = map.system();
  OrbitSearch<kAnySize, kAnySize> search(map.assembly(), map.flow(), wanted);
  AnyOrbit told;
  search.find(system, undamped_modes(system), true, told);
  if (system.monotone) {
    if (told.is_found()) orbits.push_back(std::move(told));
  } else {
    for (const auto& found : search.stable()) orbits.push_back(found.orbit);
  }
  map.set(parameter);  // the search may leave the flow at a multiple of the period
  for (AnyOrbit& orbit : orbits) move_to_phase_0(map, orbit);
  return orbits;
}

}  // namespace frahm::periodic
