#include "solvers/branches/branch_start.hpp"

#include <algorithm>
#include <numbers>
#include <string>
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

}  // namespace

AnyOrbit find_start(BranchMap& map, int multiple) {
  using Search = OrbitSearch<kAnySize, kAnySize>;
  AnyOrbit orbit;
  const mechanics::LinearSystem& system = map.system();
  const std::vector<UndampedMode> undamped = undamped_modes(system);
  if (!Search::serves(system, undamped)) {
    find_among_several(map, multiple, orbit);
  } else {
    Search(map.assembly(), map.flow()).find(system, undamped, true, orbit);
    if (orbit.is_found() && multiple > 1) {
      orbit.status = Status::failed;
      orbit.reason = "the orbit found takes one period";
    }
  }
  if (!orbit.is_found() || orbit.section == 0.0) return orbit;
  // On to phase 0 of the next period.
  const double steps = (2.0 * std::numbers::pi - orbit.section) / map.flow().fundamental_rate();
  Walk<kAnySize, kAnySize>(map.flow()).pass(orbit.z, orbit.section, steps, orbit.passage, Tangent::none);
  orbit.z = orbit.passage.end;
  orbit.section = 0.0;
  return orbit;
}

}  // namespace frahm::periodic
