#include "solvers/branches/special_points.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace frahm::periodic {
namespace {

using Function = std::function<double(const BranchPlace&)>;

// The part of a branch between two places, by the arclength s from the first along its tangent.
class Stretch {
 public:
  Stretch(BranchMap& map, const BranchPlace& from, const BranchPlace& to)
      : map_(map), from_(from), to_(to), length_(from.tangent.dot(to.y - from.y)) {}

  double length() const { return length_; }
  const BranchPlace& from() const { return from_; }
  const BranchPlace& to() const { return to_; }
  BranchMap& map() const { return map_; }
  double at(const BranchPlace& place) const { return from_.tangent.dot(place.y - from_.y); }
  // The place at s, searched from the chord.
  std::optional<BranchPlace> place(double s) const {
    const double part = s / length_;
    return correct(map_, from_.y + part * (to_.y - from_.y), from_.tangent,
                   part < 0.5 ? from_.tangent : to_.tangent);
  }

 private:
  BranchMap& map_;
  const BranchPlace& from_;
  const BranchPlace& to_;
  double length_;
};

// The root of a function that has different signs at both ends, by regula falsi with halved ends (Illinois),
// each third step by halving the bracket.
BranchPlace root(const Stretch& stretch, const Function& function) {
  constexpr int kMostSteps = 100;
  constexpr double kTolerance = 1e-11, kNoLength = 1e-15;
  double a = 0.0, b = stretch.length(), fa = function(stretch.from()), fb = function(stretch.to());
  BranchPlace best = std::abs(fa) < std::abs(fb) ? stretch.from() : stretch.to();
  for (int i = 0; i < kMostSteps && b - a > kNoLength; ++i) {
    const double s = i % 3 == 2 ? 0.5 * (a + b) : (a * fb - b * fa) / (fb - fa);
    const auto place = stretch.place(s);
    if (!place) break;
    const double f = function(*place);
    if (std::abs(f) <= std::abs(function(best))) best = *place;
    if (std::abs(f) <= kTolerance) break;
    if ((f > 0.0) == (fb > 0.0)) {
      b = s, fb = f, fa *= 0.5;
    } else {
      a = s, fa = f, fb *= 0.5;
    }
  }
  return best;
}

// Whether the events of an index are as many as at the first place, bisected. Of both ends of the bracket the
// one that has more: it happens there.
struct Border {
  BranchPlace place;
  double margin;  // the lesser of both ends
};
Border border_of_event(const Stretch& stretch, std::size_t event) {
  constexpr double kNoLength = 1e-12;
  double a = 0.0, b = stretch.length();
  BranchPlace at_a = stretch.from(), at_b = stretch.to();
  while (b - a > kNoLength) {
    const double middle = 0.5 * (a + b);
    const auto place = stretch.place(middle);
    if (!place) break;
    const bool as_before = place->events[event] == stretch.from().events[event];
    (as_before ? a : b) = middle;
    (as_before ? at_a : at_b) = *place;
  }
  const double margin = std::min(at_a.margin, at_b.margin);
  return {at_a.events[event] > at_b.events[event] ? at_a : at_b, margin};
}

double residual_of_grazing(const Stretch& stretch, const Border& border, std::size_t event) {
  BranchMap& map = stretch.map();
  if (event >= map.assembly().bends().element.size()) return border.margin;
  Shot shot = map.shoot(border.place.y);
  return map.distance_from_bend(map.orbit(border.place.y, std::move(shot)), static_cast<Eigen::Index>(event));
}

void add_grazings(const Stretch& stretch, std::vector<SpecialPlace>& found) {
  constexpr double kSame = 1e-8;
  const std::size_t first = found.size();
  for (std::size_t event = 0; event < stretch.from().events.size(); ++event) {
    if (stretch.from().events[event] == stretch.to().events[event]) continue;
    const Border border = border_of_event(stretch, event);
    const std::size_t element = stretch.map().element_of_event(event);
    // Both stops of a symmetric orbit at once.
    const bool known = std::any_of(
        found.begin() + static_cast<std::ptrdiff_t>(first), found.end(), [&](const SpecialPlace& each) {
          return each.element == element &&
                 std::abs(stretch.at(each.place) - stretch.at(border.place)) < kSame;
        });
    if (known) continue;
    found.push_back({SpecialKind::grazing, border.place, element, residual_of_grazing(stretch, border, event)});
  }
}

// A real multiplier that passes +1 where the parameter turns belongs to the fold.
void add_stability_change(const Stretch& stretch, bool has_fold, std::vector<SpecialPlace>& found) {
  constexpr double kJump = 1e-6, kAxis = 1e-4;
  const int before = stretch.from().unstable(), after = stretch.to().unstable();
  const int change = std::abs(after - before);
  if (change == 0 || (has_fold && change == 1)) return;
  const Eigen::Index passing = std::min(before, after);  // its index, by modulus
  const auto beyond_one = [passing](const BranchPlace& place) {
    return std::abs(place.multipliers[passing]) - 1.0;
  };
  SpecialPlace special{.place = root(stretch, beyond_one)};
  const std::complex<double> multiplier = special.place.multipliers[passing];
  special.residual = std::abs(beyond_one(special.place));
  special.kind = special.residual > kJump                     ? SpecialKind::stability_jump
                 : std::abs(multiplier.imag()) > kAxis        ? SpecialKind::torus
                 : multiplier.real() > 0.0                    ? SpecialKind::branching
                                                              : SpecialKind::period_doubling;
  found.push_back(special);
}

}  // namespace

std::vector<SpecialPlace> special_places(BranchMap& map, const BranchPlace& from, const BranchPlace& to) {
  const Stretch stretch(map, from, to);
  std::vector<SpecialPlace> found;
  const auto rate = [](const BranchPlace& place) { return place.parameter_rate(); };
  const bool has_fold = (rate(from) > 0.0) != (rate(to) > 0.0);
  if (has_fold) {
    SpecialPlace fold{.kind = SpecialKind::fold, .place = root(stretch, rate)};
    fold.residual = std::abs(rate(fold.place));
    found.push_back(fold);
  }
  add_stability_change(stretch, has_fold, found);
  add_grazings(stretch, found);
  std::ranges::sort(found, [&](const SpecialPlace& a, const SpecialPlace& b) {
    return stretch.at(a.place) < stretch.at(b.place);
  });
  return found;
}

}  // namespace frahm::periodic
