#include "solvers/tuning/exchange/tuned_response.hpp"

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/orbits/orbit.hpp"

namespace frahm::tuning {

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
      derivative_(at_.size() * quantities.size()) {}

TunedResponse::State TunedResponse::solve(std::span<const double> x, double band, bool with_derivatives) {
  const State state = solve_at(x, band, with_derivatives);
  if (state != State::solved || !gradient_missing_) return state;
  const double beside = band * (band > task_.band.from ? 1.0 - 1e-9 : 1.0 + 1e-9);
  return solve_at(x, beside, true);
}

TunedResponse::State TunedResponse::solve_at(std::span<const double> x, double band, bool with_derivatives) {
  for (std::size_t p = 0; p < interpolations_.size(); ++p) {
    interpolations_[p] = space_.interpolation(p, band, x);
    at_[p] = interpolations_[p].value;
  }
  at_.back() = band;
  task_.network_at(scenario_, at_, values_, with_derivatives ? &directions_ : nullptr);
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
  if (with_derivatives) {
    ++effort_.gradients;
    const std::string why_none = response_.gradient(directions_, derivative_);
    gradient_missing_ = !why_none.empty();
    if (gradient_missing_) reason_ = why_none;
  }
  return State::solved;
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
