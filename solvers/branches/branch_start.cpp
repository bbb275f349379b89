#include "solvers/branches/branch_start.hpp"

#include <algorithm>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "solvers/exact/coexistence.hpp"
#include "solvers/exact/orbit_search.hpp"

namespace frahm::periodic {
namespace {

// The largest of those stable orbits that take this multiple of the period; of any, if it is 0.
void find_among_several(BranchMap& map, int multiple, AnyOrbit& orbit) {
  OrbitsWanted wanted;
  if (multiple > 0) wanted.starts = 64;  // a subharmonic often has a small basin
  wanted.most_multiple = std::max(wanted.most_multiple, multiple);
  Coexistence<kAnySize, kAnySize> coexistence(map.assembly(), map.flow(), wanted);
  StableOrbits<kAnySize, kAnySize> found = coexistence.find(map.system(), nullptr);
  if (multiple > 0)
    std::erase_if(found.stable, [&](const auto& each) { return each.multiple() != multiple; });
  coexistence.tell(map.system(), found, orbit);
  if (orbit.is_found() || multiple == 0) return;
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
  const LimitedSearch limit(map.flow().work());
  using Search = OrbitSearch<kAnySize, kAnySize>;
  AnyOrbit orbit;
  const mechanics::LinearSystem& system = map.system();
  const std::vector<UndampedMode> undamped = undamped_modes(system);
  if (!Search::serves(map.assembly(), system, undamped)) {
    find_among_several(map, multiple, orbit);
  } else {
    Search(map.assembly(), map.flow()).find(system, undamped, true, orbit);
    if (orbit.is_found() && multiple > 1) {
      orbit.status = Status::failed;
      orbit.reason = "the orbit found takes one period";
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
  const LimitedSearch limit(map.flow().work());
  using Search = OrbitSearch<kAnySize, kAnySize>;
  const mechanics::LinearSystem& system = map.system();
  const std::vector<UndampedMode> undamped = undamped_modes(system);
  AnyOrbit orbit;
  if (Search::serves(map.assembly(), system, undamped)) {
    Search(map.assembly(), map.flow()).find(system, undamped, true, orbit);
    if (orbit.is_found()) orbits.push_back(std::move(orbit));
  } else {
    Coexistence<kAnySize, kAnySize> coexistence(map.assembly(), map.flow(), wanted);
    const StableOrbits<kAnySize, kAnySize> found = coexistence.find(system, nullptr);
    for (std::size_t i = 0; i < found.stable.size(); ++i) {
      map.flow().set_forcing(system);
      coexistence.tell(system, found, i, orbit);
      if (orbit.is_found()) orbits.push_back(orbit);
    }
  }
  map.set(parameter);  // the search may leave the flow at a multiple of the period
  for (AnyOrbit& each : orbits) move_to_phase_0(map, each);
  return orbits;
}

}  // namespace frahm::periodic
