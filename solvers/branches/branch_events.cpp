#include "solvers/branches/branch_events.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/events/bend_guards.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/quantities/orbit_steps.hpp"

namespace frahm::periodic {
namespace {

// A guard (events/bend_guards.hpp) over a step of an orbit.
Polynomial bend_guard_over(const Expansion<kAnySize, kAnySize>& x, const StepBends<kAnySize, kAnySize>& bends,
                           BendGuard guard, Eigen::Index j) {
  const auto b = bends.B.col(j);
  Polynomial place = x.displacement(b) + x.u * bends.motion.row(j).transpose();
  Polynomial velocity = x.velocity(b) + x.u * bends.motion_velocity.row(j).transpose();
  const bool of_velocity = contains(bends.of_velocity, j);
  (of_velocity ? velocity : place)[0] -= bends.place[j];
  if (guard == BendGuard::place) return of_velocity ? velocity : place;
  return bends.stiffness[j] * place + bends.damping[j] * velocity;
}

}  // namespace

std::vector<std::size_t> list_events(const AnyFlow& flow, const AnyPassage& passage) {
  constexpr double kNoLength = 1e-10;  // of the period: the first slip of a state that should be at rest
  const auto& eq = flow.equations();
  const auto bends = static_cast<std::size_t>(eq.bends.count());
  const std::size_t all = bends + static_cast<std::size_t>(eq.contacts());
  std::vector<std::size_t> list;
  const Mode<kAnySize, kAnySize>* before = nullptr;
  for (const auto& segment : passage.segments) {
    if (before == nullptr && segment.length <= kNoLength * eq.period) continue;
    const auto& mode = flow.mode(segment.mode);
    for (std::size_t i = 0; before != nullptr && i < all; ++i) {
      const auto j = static_cast<Eigen::Index>(i < bends ? i : i - bends);
      const bool changes = i < bends ? contains(mode.beyond ^ before->beyond, j)
                                     : contains(mode.stuck ^ before->stuck, j) ||
                                           (!contains(mode.stuck, j) && mode.sign(j) != before->sign(j));
      if (changes) list.push_back(i);
    }
    before = &mode;
  }
  return list;
}

std::vector<int> count_events(const AnyFlow& flow, const AnyPassage& passage) {
  const auto& eq = flow.equations();
  std::vector<int> count(static_cast<std::size_t>(eq.bends.count() + eq.contacts()), 0);
  for (const std::size_t event : list_events(flow, passage)) ++count[event];
  return count;
}

double distance_from_bend(const AnyFlow& flow, const AnyOrbit& orbit, Eigen::Index j) {
  const auto& bends = flow.equations().bends;
  OrbitSteps<kAnySize, kAnySize> steps(flow);
  steps.lay_out(orbit);
  double nearest = HUGE_VAL;
  for (const BendGuard guard : {BendGuard::place, BendGuard::force}) {
    if (guard == BendGuard::force && contains(bends.pulling, j)) continue;
    double size = guard == BendGuard::place ? std::abs(bends.place[j]) : 0.0, least = HUGE_VAL;
    double slope_before = bend_guard(flow, steps.steps().back().right, guard, j).slope;
    for (auto& step : steps.steps()) {
      const ValueAndSlope left = bend_guard(flow, step.left, guard, j);
      const ValueAndSlope right = bend_guard(flow, step.right, guard, j);
      size = std::max({size, std::abs(left.value), std::abs(right.value)});
      // An extreme between two steps, as at an orbit's section that lies there.
      if ((slope_before > 0.0) != (left.slope > 0.0)) least = std::min(least, std::abs(left.value));
      slope_before = right.slope;
      if ((left.slope > 0.0) == (right.slope > 0.0)) continue;
      const Polynomial g = bend_guard_over(steps.expand(step), bends, guard, j);
      const Roots extremes = sign_changes(derivative(g));
      for (int i = 0; i < extremes.count; ++i)
        least = std::min(least, std::abs(evaluate(g, extremes.at[static_cast<std::size_t>(i)])));
    }
    nearest = std::min(nearest, least / size);
  }
  return nearest;
}

std::size_t element_of_event(const mechanics::Assembly& assembly, std::size_t event) {
  const auto& elements = assembly.bends().element;
  if (event < elements.size()) return elements[event];
  const std::size_t contact = event - elements.size();
  for (std::size_t e = 0; e < assembly.shares().size(); ++e) {
    if (mechanics::has_contact(assembly.network().elements[e]) && assembly.shares()[e].contact == contact)
      return e;
  }
  return 0;
}

}  // namespace frahm::periodic
