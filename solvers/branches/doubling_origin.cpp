#include "solvers/branches/doubling_origin.hpp"

#include <cmath>

#include "solvers/branches/part_of_branch.hpp"

namespace frahm::periodic {
namespace {

// Where the orbits of half the period change their stability near an orbit that is nearly one of them, as a
// place of theirs: a multiplier is -1, or jumps where an event begins.
std::optional<SpecialPlace> doubling_near(BranchMap& shorter, const Eigen::VectorXd& near) {
  constexpr double kReaches[] = {1e-6, 1e-5, 1e-4, 1e-3};  // of the parameter's range
  const Eigen::VectorXd along = Eigen::VectorXd::Unit(near.size(), near.size() - 1);
  for (const double reach : kReaches) {
    const auto below = correct(shorter, near - reach * along, along, along);
    const auto above = correct(shorter, near + reach * along, along, along);
    if (!below || !above) return std::nullopt;
    if (below->unstable() == above->unstable()) continue;
    for (const SpecialPlace& each : special_places(shorter, *below, *above))
      if (each.kind == SpecialKind::period_doubling || each.kind == SpecialKind::stability_jump) return each;
    return std::nullopt;
  }
  return std::nullopt;
}

// The state of a place of one map, at phase 0, in the units of another's flow.
AnyOrbit orbit_of(const BranchMap& from, const Eigen::VectorXd& y, const BranchMap& to, int multiple) {
  const auto& eq = to.flow().equations();
  AnyOrbit orbit;
  orbit.z = from.state(y);
  orbit.z.segment(eq.masses(), eq.masses()) *= eq.step / from.flow().equations().step;
  orbit.multiple = multiple;
  return orbit;
}

// The place of `near`, solved as one of the shorter orbits; its section is that of the map.
std::optional<SpecialPlace> solved_as_shorter(BranchMap& map, const BranchPlace& near) {
  const double section = map.section();
  const Eigen::VectorXd at_phase_0 = map.moved(near.y, 0.0);
  if (at_phase_0.size() == 0) return std::nullopt;
  BranchMap shorter = map.another();
  shorter.set(map.parameter(near.y));
  const Eigen::VectorXd start = shorter.begin(orbit_of(map, at_phase_0, shorter, map.multiple() / 2));
  auto special = doubling_near(shorter, start);
  if (!special) return std::nullopt;
  const double parameter = shorter.parameter(special->place.y);
  shorter.set(parameter);
  map.set(parameter);
  map.set_section(0.0);
  special->place.y = map.place_of(orbit_of(shorter, special->place.y, map, map.multiple()));
  special->place.y = map.moved(special->place.y, section);
  map.set_section(section);
  if (special->place.y.size() == 0) return std::nullopt;
  return special;
}

}  // namespace

std::optional<SpecialPlace> origin_of_doubling(BranchMap& map, const BranchPlace& from,
                                               const BranchPlace& to) {
  if (map.multiple() % 2 != 0) return std::nullopt;
  const Eigen::VectorXd gap = map.gap_after(2, from.y), gap_beyond = map.gap_after(2, to.y);
  if (gap.size() == 0 || gap_beyond.size() == 0 || gap.dot(gap_beyond) >= 0.0) return std::nullopt;
  const Eigen::VectorXd direction = gap.normalized();
  const auto gap_along = [&](const BranchPlace& place) {
    const Eigen::VectorXd there = map.gap_after(2, place.y);
    return there.size() == 0 ? 0.0 : direction.dot(there);
  };
  const BranchRoot found = root(PartOfBranch(map, from, to), gap_along);
  if (const auto solved = solved_as_shorter(map, found.place)) return solved;
  return SpecialPlace{SpecialKind::period_doubling, found.place, std::nullopt, std::abs(found.value)};
}

}  // namespace frahm::periodic
