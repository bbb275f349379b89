#include "solvers/tuning/exchange/tuned_response.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "solvers/mechanics/network_values.hpp"
#include "solvers/orbits/orbit.hpp"

namespace frahm::tuning {

TunedResponse::TunedResponse(const Task& task, const DesignSpace& space, std::size_t scenario,
                             const std::vector<periodic::Quantity>& quantities, Effort& effort, Worst worst)
    : task_(task),
      space_(space),
      scenario_(scenario),
      response_(task.network, quantities, periodic::Path::fastest, task.orbits),
      effort_(effort),
      interpolations_(space.parameters()),
      quantities_(quantities),
      worst_(worst),
      may_jump_(may_take_several_orbits(task.network)),
      at_(space.parameters() + 1),
      value_(quantities.size()),
      derivative_(at_.size() * quantities.size()),
      slope_(quantities.size()) {
  effort.seen.resize(task.scenarios.size());
}

TunedResponse::State TunedResponse::solve(std::span<const double> x, double band, Derivatives derivatives) {
  const State state = solve_at(x, band, derivatives);
  if (state != State::solved || !gradient_missing_) return state;
  const double beside = band * (band > task_.band.from ? 1.0 - 1e-9 : 1.0 + 1e-9);
  return solve_at(x, beside, derivatives);
}

void TunedResponse::set_values_at(std::span<const double> x, double band, mechanics::NetworkValues& values,
                                  std::vector<mechanics::NetworkValues>* directions) {
  for (std::size_t p = 0; p < interpolations_.size(); ++p) {
    interpolations_[p] = space_.interpolation(p, band, x);
    at_[p] = interpolations_[p].value;
  }
  at_.back() = band;
  task_.network_at(scenario_, at_, values, directions);
}

// The matrices stay where only the frequency and the excitation change.
void TunedResponse::set_response() {
  if (is_set_ && periodic::have_same_elements(values_, set_)) return response_.set_forcing(values_);
  is_set_ = false;
  response_.set_values(values_);
  set_ = values_;
  is_set_ = true;
}

std::span<const double> TunedResponse::solve_row(std::span<const double> x, std::span<const double> places) {
  row_.resize(places.size());
  found_.resize(places.size());
  row_values_.assign(places.size() * value_.size(), kNone);
  for (std::size_t i = 0; i < places.size(); ++i) set_values_at(x, places[i], row_[i], nullptr);
  is_set_ = false;
  response_.solve_row(row_, found_, row_values_);
  effort_.orbits += places.size();
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (periodic::has_response(found_[i].status)) continue;
    std::ranges::fill(std::span(row_values_).subspan(i * value_.size(), value_.size()), kNone);
  }
  return row_values_;
}

TunedResponse::State TunedResponse::solve_at(std::span<const double> x, double band,
                                             Derivatives derivatives) {
  set_values_at(x, band, values_, derivatives == Derivatives::none ? nullptr : &directions_);
  gradient_missing_ = false;
  try {
    set_response();
  } catch (const mechanics::MechanicsError& error) {
    reason_ = error.what();
    return State::failed;
  }
  response_.begin_row();
  if (may_jump_) response_.start_from(effort_.seen[scenario_].near(band));
  const periodic::ResponseSummary& summary = response_.solve();
  ++effort_.orbits;
  if (may_jump_) effort_.seen[scenario_].keep(band, response_.known());
  is_symmetric_ = summary.half_period;
  is_periodic_ = summary.status != periodic::Status::not_periodic;
  coexisting_ = summary.coexisting;
  reason_ = summary.reason;
  if (summary.status == periodic::Status::unbounded) return State::unbounded;
  if (summary.status == periodic::Status::failed) return State::failed;
  if (coexisting_ == 1)
    response_.quantities(value_);
  else if (!tell_worst(is_periodic_ ? coexisting_ : summary.motions))
    return State::failed;
  if (derivatives != Derivatives::none && is_periodic_) {
    ++effort_.gradients;
    const std::string why_none = differentiate(derivatives);
    gradient_missing_ = !why_none.empty();
    if (gradient_missing_) reason_ = why_none;
  } else if (derivatives != Derivatives::none) {
    std::ranges::fill(derivative_, 0.0);
    std::ranges::fill(slope_, Slopes{kNone, kNone});
  }
  return State::solved;
}

// Leaves the response at the worst of those found, by the larger side of a peak. Returns whether there is
// one.
bool TunedResponse::tell_worst(int responses) {
  constexpr int kMotion = 64;  // periods that what is reported of a motion takes
  std::vector<double> values(value_.size());
  double worst = kNone;
  int last = -1, reported = -1;
  const auto size_of = [&](int which) {
    response_.tell(last = which);
    response_.quantities(values);
    for (std::size_t q = 0; q < values.size() && !is_periodic_; ++q) {
      if (periodic::is_of_a_period(quantities_[q].measure)) values[q] /= kMotion;
    }
    return *std::ranges::max_element(values);
  };
  for (int which = 0; which < responses; ++which) {
    const double size = size_of(which);
    const bool is_worse = worst_ == Worst::largest ? size > worst : size < worst;
    if (!std::isfinite(size) || !(std::isnan(worst) || is_worse)) continue;
    worst = size;
    reported = which;
    value_ = values;
  }
  if (reported >= 0 && reported != last) size_of(reported);
  return reported >= 0;
}

// Returns why there are none, as PeriodicResponse::gradient().
std::string TunedResponse::differentiate(Derivatives derivatives) {
  if (derivatives == Derivatives::along_band && is_smooth()) return differentiate_along_band();
  const std::string why_none = response_.gradient(directions_, derivative_);
  for (std::size_t q = 0; q < slope_.size(); ++q) {
    slope_[q] = {slope(q, &DesignSpace::Interpolation::slope_left),
                 slope(q, &DesignSpace::Interpolation::slope_right)};
  }
  return why_none;
}

// Whether no schedule has a kink here.
bool TunedResponse::is_smooth() const {
  return std::ranges::all_of(interpolations_, [](const DesignSpace::Interpolation& parameter) {
    return parameter.slope_left == parameter.slope_right;
  });
}

// In the one direction in which the values change along the band.
std::string TunedResponse::differentiate_along_band() {
  mechanics::NetworkValues& along = directions_.back();
  for (std::size_t p = 0; p < interpolations_.size(); ++p) {
    const double rate = interpolations_[p].slope_left;
    if (rate != 0.0) mechanics::add(directions_[p], rate, along);
  }
  const std::size_t quantities = slope_.size();
  const std::span<double> out = std::span<double>(derivative_).first(quantities);
  const std::string why_none = response_.gradient({&along, 1}, out);
  for (std::size_t q = 0; q < quantities; ++q) slope_[q] = {out[q], out[q]};
  return why_none;
}

double TunedResponse::slope(std::size_t quantity, double DesignSpace::Interpolation::*of_parameter) const {
  // dX/dband = partial X / partial band + sum_p partial X / partial p  p'(band)
  double sum = derivative(quantity, interpolations_.size());
  for (std::size_t p = 0; p < interpolations_.size(); ++p) {
    if (interpolations_[p].*of_parameter != 0.0)
      sum += derivative(quantity, p) * interpolations_[p].*of_parameter;
  }
  return sum;
}

}  // namespace frahm::tuning
