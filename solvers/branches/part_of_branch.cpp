#include "solvers/branches/part_of_branch.hpp"

#include <cmath>

namespace frahm::periodic {

std::optional<BranchPlace> PartOfBranch::place(double s, const BranchPlace& a, const BranchPlace& b) const {
  const double part = (s - at(a)) / (at(b) - at(a));
  if (const auto place =
          correct(map_, a.y + part * (b.y - a.y), from_.tangent, part < 0.5 ? a.tangent : b.tangent))
    return place;
  for (const BranchPlace* side : {&a, &b})
    if (const auto place = place_along(*side, s, (b.y - a.y).norm())) return place;
  return std::nullopt;
}

// At a kink of the map Newton's method goes to and fro between its two sides. From the tangent of either it
// stays on that side, where the curve is smooth.
std::optional<BranchPlace> PartOfBranch::place_along(const BranchPlace& side, double s, double within) const {
  constexpr double kNear = 2.0;
  const double rate = from_.tangent.dot(side.tangent);
  if (rate == 0.0) return std::nullopt;
  auto place = correct(map_, side.y + (s - at(side)) / rate * side.tangent, from_.tangent, side.tangent);
  return place && (place->y - side.y).norm() < kNear * within ? place : std::nullopt;
}

std::optional<BranchPlace> PartOfBranch::place_near(double s, const BranchPlace& a,
                                                    const BranchPlace& b) const {
  if (const auto there = place(s, a, b)) return there;
  const double from = at(a), length = at(b) - from;
  for (const double each : {0.5, 0.25, 0.75, 0.1, 0.9})
    if (const auto beside = place(from + each * length, a, b)) return beside;
  return std::nullopt;
}

// By regula falsi with halved ends (Illinois), each third step by halving the bracket.
BranchRoot root(const PartOfBranch& part, const PlaceFunction& function) {
  constexpr int kMostSteps = 100;
  constexpr double kTolerance = 1e-11, kNoLength = 1e-15;
  BranchPlace a = part.from(), b = part.to();
  double fa = function(a), fb = function(b);
  BranchPlace best = std::abs(fa) < std::abs(fb) ? a : b;
  for (int i = 0; i < kMostSteps && part.at(b) - part.at(a) > kNoLength; ++i) {
    const double sa = part.at(a), sb = part.at(b);
    const auto place = part.place_near(i % 3 == 2 ? 0.5 * (sa + sb) : (sa * fb - sb * fa) / (fb - fa), a, b);
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
  // For a jump no place has a small value: it lies within the bracket, whatever is smallest elsewhere.
  if (std::abs(function(best)) > BranchRoot::kJump)
    best = std::abs(function(a)) < std::abs(function(b)) ? a : b;
  return {best, function(best), part.at(b) - part.at(a)};
}

}  // namespace frahm::periodic
