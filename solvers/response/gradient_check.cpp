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

// The quantities of the response from nothing known; all NaN where the values are out of range.
std::vector<double> quantities_at(PeriodicResponse& response, const mechanics::NetworkValues& values,
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

// Central differences at steps that halve, extrapolated by Neville's scheme in the square of the step; of all
// entries that which differs least from its parents.
void extrapolate(std::span<const double> differences, DerivativeCheck& check) {
  check.difference = check.uncertainty = kNone;
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
  PeriodicResponse response(network, quantities);
  response.set_values(values);
  response.solve();
  std::vector<mechanics::NetworkValues> directions;
  for (const CheckedParameter& parameter : parameters) directions.push_back(parameter.direction);
  std::vector<double> exact(parameters.size() * count);
  GradientCheck result{response.gradient(directions, exact), {}};
  if (!result.reason.empty()) return result;

  std::vector<std::string> why_none;
  for (std::size_t i = 0; i < count; ++i) why_none.push_back(response.why_no_derivative(i));
  for (std::size_t d = 0; d < parameters.size(); ++d) {
    const double at = parameters[d].value, scale = at == 0.0 ? 1.0 : std::abs(at);
    std::vector<std::vector<double>> differences(count);
    for (int k = 0; k < kSteps; ++k) {
      const double step = std::ldexp(kFirstStep * scale, -k);
      const double above = at + step, below = at - step;
      const auto more = quantities_at(response, parameters[d].values_at(above), count);
      const auto less = quantities_at(response, parameters[d].values_at(below), count);
      for (std::size_t i = 0; i < count; ++i) {
        const double difference = without_turns(more[i] - less[i], quantities[i].measure);
        differences[i].push_back(difference / (above - below));
      }
    }
    std::vector<DerivativeCheck>& column = result.columns.emplace_back(count);
    for (std::size_t i = 0; i < count; ++i) {
      column[i].exact = exact[d * count + i];
      column[i].why_none = why_none[i];
      if (why_none[i].empty()) extrapolate(differences[i], column[i]);
      if (!why_none[i].empty()) column[i].difference = column[i].uncertainty = kNone;
    }
  }
  return result;
}

}  // namespace frahm::periodic
