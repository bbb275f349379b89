#include "solvers/branches/special_points.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "solvers/branches/part_of_branch.hpp"

namespace frahm::periodic {
namespace {

// Where the events of an index are no longer as many as at the first place, by halving. Of both ends of the
// bracket the one that has more: it happens there.
struct Border {
  BranchPlace place;
  double width = 0.0;  // of the bracket
};
Border border_of_event(const PartOfBranch& stretch, std::size_t event) {
  constexpr int kMostSteps = 60;
  BranchPlace a = stretch.from(), b = stretch.to();
  for (int i = 0; i < kMostSteps && (b.y - a.y).norm() > BranchRoot::kClosed; ++i) {
    const auto place = stretch.place_near(0.5, a, b);
    if (!place) break;
    (place->events[event] == stretch.from().events[event] ? a : b) = *place;
  }
  return {a.events[event] > b.events[event] ? a : b, (b.y - a.y).norm()};
}

}  // namespace

double residual_of_grazing(BranchMap& map, const BranchPlace& place, double width, std::size_t event) {
  if (event >= map.assembly().bends().element.size()) return width;
  Shot shot = map.pass(place.y, Tangent::followed);
  return std::min(width, distance_from_bend(map.flow(), map.orbit(place.y, std::move(shot)),
                                            static_cast<Eigen::Index>(event)));
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
                     residual_of_grazing(stretch.map(), border.place, border.width, event),
                     border.width <= BranchRoot::kNarrow});
  }
}

// A real multiplier that passes +1 where the parameter turns belongs to the fold.
void add_stability_change(const PartOfBranch& stretch, bool has_fold, std::vector<SpecialPlace>& found) {
  constexpr double kAxis = 1e-4;
  // Where all laws are monotone nothing is unstable.
  if (stretch.map().system().monotone) return;
  const int before = stretch.from().unstable(), after = stretch.to().unstable();
  const int change = std::abs(after - before);
  if (change == 0 || (has_fold && change == 1)) return;
  const Eigen::Index passing = std::min(before, after);  // its index, by modulus
  const auto beyond_one = [passing](const BranchPlace& place) {
    return std::abs(place.multipliers[passing]) - 1.0 - BranchPlace::kOutside;
  };
  const BranchRoot found_root = root(stretch, beyond_one);
  const bool jumps = found_root.is_jump();
  const std::complex<double> multiplier = found_root.place.multipliers[passing];
  SpecialPlace special;
  special.place = found_root.place;
  special.residual = jumps ? found_root.width : std::abs(found_root.value);
  special.is_solved = found_root.is_solved();
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
  const BranchRoot fold = root(stretch, [](const BranchPlace& place) { return place.parameter_rate(); });
  SpecialPlace special{SpecialKind::fold, fold.place, std::nullopt, std::abs(fold.value), fold.is_solved()};
  if (fold.is_jump()) special = {SpecialKind::corner, fold.place, std::nullopt, fold.width};
  const double at = stretch.at(fold.place);
  const auto grazing = std::ranges::find_if(found, [&](const SpecialPlace& each) {
    return each.kind == SpecialKind::grazing && std::abs(stretch.at(each.place) - at) < kSame;
  });
  if (std::abs(fold.value) <= BranchRoot::kJump || grazing == found.end())
    found.push_back(special);
  else
    grazing->kind = SpecialKind::corner;
}

}  // namespace

std::vector<SpecialPlace> special_places(BranchMap& map, const BranchPlace& from, const BranchPlace& to) {
  const PartOfBranch stretch(map, from, to);
  std::vector<SpecialPlace> found;
  // Where all laws are monotone one value of the parameter has one orbit, and nothing turns back but
  // rounding.
  const bool turns = !map.system().monotone && (from.parameter_rate() > 0.0) != (to.parameter_rate() > 0.0);
  add_grazings(stretch, found);
  add_stability_change(stretch, turns, found);
  if (turns) add_fold(stretch, found);
  std::ranges::sort(found, [&](const SpecialPlace& a, const SpecialPlace& b) {
    return stretch.at(a.place) < stretch.at(b.place);
  });
  return found;
}

}  // namespace frahm::periodic
