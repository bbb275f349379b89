#include "solvers/response/gradient_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/mechanics/linear_system.hpp"

namespace frahm::periodic {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kFirstStep = 0.02;  // of the parameter: events of most orbits stay as they are
constexpr int kSteps = 13;           // each half of the one before; the last 5e-6: rounding weighs 1e-7

// The quantities, and behind them the counts by which sequences of events are told apart.
std::vector<Quantity> with_counts(const mechanics::Network& network, std::vector<Quantity> quantities) {
  quantities.push_back({Measure::events, 0});
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    if (network.elements[e].type != mechanics::ElementType::coulomb) continue;
    quantities.push_back({Measure::stops, e});
    quantities.push_back({Measure::reversals, e});
  }
  return quantities;
}

// What with_counts() lists, of the response from nothing known; all NaN where the values are out of range.
std::vector<double> solve_anew(PeriodicResponse& response, const mechanics::NetworkValues& values,
                               std::size_t count) {
  std::vector<double> result(count, kNone);
  try {
    response.set_values(values);
  } catch (const mechanics::MechanicsError&) {
    return result;
  }
  response.forget();
  response.solve();
  response.quantities(result);
  return result;
}

// A difference that passes a turn, of a phase, is of the angle and not of its cut.
double without_turns(double difference, Measure measure) {
  const bool is_angle =
      measure == Measure::phase || measure == Measure::element_phase || measure == Measure::peak_phase;
  return is_angle ? std::remainder(difference, 2.0 * M_PI) : difference;
}

// Of each quantity, at steps that halve.  own: what with_counts() lists, at the parameter's own value.
std::vector<std::vector<double>> central_differences(PeriodicResponse& response,
                                                     const std::vector<Quantity>& quantities,
                                                     const std::vector<double>& own,
                                                     const CheckedParameter& parameter) {
  const std::size_t count = quantities.size();
  const auto same_events = [&](const std::vector<double>& other) {
    return std::equal(own.begin() + static_cast<std::ptrdiff_t>(count), own.end(),
                      other.begin() + static_cast<std::ptrdiff_t>(count));
  };
  const double at = parameter.value, scale = at == 0.0 ? 1.0 : std::abs(at);
  std::vector<std::vector<double>> differences(count);
  for (int k = 0; k < kSteps; ++k) {
    const double step = std::ldexp(kFirstStep * scale, -k), above = at + step, below = at - step;
    const auto more = solve_anew(response, parameter.values_at(above), own.size());
    const auto less = solve_anew(response, parameter.values_at(below), own.size());
    if (!same_events(more) || !same_events(less)) continue;
    for (std::size_t i = 0; i < count; ++i) {
      const double difference = without_turns(more[i] - less[i], quantities[i].measure);
      differences[i].push_back(difference / (above - below));
    }
  }
  return differences;
}

// Central differences at steps that halve, extrapolated by Neville's scheme in the square of the step; of all
// entries that which differs least from its parents.
void extrapolate(std::span<const double> differences, DerivativeCheck& check) {
  std::vector<double> before, now;
  for (const double difference : differences) {
    now.assign(1, difference);
    double factor = 4.0;
    for (std::size_t j = 1; j <= before.size(); ++j, factor *= 4.0) {
      now.push_back((factor * now[j - 1] - before[j - 1]) / (factor - 1.0));
      const double change = std::max(std::abs(now[j] - now[j - 1]), std::abs(now[j] - before[j - 1]));
      if (std::isfinite(change) && !(change >= check.uncertainty)) {
        check.difference = now[j];
        check.uncertainty = change;
      }
    }
    before = now;
  }
}

}  // namespace

double DerivativeCheck::relative_difference() const {
  const double size = std::max(std::abs(exact), std::abs(difference));
  return size == 0.0 ? 0.0 : std::abs(exact - difference) / size;
}

GradientCheck check_gradient(const mechanics::Network& network, const std::vector<Quantity>& quantities,
                             const mechanics::NetworkValues& values,
                             std::span<const CheckedParameter> parameters) {
  const std::size_t count = quantities.size();
  const std::vector<Quantity> observed = with_counts(network, quantities);
  PeriodicResponse response(network, observed);
  response.set_values(values);
  response.solve();
  std::vector<double> own(observed.size());
  response.quantities(own);
  std::vector<mechanics::NetworkValues> directions;
  for (const CheckedParameter& parameter : parameters) directions.push_back(parameter.direction);
  std::vector<double> exact(parameters.size() * observed.size());
  GradientCheck result{response.gradient(directions, exact), {}};
  if (!result.reason.empty()) return result;

  std::vector<std::string> why_none;
  for (std::size_t i = 0; i < count; ++i) why_none.push_back(response.why_no_derivative(i));
  for (std::size_t d = 0; d < parameters.size(); ++d) {
    const auto differences = central_differences(response, quantities, own, parameters[d]);
    std::vector<DerivativeCheck>& column = result.columns.emplace_back(count);
    for (std::size_t i = 0; i < count; ++i) {
      column[i] = {exact[d * observed.size() + i], kNone, kNone, why_none[i]};
      if (why_none[i].empty()) extrapolate(differences[i], column[i]);
    }
  }
  return result;
}

}  // namespace frahm::periodic
