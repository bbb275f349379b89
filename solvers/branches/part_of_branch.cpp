#include "solvers/branches/part_of_branch.hpp"

#include <algorithm>
#include <cmath>

namespace frahm::periodic {
namespace {

// Whether a place found between two is of their branch, and not of one that crosses it or begins at a kink:
// off the chord by no more than a corner of 90 degrees is, its tangent that of a side and not across the
// chord. The tangent is turned the way this side's leads.
bool is_between(const BranchPlace& a, const BranchPlace& b, const Eigen::VectorXd& foot, BranchPlace& place) {
  constexpr double kOff = 0.5, kAlong = 0.7, kAcross = 0.1, kRounding = 1e-12;
  const double on = place.tangent.dot((b.y - a.y).normalized());
  const double reach = kOff * (b.y - a.y).norm() + kRounding * std::max(1.0, foot.norm());
  const double as_a = place.tangent.dot(a.tangent), as_b = place.tangent.dot(b.tangent);
  const double along = std::abs(as_a) > std::abs(as_b) ? as_a : as_b;
  if (along < 0.0) place.tangent *= -1.0;
  return (place.y - foot).norm() <= reach && std::abs(along) > kAlong && std::abs(on) > kAcross;
}

}  // namespace

std::optional<BranchPlace> PartOfBranch::place(double share, const BranchPlace& a,
                                               const BranchPlace& b) const {
  const Eigen::VectorXd chord = b.y - a.y, across = chord.normalized(), foot = a.y + share * chord;
  const auto from = [&](const Eigen::VectorXd& start, const BranchPlace& side) {
    auto place = correct(map_, start, across, side.tangent);
    if (place && !is_between(a, b, foot, *place)) place.reset();
    return place;
  };
  if (auto place = from(foot, share < 0.5 ? a : b)) return place;
  // At a kink of the map Newton's method goes to and fro between its two sides. From the tangent of either it
  // stays on that side, where the curve is smooth.
  for (const BranchPlace* side : {&a, &b}) {
    const double rate = across.dot(side->tangent);
    if (rate == 0.0) continue;
    if (auto place = from(side->y + across.dot(foot - side->y) / rate * side->tangent, *side)) return place;
  }
  return std::nullopt;
}

std::optional<BranchPlace> PartOfBranch::place_near(double share, const BranchPlace& a,
                                                    const BranchPlace& b) const {
  for (const double each : {share, 0.5, 0.25, 0.75, 0.1, 0.9})
    if (const auto found = place(each, a, b)) return found;
  return std::nullopt;
}

// By regula falsi with halved ends (Illinois); by halving the bracket where that has not done so.
BranchRoot root(const PartOfBranch& part, const PlaceFunction& function) {
  constexpr int kMostSteps = 100;
  constexpr double kTolerance = 1e-11, kNoLength = 1e-15;
  BranchPlace a = part.from(), b = part.to();
  double fa = function(a), fb = function(b);
  BranchPlace best = std::abs(fa) < std::abs(fb) ? a : b;
  double before = HUGE_VAL;
  for (int i = 0; i < kMostSteps && (b.y - a.y).norm() > kNoLength; ++i) {
    const double length = (b.y - a.y).norm();
    const auto place = part.place_near(length > 0.5 * before ? 0.5 : fa / (fa - fb), a, b);
    before = length;
    if (!place) break;
    const double f = function(*place);
    if (std::abs(f) <= std::abs(function(best))) best = *place;
    if (std::abs(f) <= kTolerance) break;
    if ((f > 0.0) == (fb > 0.0)) {
      b = *place, fb = f, fa *= 0.5;
    } else {
      a = *place, fa = f, fb *= 0.5;
    }
  }
  BranchRoot root{.place = best, .value = function(best), .width = (b.y - a.y).norm()};
  root.has_event = a.events != b.events || a.grazes || b.grazes;
  if (!root.is_jump()) return root;
  // No place next to a jump has a small value, whatever is smallest elsewhere.
  root.place = std::abs(function(a)) < std::abs(function(b)) ? a : b;
  root.value = function(root.place);
  return root;
}

}  // namespace frahm::periodic
