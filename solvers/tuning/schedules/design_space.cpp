#include "solvers/tuning/schedules/design_space.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/mechanics/linear_system.hpp"

namespace frahm::tuning {
namespace {

void check(const DesignParameter& parameter) {
  const auto refuse = [&](const std::string& rule) {
    throw mechanics::MechanicsError("design parameter '" + parameter.name + "': " + rule);
  };
  if (!std::isfinite(parameter.lower) || !std::isfinite(parameter.upper)) refuse("its bounds must be finite");
  if (parameter.lower > parameter.upper) refuse("the lower bound is above the upper one");
  if (!std::isfinite(parameter.nominal)) refuse("its value must be finite");
  if (!parameter.schedule) return;
  const Schedule& schedule = *parameter.schedule;
  if (schedule.knots.size() < 2) refuse("a schedule needs at least two knots");
  for (std::size_t i = 1; i < schedule.knots.size(); ++i) {
    if (!(schedule.knots[i] > schedule.knots[i - 1])) refuse("the knots must ascend");
  }
  if (!(schedule.max_slope > 0.0)) refuse("max_slope must be positive");
  if (schedule.leap && *schedule.leap + 1 >= schedule.knots.size()) refuse("it jumps beyond its last knot");
}

}  // namespace

DesignSpace::DesignSpace(const std::vector<DesignParameter>& parameters) : parameters_(parameters) {
  for (std::size_t p = 0; p < parameters_.size(); ++p) {
    check(parameters_[p]);
    first_.push_back(owner_.size());
    const auto& schedule = parameters_[p].schedule;
    owner_.insert(owner_.end(), schedule ? schedule->knots.size() : 1, p);
  }
  first_.push_back(owner_.size());
}

DesignSpace::Interpolation DesignSpace::interpolation(std::size_t p, double band,
                                                      std::span<const double> x) const {
  const std::size_t first = first_[p];
  if (!parameters_[p].schedule) return {{{first, 1.0}, {}}, 1, x[first]};
  const std::vector<double>& knots = parameters_[p].schedule->knots;
  const auto slope = [&](std::size_t piece) {
    return (x[first + piece + 1] - x[first + piece]) / (knots[piece + 1] - knots[piece]);
  };
  // Beyond its ends a schedule has its end values.
  const std::size_t last = knots.size() - 1;
  if (band < knots.front()) return {{{first, 1.0}, {}}, 1, x[first]};
  if (band > knots.back()) return {{{first + last, 1.0}, {}}, 1, x[first + last]};
  const auto above = std::upper_bound(knots.begin(), knots.end(), band) - knots.begin();
  const std::size_t piece = std::min(static_cast<std::size_t>(above) - 1, last - 1);
  const double share = (band - knots[piece]) / (knots[piece + 1] - knots[piece]);
  Interpolation at;
  at.shares[0] = {first + piece, 1.0 - share};
  at.shares[1] = {first + piece + 1, share};
  at.count = 2;
  at.value = (1.0 - share) * x[first + piece] + share * x[first + piece + 1];
  at.slope_left = at.slope_right = slope(piece);
  if (share == 0.0 && piece > 0) at.slope_left = slope(piece - 1);
  return at;
}

std::vector<double> DesignSpace::constant_design(std::span<const double> value) const {
  std::vector<double> x(variables());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const DesignParameter& parameter = parameters_[owner_[i]];
    x[i] = std::clamp(value[owner_[i]], parameter.lower, parameter.upper);
  }
  return x;
}

std::vector<double> DesignSpace::knots() const {
  std::vector<double> all;
  for (const DesignParameter& parameter : parameters_) {
    if (parameter.schedule)
      all.insert(all.end(), parameter.schedule->knots.begin(), parameter.schedule->knots.end());
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

std::vector<Band> DesignSpace::stretches(const Band& band) const {
  std::vector<Band> leaps;
  for (const DesignParameter& parameter : parameters_) {
    if (!parameter.schedule || !parameter.schedule->leap) continue;
    const double* sides = &parameter.schedule->knots[*parameter.schedule->leap];
    if (sides[0] >= band.from && sides[1] <= band.to) leaps.push_back({sides[0], sides[1]});
  }
  std::ranges::sort(leaps, {}, &Band::from);
  std::vector<Band> stretches{band};
  for (const Band& leap : leaps) {
    if (leap.from < stretches.back().from) continue;
    stretches.back().to = leap.from;
    stretches.push_back({leap.to, band.to});
  }
  return stretches;
}

}  // namespace frahm::tuning
