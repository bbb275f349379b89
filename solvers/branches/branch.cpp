#include "solvers/branches/branch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solvers/branches/branch_start.hpp"
#include "solvers/branches/special_points.hpp"
#include "solvers/quantities/observables.hpp"

namespace frahm::periodic {
namespace {

constexpr const char* kLeftRange = "the range of the parameter ends";
constexpr const char* kTooManyPoints = "so many points were asked for";
constexpr const char* kLost = "no orbit continues it: events change abruptly, or a value breaks a rule";
constexpr const char* kClosed = "it is closed";

struct StepLimits {
  double first = 1e-3;       // all of the scaled arclength
  double least = 1e-9;       // below, the branch is lost
  double kink = 1e-6;        // below, the tangent may turn by any angle: the map has a kink at a grazing
  double most_angle = 0.15;  // between the tangents of neighbours [rad], that a curve is drawn smoothly
  double most_shift = 0.3;   // of a step: how far Newton's method may move its end
};

// Follows a branch one way.
class BranchWalk {
 public:
  using Found = std::function<void(const BranchPlace&, const std::vector<SpecialPlace>&)>;

  BranchWalk(BranchMap& map, const BranchWanted& wanted, const Found& found)
      : map_(map), wanted_(wanted), found_(found) {}

  // Calls `found` with each place after the first and the special places before it. Returns why it ends.
  const char* follow(const BranchPlace& first) {
    here_ = first;
    step_ = limits_.first;
    if (leaves_range(here_.y, here_.tangent)) return kLeftRange;
    for (int points = 1; points < wanted_.most_points;) {
      const auto next = take_step();
      if (!next) {
        step_ *= 0.5;
        if (step_ < limits_.least) return kLost;
        continue;
      }
      const double p = next->y[next->y.size() - 1];
      if (p < 0.0 || p > 1.0) return end_at(p < 0.0 ? 0.0 : 1.0, *next);
      ++points;
      const bool closes = points > kLeastLoop && passes(first, *next);
      if (closes) return accept(first), kClosed;
      accept(*next);
    }
    return kTooManyPoints;
  }

 private:
  static constexpr int kLeastLoop = 10;

  static bool leaves_range(const Eigen::VectorXd& y, const Eigen::VectorXd& tangent) {
    const double p = y[y.size() - 1], rate = tangent[y.size() - 1];
    return (p <= 0.0 && rate <= 0.0) || (p >= 1.0 && rate >= 0.0);
  }

  // Predicts along the tangent and corrects across it. Nothing where the step is too long.
  std::optional<BranchPlace> take_step() const {
    const Eigen::VectorXd predicted = here_.y + step_ * here_.tangent;
    auto next = correct(map_, predicted, here_.tangent, here_.tangent);
    if (!next) return std::nullopt;
    const double shift = (next->y - predicted).norm() / step_;
    const double angle = std::acos(std::clamp(here_.tangent.dot(next->tangent), -1.0, 1.0));
    const bool serves = angle <= limits_.most_angle && shift <= limits_.most_shift;
    return serves || (step_ <= limits_.kink && shift <= 2.0) ? next : std::nullopt;
  }

  // The step that led to the first place again, or past it.
  bool passes(const BranchPlace& first, const BranchPlace& next) const {
    const Eigen::VectorXd to_first = first.y - here_.y;
    const double along = here_.tangent.dot(to_first);
    return along > 0.0 && along <= here_.tangent.dot(next.y - here_.y) && to_first.norm() < 2.0 * step_ &&
           (to_first - along * here_.tangent).norm() < 0.5 * step_ && here_.tangent.dot(first.tangent) > 0.9;
  }

  void accept(const BranchPlace& next) {
    constexpr double kGrow = 1.5;
    constexpr int kFast = 4;  // Newton's steps
    const double angle = std::acos(std::clamp(here_.tangent.dot(next.tangent), -1.0, 1.0));
    found_(next, special_places(map_, here_, next));
    if (next.newton_iterations <= kFast && angle < 0.5 * limits_.most_angle)
      step_ = std::min(kGrow * step_, wanted_.largest_step);
    here_ = next;
  }

  // The place at the end of the range, before one beyond it.
  const char* end_at(double end, const BranchPlace& beyond) {
    const Eigen::Index last = beyond.y.size() - 1;
    const double part = (end - here_.y[last]) / (beyond.y[last] - here_.y[last]);
    const Eigen::VectorXd across = Eigen::VectorXd::Unit(last + 1, last);
    const Eigen::VectorXd guess = here_.y + part * (beyond.y - here_.y);
    if (const auto place = correct(map_, guess, across, here_.tangent); place && part > 0.0) accept(*place);
    return kLeftRange;
  }

  BranchMap& map_;
  const BranchWanted& wanted_;
  const Found& found_;
  StepLimits limits_;
  BranchPlace here_;
  double step_ = 0.0;
};

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
struct Way {
  std::vector<BranchPoint> points;
  std::vector<SpecialPoint> special;
  const char* end = "";
};

Way follow_way(BranchMap& map, BranchTelling& telling, const BranchWanted& wanted, const BranchPlace& first,
               const BranchProgress& progress) {
  Way way;
  const BranchWalk::Found found = [&](const BranchPlace& place, const std::vector<SpecialPlace>& special) {
    for (const SpecialPlace& each : special)
      way.special.push_back(
          {each.kind, telling.tell(each.place), way.points.size(), each.element, each.residual});
    way.points.push_back(telling.tell(place));
    if (progress) progress(way.points.back());
  };
  way.end = BranchWalk(map, wanted, found).follow(first);
  return way;
}

// Both ways in one, the parameter rising at the first point.
Branch joined(Way&& back, const BranchPoint& first, Way&& on) {
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
  branch.closed = branch.last_end == kClosed;
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
  Way on = follow_way(map, telling, wanted, *first, progress);
  Way back;
  if (on.end != kClosed) {
    first->tangent *= -1.0;
    back = follow_way(map, telling, wanted, *first, progress);
  } else {
    back.end = kClosed;
  }
  return joined(std::move(back), point, std::move(on));
}

}  // namespace frahm::periodic
