#include "solvers/tuning/exchange/tuned_response.hpp"

#include <algorithm>

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/orbits/orbit.hpp"

namespace frahm::tuning {
namespace {

// sum += factor values
void add(const mechanics::NetworkValues& values, double factor, mechanics::NetworkValues& sum) {
  const auto add_list = [factor](const std::vector<double>& list, std::vector<double>& to) {
    for (std::size_t i = 0; i < list.size(); ++i) to[i] += factor * list[i];
  };
  sum.omega += factor * values.omega;
  add_list(values.mass, sum.mass);
  add_list(values.element, sum.element);
  add_list(values.second, sum.second);
  add_list(values.damping, sum.damping);
  for (std::size_t e = 0; e < values.bends.size(); ++e) {
    for (std::size_t i = 0; i < values.bends[e].size(); ++i) {
      sum.bends[e][i].place += factor * values.bends[e][i].place;
      sum.bends[e][i].stiffness += factor * values.bends[e][i].stiffness;
      sum.bends[e][i].damping += factor * values.bends[e][i].damping;
    }
  }
  for (std::size_t i = 0; i < values.excitation.size(); ++i) {
    sum.excitation[i].amplitude += factor * values.excitation[i].amplitude;
    sum.excitation[i].phase += factor * values.excitation[i].phase;
    sum.excitation[i].rod += factor * values.excitation[i].rod;
  }
  sum.hysteretic_omega += factor * values.hysteretic_omega;
}

}  // namespace

TunedResponse::TunedResponse(const Task& task, const DesignSpace& space, std::size_t scenario,
                             std::vector<periodic::Quantity> quantities, Effort& effort)
    : task_(task),
      space_(space),
      scenario_(scenario),
      response_(task.network, quantities),
      effort_(effort),
      interpolations_(space.parameters()),
      at_(space.parameters() + 1),
      value_(quantities.size()),
      derivative_(at_.size() * quantities.size()),
      slope_(quantities.size()) {}

TunedResponse::State TunedResponse::solve(std::span<const double> x, double band, Derivatives derivatives) {
  const State state = solve_at(x, band, derivatives);
  if (state != State::solved || !gradient_missing_) return state;
  const double beside = band * (band > task_.band.from ? 1.0 - 1e-9 : 1.0 + 1e-9);
  return solve_at(x, beside, derivatives);
}

TunedResponse::State TunedResponse::solve_at(std::span<const double> x, double band,
                                             Derivatives derivatives) {
  for (std::size_t p = 0; p < interpolations_.size(); ++p) {
    interpolations_[p] = space_.interpolation(p, band, x);
    at_[p] = interpolations_[p].value;
  }
  at_.back() = band;
  task_.network_at(scenario_, at_, values_, derivatives == Derivatives::none ? nullptr : &directions_);
  gradient_missing_ = false;
  try {
    response_.set_values(values_);
  } catch (const mechanics::MechanicsError& error) {
    reason_ = error.what();
    return State::failed;
  }
  response_.begin_row();
  const periodic::ResponseSummary& summary = response_.solve();
  ++effort_.orbits;
  is_symmetric_ = summary.half_period;
  reason_ = summary.reason;
  if (summary.status == periodic::Status::unbounded) return State::unbounded;
  if (summary.status == periodic::Status::failed) return State::failed;
  response_.quantities(value_);
  if (derivatives != Derivatives::none) {
    ++effort_.gradients;
    const std::string why_none = differentiate(derivatives);
    gradient_missing_ = !why_none.empty();
    if (gradient_missing_) reason_ = why_none;
  }
  return State::solved;
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
    if (rate != 0.0) add(directions_[p], rate, along);
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
