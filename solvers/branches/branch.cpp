#include "solvers/branches/branch.hpp"

#include <algorithm>
#include <utility>

#include "solvers/branches/branch_start.hpp"
#include "solvers/branches/branch_walk.hpp"
#include "solvers/quantities/observables.hpp"

namespace frahm::periodic {
namespace {

// The points of places: their orbits once more, with the quantities asked for.
class BranchTelling {
 public:
  BranchTelling(BranchMap& map, const std::vector<Quantity>& quantities)
      : map_(map), observables_(map.assembly(), map.flow(), quantities), count_(quantities.size()) {}

  BranchPoint tell(const BranchPlace& place) {
    Shot shot = map_.shoot(place.y);
    BranchPoint point{.parameter = map_.parameter(place.y), .quantities = std::vector<double>(count_)};
    if (shot.failed) {
      observables_.fill_missing(Status::failed, point.quantities);
      return point;
    }
    const AnyOrbit orbit = map_.orbit(place.y, std::move(shot));
    observables_.forget();
    observables_.set_system(map_.system());
    observables_.evaluate(orbit, map_.system(), point.quantities);
    point.floquet_radius = orbit.floquet_radius;
    point.stable = orbit.is_stable();
    point.multiple = orbit.multiple;
    point.residual = orbit.residual;
    return point;
  }

 private:
  BranchMap& map_;
  Observables<kAnySize, kAnySize> observables_;
  std::size_t count_;
};

// One way of a branch, from the first point on.
struct OneWay {
  std::vector<BranchPoint> points;
  std::vector<SpecialPoint> special;
  BranchEnd end{};
};

OneWay follow_way(BranchMap& map, BranchTelling& telling, const BranchWanted& wanted,
                  const BranchPlace& first, const BranchProgress& progress) {
  OneWay way;
  const FoundOnBranch found = [&](const BranchPlace& place, const std::vector<SpecialPlace>& special) {
    for (const SpecialPlace& each : special)
      way.special.push_back(
          {each.kind, telling.tell(each.place), way.points.size(), each.element, each.residual});
    way.points.push_back(telling.tell(place));
    if (progress) progress(way.points.back());
  };
  way.end = walk_branch(map, wanted, first, found);
  return way;
}

// Both ways in one, the parameter rising at the first point.
Branch joined(OneWay&& back, const BranchPoint& first, OneWay&& on) {
  Branch branch;
  branch.first_end = back.end;
  branch.last_end = on.end;
  const std::size_t before = back.points.size();
  std::ranges::reverse(back.points);
  std::ranges::reverse(back.special);
  branch.points = std::move(back.points);
  branch.points.push_back(first);
  branch.points.insert(branch.points.end(), on.points.begin(), on.points.end());
  for (SpecialPoint& special : back.special) {
    special.after = before - special.after - 1;
    branch.special.push_back(std::move(special));
  }
  for (SpecialPoint& special : on.special) {
    special.after += before;
    branch.special.push_back(std::move(special));
  }
  return branch;
}

}  // namespace

const char* kind_name(SpecialKind kind) {
  switch (kind) {
    case SpecialKind::fold:
      return "fold";
    case SpecialKind::branching:
      return "branching";
    case SpecialKind::period_doubling:
      return "period_doubling";
    case SpecialKind::torus:
      return "torus";
    case SpecialKind::stability_jump:
      return "stability_jump";
    case SpecialKind::grazing:
      return "grazing";
    case SpecialKind::corner:
      return "corner";
  }
  return "";
}

const char* end_sentence(BranchEnd end) {
  switch (end) {
    case BranchEnd::range:
      return "the range of the parameter ends";
    case BranchEnd::points:
      return "as many points as were asked for";
    case BranchEnd::closed:
      return "the branch is closed";
    case BranchEnd::lost:
      return "no orbit beside it continues it: an event begins abruptly, or a value breaks a rule";
  }
  return "";
}

Branch follow_branch(const mechanics::Network& network, const std::vector<Quantity>& quantities,
                     const ValuesAlong& values, const BranchWanted& wanted, const BranchProgress& progress) {
  BranchMap map(network, values, wanted.low, wanted.high);
  map.set(wanted.start);
  const AnyOrbit orbit = find_start(map, wanted.multiple);
  Branch none;
  none.reason = orbit.reason;
  if (!orbit.is_found()) return none;

  Eigen::VectorXd y = map.begin(orbit);
  const Eigen::VectorXd along = Eigen::VectorXd::Unit(y.size(), y.size() - 1);
  y[y.size() - 1] = (wanted.start - wanted.low) / (wanted.high - wanted.low);
  auto first = correct(map, y, along, along);
  if (!first) {
    none.reason = "the orbit at the start could not be refined";
    return none;
  }
  BranchTelling telling(map, quantities);
  const BranchPoint point = telling.tell(*first);
  if (progress) progress(point);
  OneWay on = follow_way(map, telling, wanted, *first, progress);
  OneWay back;
  if (on.end != BranchEnd::closed) {
    first->tangent *= -1.0;
    back = follow_way(map, telling, wanted, *first, progress);
  } else {
    back.end = BranchEnd::closed;
  }
  return joined(std::move(back), point, std::move(on));
}

}  // namespace frahm::periodic
