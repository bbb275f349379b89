#include "solvers/branches/followed_branch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "solvers/branches/branch_walk.hpp"

namespace frahm::periodic {
namespace {

// Both ways in one, the parameter rising at the first point.
void join(Branch& branch, std::vector<BranchPoint>&& back, std::vector<SpecialPoint>&& special_back,
          const BranchPoint& first, std::vector<BranchPoint>&& on, std::vector<SpecialPoint>&& special_on) {
  const std::size_t before = back.size();
  std::ranges::reverse(back);
  std::ranges::reverse(special_back);
  branch.points = std::move(back);
  branch.points.push_back(first);
  std::ranges::move(on, std::back_inserter(branch.points));
  for (SpecialPoint& special : special_back) {
    special.next = before - special.next;
    branch.special.push_back(std::move(special));
  }
  for (SpecialPoint& special : special_on) {
    special.next += before + 1;
    branch.special.push_back(std::move(special));
  }
  double start = branch.points.front().arclength;
  if (!branch.special.empty()) start = std::min(start, branch.special.front().at.arclength);
  for (BranchPoint& each : branch.points) each.arclength -= start;
  for (SpecialPoint& each : branch.special) each.at.arclength -= start;
}

}  // namespace

FollowedBranch::FollowedBranch(const mechanics::Network& network, const std::vector<Quantity>& quantities,
                               const ValuesAlong& values, const BranchWanted& wanted)
    : wanted_(wanted),
      map_(network, values, wanted.low, wanted.high),
      observables_(map_.assembly(), map_.flow(), quantities),
      quantities_(quantities.size()) {}

// The orbit of a place once more, with the quantities asked for.
BranchPoint FollowedBranch::tell(const Eigen::VectorXd& y) {
  Shot shot = map_.pass(y, Tangent::followed);
  BranchPoint point{.parameter = map_.parameter(y), .quantities = std::vector<double>(quantities_)};
  if (shot.failed) {
    observables_.fill_missing(Status::failed, 0, point.quantities);
    return point;
  }
  const AnyOrbit orbit = map_.orbit(y, std::move(shot));
  observables_.forget();
  observables_.set_system(map_.system());
  if (!observables_.is_balanced(orbit, map_.system())) {
    observables_.fill_missing(Status::failed, 0, point.quantities);
    return point;
  }
  observables_.evaluate(orbit, map_.system(), point.quantities);
  point.is_balanced = true;
  point.floquet_radius = orbit.floquet_radius;
  point.stable = orbit.is_stable() || map_.system().monotone;  // then motions never part
  point.multiple = orbit.multiple;
  point.residual = orbit.residual;
  const bool rests_at_limit = std::isnan(orbit.floquet_radius) && orbit.stuck_throughout != 0;
  if (!point.stable && rests_at_limit) point.stable = is_stable_in_the_middle(y);
  return point;
}

// What is beyond the end of the interval in which something rests says nothing of the motions that rest
// inside.
bool FollowedBranch::is_stable_in_the_middle(const Eigen::VectorXd& y) {
  const Eigen::VectorXd middle = map_.at_rest_in_the_middle(y);
  if (middle.size() == 0) return false;
  Shot shot = map_.pass(middle, Tangent::followed);
  return !shot.failed && map_.orbit(middle, std::move(shot)).is_stable();
}

// Whether the place that a step has led to is known, or lies on a step of this branch that is not next to it.
bool FollowedBranch::is_known_after(const Step& step, const IsKnown& is_known) {
  const double section = map_.section();
  const Eigen::VectorXd at_phase_0 = map_.moved(step.to, 0.0);
  if (at_phase_0.size() == 0) return false;
  AnyOrbit orbit;
  orbit.z = map_.state(at_phase_0);
  orbit.multiple = map_.multiple();
  const double parameter = map_.parameter(step.to);
  const bool is_elsewhere = is_known && is_known(parameter, orbit);
  const auto is_apart = [&step](const Step& other) {
    constexpr double kApart = 1e-3;  // of the arclength
    const double reach = (step.to - step.from).norm() + (other.to - other.from).norm();
    return std::abs(step.arclength - other.arclength) > std::max(kApart, 2.0 * reach);
  };
  const bool is_known_here = is_elsewhere || passes(parameter, orbit, is_apart);
  map_.set_section(section);
  return is_known_here;
}

// Where an event only just happens there are no multipliers: the orbits of the branch next to it judge.
static void judge_at_kink(BranchPoint& point, bool neighbours_are_stable) {
  if (point.is_balanced && std::isnan(point.floquet_radius))
    point.stable = point.stable || neighbours_are_stable;
}

FollowedBranch::OneWay FollowedBranch::follow_way(const BranchPlace& first, bool stable, double sign,
                                                  const IsKnown& is_known, const BranchProgress& progress) {
  constexpr int kJoined = 2;      // points in turn: one alone is where two branches cross
  constexpr double kLarge = 1e4;  // of the size at the start
  OneWay way;
  double arclength = 0.0;
  int known = 0;
  bool grows = false;
  const FoundOnBranch found = [&](const BranchStep& step) {
    std::optional<BranchPoint> point;
    if (step.to != nullptr) point = tell(step.to->y);
    // A response this large whose energies are rounding grows without bound: its residual no longer shows.
    grows = point && !point->is_balanced && step.to->y.norm() > kLarge;
    if (grows) return false;
    if (point) judge_at_kink(*point, stable);
    for (const SpecialPlace& each : step.special) {
      BranchPoint at = tell(each.place.y);
      judge_at_kink(at, stable && (!point || point->stable));
      const bool is_last_point = each.place.y == step.from.y && !way.points.empty();
      if (is_last_point) way.points.pop_back();  // one row for the place
      at.arclength = sign * (arclength + (each.place.y - step.from.y).norm());
      way.special.push_back({each.kind, std::move(at), way.points.size(), each.element, each.residual});
    }
    if (!point) return true;
    arclength += (step.to->y - step.from.y).norm();
    way.points.push_back(std::move(*point));
    way.points.back().arclength = sign * arclength;
    const bool now = way.points.back().stable;
    steps_.push_back({step.from.y, step.to->y, map_.section(), way.points.back().arclength,
                      std::exchange(stable, now), now});
    if (progress) progress(way.points.back());
    known = is_known_after(steps_.back(), is_known) ? known + 1 : 0;
    return known < kJoined;
  };
  way.end = walk_branch(map_, wanted_, first, found);
  if (way.end == BranchEnd::joined && !grows) steps_.resize(steps_.size() - kJoined);  // counted before
  if (grows) way.end = BranchEnd::unbounded;
  return way;
}

// The place of the orbit at the start: at another section where sliders slip at this one, and in the middle
// of its interval where what rests is at its end.
std::optional<BranchPlace> FollowedBranch::first_place(const Eigen::VectorXd& y) {
  const Eigen::VectorXd along = Eigen::VectorXd::Unit(y.size(), y.size() - 1);
  const auto place_at = [&](const Eigen::VectorXd& start) {
    return start.size() == 0 ? std::nullopt : correct(map_, start, along, along);
  };
  if (auto first = place_at(y)) return first;
  if (const auto section = map_.section_of_least_slip(y)) {
    const Eigen::VectorXd there = map_.moved(y, *section);
    map_.set_section(*section);
    if (auto first = place_at(there)) return first;
    map_.set_section(0.0);
  }
  return place_at(map_.at_rest_in_the_middle(y));
}

void FollowedBranch::follow(const AnyOrbit& orbit, const IsKnown& is_known, const BranchProgress& progress) {
  auto first = first_place(map_.begin(orbit));
  if (!first) {
    branch_.reason = "the orbit at the start could not be refined";
    return;
  }
  const BranchPoint point = tell(first->y);
  if (progress) progress(point);
  OneWay on = follow_way(*first, point.stable, 1.0, is_known, progress), back;
  if (on.end != BranchEnd::closed) {
    first->tangent *= -1.0;
    back = follow_way(*first, point.stable, -1.0, is_known, progress);
  } else {
    back.end = BranchEnd::closed;
  }
  branch_.first_end = back.end;
  branch_.last_end = on.end;
  join(branch_, std::move(back.points), std::move(back.special), point, std::move(on.points),
       std::move(on.special));
}

std::optional<int> FollowedBranch::stable_at(double parameter) const {
  const double at = (parameter - wanted_.low) / (wanted_.high - wanted_.low);
  // A place that two steps share counts once, those at both ends of the range too.
  const auto is_beyond = [at](double place) { return at < 0.5 ? place > at : place >= at; };
  int count = 0;
  for (const Step& step : steps_) {
    const Eigen::Index last = step.from.size() - 1;
    if (is_beyond(step.from[last]) == is_beyond(step.to[last])) continue;
    if (step.from_stable != step.to_stable) return std::nullopt;
    count += step.from_stable ? 1 : 0;
  }
  return count;
}

// Whether a place at this value of the parameter (scaled) may lie on the step.
bool FollowedBranch::Step::is_near(double at) const {
  const double a = from[from.size() - 1], b = to[to.size() - 1], reach = (to - from).norm();
  return at >= std::min(a, b) - reach && at <= std::max(a, b) + reach;
}

// Solved where the plane through y across the step meets the branch: regular at folds too.
bool FollowedBranch::lies_on(const Step& step, const Eigen::VectorXd& y) {
  constexpr double kSame = 1e-6, kNear = 0.5;
  const Eigen::VectorXd chord = step.to - step.from;
  const double length = chord.norm();
  if (length == 0.0) return (y - step.from).norm() < kSame;
  const double part = chord.dot(y - step.from) / (length * length);
  const Eigen::VectorXd foot = step.from + part * chord;
  if (part < -kNear || part > 1.0 + kNear || (y - foot).norm() > kNear * length + kSame) return false;
  map_.set_section(step.section);
  const auto place = correct(map_, foot, chord / length, chord);
  return place && (place->y - y).norm() < kSame * std::max(1.0, y.norm());
}

bool FollowedBranch::passes(double parameter, const AnyOrbit& orbit) {
  return passes(parameter, orbit, [](const Step&) { return true; });
}

// Whether one of the steps that count passes the orbit.
bool FollowedBranch::passes(double parameter, const AnyOrbit& orbit, const StepFilter& counts) {
  if (orbit.multiple != map_.multiple()) return false;
  const double turn = 2.0 * std::numbers::pi, at = (parameter - wanted_.low) / (wanted_.high - wanted_.low);
  for (int later = 0; later < orbit.multiple; ++later) {  // periods of the excitation
    double section = -1.0;
    Eigen::VectorXd y;
    for (const Step& step : steps_) {
      if (!step.is_near(at) || !counts(step)) continue;
      if (step.section != section) {
        section = step.section;
        map_.set(parameter);
        map_.set_section(0.0);
        y = map_.moved(map_.place_of(orbit), std::fmod(section + turn * later / orbit.multiple, turn));
      }
      if (y.size() > 0 && lies_on(step, y)) return true;
    }
  }
  return false;
}

}  // namespace frahm::periodic
