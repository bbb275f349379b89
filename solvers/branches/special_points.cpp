#include "solvers/branches/special_points.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

namespace frahm::periodic {
namespace {

constexpr double kJump = 1e-6;     // what is left of an equation that a jump crosses is larger
constexpr double kClosed = 1e-12;  // a bracket

using Function = std::function<double(const BranchPlace&)>;

// The part of a branch between two places, by the arclength s from the first along its tangent.
class PartOfBranch {
 public:
  PartOfBranch(BranchMap& map, const BranchPlace& from, const BranchPlace& to)
      : map_(map), from_(from), to_(to) {}

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
};

// The root of a function that has different signs at both ends, by regula falsi with halved ends (Illinois),
// each third step by halving the bracket.
struct Root {
  BranchPlace place;
  double value;  // of the function there
  double width;  // of the bracket
  // The function jumps across zero: the bracket is closed, and there is no root.
  bool is_jump() const { return std::abs(value) > kJump && width < kClosed; }
};
Root root(const PartOfBranch& stretch, const Function& function) {
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
  return {best, function(best), stretch.at(b) - stretch.at(a)};
}

// Where the events of an index are no longer as many as at the first place, by halving. Of both ends of the
// bracket the one that has more: it happens there.
struct Border {
  BranchPlace place;
  double width;  // of the bracket
};
Border border_of_event(const PartOfBranch& stretch, std::size_t event) {
  constexpr int kMostSteps = 60;
  BranchPlace a = stretch.from(), b = stretch.to();
  for (int i = 0; i < kMostSteps && stretch.at(b) - stretch.at(a) > kClosed; ++i) {
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
  return distance_from_bend(map.flow(), map.orbit(place.y, std::move(shot)),
                            static_cast<Eigen::Index>(event));
}

namespace {

void add_grazings(const PartOfBranch& stretch, std::vector<SpecialPlace>& found) {
  constexpr double kSame = 1e-8;
  const std::size_t first = found.size();
  for (std::size_t event = 0; event < stretch.from().events.size(); ++event) {
    if (stretch.from().events[event] == stretch.to().events[event]) continue;
    const Border border = border_of_event(stretch, event);
    const std::size_t element = element_of_event(stretch.map().assembly(), event);
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
void add_stability_change(const PartOfBranch& stretch, bool has_fold, std::vector<SpecialPlace>& found) {
  constexpr double kAxis = 1e-4;
  const int before = stretch.from().unstable(), after = stretch.to().unstable();
  const int change = std::abs(after - before);
  if (change == 0 || (has_fold && change == 1)) return;
  const Eigen::Index passing = std::min(before, after);  // its index, by modulus
  const auto beyond_one = [passing](const BranchPlace& place) {
    return std::abs(place.multipliers[passing]) - 1.0;
  };
  const Root found_root = root(stretch, beyond_one);
  const bool jumps = found_root.is_jump();
  const std::complex<double> multiplier = found_root.place.multipliers[passing];
  SpecialPlace special;
  special.place = found_root.place;
  special.residual = jumps ? found_root.width : std::abs(found_root.value);
  special.kind = jumps                                 ? SpecialKind::stability_jump
                 : std::abs(multiplier.imag()) > kAxis ? SpecialKind::torus
                 : multiplier.real() > 0.0             ? SpecialKind::branching
                                                       : SpecialKind::period_doubling;
  found.push_back(special);
}

// Where dp/ds changes its sign. Where it jumps across 0, at a grazing that is then part of the corner, there
// is no fold.
void add_fold(const PartOfBranch& stretch, std::vector<SpecialPlace>& found) {
  constexpr double kSame = 1e-6;
  const Root fold = root(stretch, [](const BranchPlace& place) { return place.parameter_rate(); });
  SpecialPlace special{SpecialKind::fold, fold.place, std::nullopt, std::abs(fold.value)};
  if (fold.is_jump()) special = {SpecialKind::corner, fold.place, std::nullopt, fold.width};
  const double at = stretch.at(fold.place);
  const auto grazing = std::ranges::find_if(found, [&](const SpecialPlace& each) {
    return each.kind == SpecialKind::grazing && std::abs(stretch.at(each.place) - at) < kSame;
  });
  if (std::abs(fold.value) <= kJump || grazing == found.end())
    found.push_back(special);
  else
    grazing->kind = SpecialKind::corner;
}

}  // namespace

std::vector<SpecialPlace> special_places(BranchMap& map, const BranchPlace& from, const BranchPlace& to) {
  const PartOfBranch stretch(map, from, to);
  std::vector<SpecialPlace> found;
  const bool turns = (from.parameter_rate() > 0.0) != (to.parameter_rate() > 0.0);
  add_grazings(stretch, found);
  add_stability_change(stretch, turns, found);
  if (turns) add_fold(stretch, found);
  std::ranges::sort(found, [&](const SpecialPlace& a, const SpecialPlace& b) {
    return stretch.at(a.place) < stretch.at(b.place);
  });
  return found;
}

}  // namespace frahm::periodic
