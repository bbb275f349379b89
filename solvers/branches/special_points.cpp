#include "solvers/branches/special_points.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

namespace frahm::periodic {
namespace {

constexpr double kJump = 1e-6;  // what is left of an equation that a jump crosses is larger

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
  // The place at s, searched from the chord between two that are known.
  std::optional<BranchPlace> place(double s, const BranchPlace& a, const BranchPlace& b) const {
    const double part = (s - at(a)) / (at(b) - at(a));
    return correct(map_, a.y + part * (b.y - a.y), from_.tangent, part < 0.5 ? a.tangent : b.tangent);
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
  BranchPlace a = stretch.from(), b = stretch.to();
  double fa = function(a), fb = function(b);
  BranchPlace best = std::abs(fa) < std::abs(fb) ? a : b;
  for (int i = 0; i < kMostSteps && stretch.at(b) - stretch.at(a) > kNoLength; ++i) {
    const double sa = stretch.at(a), sb = stretch.at(b);
    const auto place = stretch.place(i % 3 == 2 ? 0.5 * (sa + sb) : (sa * fb - sb * fa) / (fb - fa), a, b);
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
  return best;
}

// Where the events of an index are no longer as many as at the first place, by halving. Of both ends of the
// bracket the one that has more: it happens there.
struct Border {
  BranchPlace place;
  double width;  // of the bracket
};
Border border_of_event(const Stretch& stretch, std::size_t event) {
  constexpr double kNoLength = 1e-12;
  BranchPlace a = stretch.from(), b = stretch.to();
  while (stretch.at(b) - stretch.at(a) > kNoLength) {
    const auto place = stretch.place(0.5 * (stretch.at(a) + stretch.at(b)), a, b);
    if (!place) break;
    (place->events[event] == stretch.from().events[event] ? a : b) = *place;
  }
  return {a.events[event] > b.events[event] ? a : b, stretch.at(b) - stretch.at(a)};
}

}  // namespace

double residual_of_grazing(BranchMap& map, const BranchPlace& place, double width, std::size_t event) {
  if (event >= map.assembly().bends().element.size()) return width;
  Shot shot = map.shoot(place.y);
  return map.distance_from_bend(map.orbit(place.y, std::move(shot)), static_cast<Eigen::Index>(event));
}

namespace {

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
    found.push_back({SpecialKind::grazing, border.place, element, 
                     residual_of_grazing(stretch.map(), border.place, border.width, event)});
  }
}

// A real multiplier that passes +1 where the parameter turns belongs to the fold.
void add_stability_change(const Stretch& stretch, bool has_fold, std::vector<SpecialPlace>& found) {
  constexpr double kAxis = 1e-4;
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

// Where dp/ds jumps across 0 no place has dp/ds = 0: the branch turns at the grazing.
void join_corners(const Stretch& stretch, std::vector<SpecialPlace>& found) {
  constexpr double kSame = 1e-6;
  const auto fold = std::ranges::find(found, SpecialKind::fold, &SpecialPlace::kind);
  if (fold == found.end() || fold->residual <= kJump) return;
  const double at = stretch.at(fold->place);
  const auto grazing = std::ranges::find_if(found, [&](const SpecialPlace& each) {
    return each.kind == SpecialKind::grazing && std::abs(stretch.at(each.place) - at) < kSame;
  });
  if (grazing == found.end()) return;
  grazing->kind = SpecialKind::corner;
  found.erase(fold);
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
  join_corners(stretch, found);
  std::ranges::sort(found, [&](const SpecialPlace& a, const SpecialPlace& b) {
    return stretch.at(a.place) < stretch.at(b.place);
  });
  return found;
}

}  // namespace frahm::periodic
