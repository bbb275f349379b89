#include "solvers/response/gradient_check.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "solvers/orbits/orbit.hpp"

namespace frahm::periodic {
namespace {

constexpr double kFirstStep = 0.02;  // of the parameter: at most orbits the events do not change
constexpr int kSteps = 13;           // each half of the one before; the last 5e-6: rounding weighs 1e-7

// The states of the contacts, one after the other over a period, from any start of the period.
using Sequence = std::vector<std::vector<std::string>>;
Sequence sequence_of(const PeriodicResponse& response) {
  Sequence sequence;
  for (const Stretch& stretch : response.stretches()) {
    if (sequence.empty() || stretch.contacts != sequence.back()) sequence.push_back(stretch.contacts);
  }
  if (sequence.size() > 1 && sequence.back() == sequence.front()) sequence.pop_back();
  Sequence least = sequence;
  for (std::size_t i = 1; i < sequence.size(); ++i) {
    std::rotate(sequence.begin(), sequence.begin() + 1, sequence.end());
    least = std::min(least, sequence);
  }
  return least;
}

// The quantities of the response; all NaN if the values are out of range, or the events are not `events`.
// again: the search starts without known orbits.
std::vector<double> solve(PeriodicResponse& response, const mechanics::NetworkValues& values, bool anew,
                          const Sequence& events, std::size_t count) {
  std::vector<double> result(count, kNone);
  try {
    response.set_values(values);
  } catch (const mechanics::MechanicsError&) {
    return result;
  }
  if (anew) response.forget();
  const Status status = response.solve().status;
  const bool found = status == Status::ok || status == Status::grazing || status == Status::several;
  if (found && sequence_of(response) == events) response.quantities(result);
  return result;
}

// The difference of a phase across a full turn is that of the angle.
double without_turns(double difference, Measure measure) {
  return is_angle(measure) ? std::remainder(difference, 2.0 * M_PI) : difference;
}

struct Difference {
  double step = 0.0, value = 0.0;
  double noise = 0.0;  // change of the quantity when its search starts elsewhere
};
using Differences = std::vector<Difference>;  // of one quantity, at steps that halve

// For each quantity. own: the events at the parameter's own value.
std::vector<Differences> central_differences(PeriodicResponse& response,
                                             const std::vector<Quantity>& quantities, const Sequence& own,
                                             const CheckedParameter& parameter) {
  const std::size_t count = quantities.size();
  const double at = parameter.value, scale = at == 0.0 ? 1.0 : std::abs(at);
  std::vector<Differences> result(count);
  for (int k = 0; k < kSteps; ++k) {
    const double step = std::ldexp(kFirstStep * scale, -k), above = at + step, below = at - step;
    const auto more = solve(response, parameter.values_at(above), true, own, count);
    const auto less = solve(response, parameter.values_at(below), true, own, count);
    const auto again = solve(response, parameter.values_at(above), false, own, count);
    for (std::size_t i = 0; i < count; ++i) {
      const double change = without_turns(more[i] - less[i], quantities[i].measure);
      if (!std::isfinite(change)) continue;
      const double noise = std::abs(without_turns(more[i] - again[i], quantities[i].measure));
      result[i].push_back({step, change / (above - below), noise});
    }
  }
  return result;
}

// How far the difference over the shortest step may be off, by the one before. Longer steps may have passed a
// kink: what is extrapolated from them has to lie within.
double uncertainty_of_shortest(std::span<const Difference> differences) {
  constexpr double kWide = 4.0;
  if (differences.size() < 2) return kNone;
  const Difference &last = differences.back(), &before = differences[differences.size() - 2];
  return kWide * (std::abs(last.value - before.value) + last.noise / last.step);
}

// Neville's scheme in the square of the step; the result is the entry that differs least from its parents.
// noise: of the quantity itself, at least; a difference over a short step magnifies it.
void extrapolate(std::span<const Difference> differences, double noise, DerivativeCheck& check) {
  check.difference = check.uncertainty = kNone;
  if (differences.empty()) return;
  const Difference shortest = differences.back();
  const double within = uncertainty_of_shortest(differences);
  if (std::isfinite(within)) {
    check.difference = shortest.value;
    check.uncertainty = within + noise / shortest.step;
  }
  std::vector<double> before, now;
  for (const auto& [step, difference, own_noise] : differences) {
    now.assign(1, difference);
    double factor = 4.0;
    for (std::size_t j = 1; j <= before.size(); ++j, factor *= 4.0) {
      now.push_back((factor * now[j - 1] - before[j - 1]) / (factor - 1.0));
      const double change = std::max(noise, own_noise) / step +
                            std::max(std::abs(now[j] - now[j - 1]), std::abs(now[j] - before[j - 1]));
      if (std::isfinite(change) && !(change >= check.uncertainty) &&
          !(std::abs(now[j] - shortest.value) > within)) {
        check.difference = now[j];
        check.uncertainty = change;
      }
    }
    before = now;
  }
}

// The error of the differences over the shortest steps is the noise of the quantity over the step.
double noise_of(std::span<const Difference> differences, double derivative) {
  constexpr std::size_t kShortest = 4;
  double noise = 0.0;
  const std::size_t from = differences.size() > kShortest ? differences.size() - kShortest : 0;
  for (const Difference& each : differences.subspan(from)) {
    const double off = each.step * std::abs(each.value - derivative);
    if (std::isfinite(off)) noise = std::max(noise, off);
  }
  return noise;
}

}  // namespace

double DerivativeCheck::relative_difference() const {
  const double size = std::max(std::abs(exact), std::abs(difference));
  return size == 0.0 ? 0.0 : std::abs(exact - difference) / size;
}

GradientCheck check_gradient(const mechanics::Network& network, const std::vector<Quantity>& quantities,
                             const mechanics::NetworkValues& values,
                             std::span<const CheckedParameter> parameters, CheckedBy by) {
  const std::size_t count = quantities.size();
  PeriodicResponse response(network, quantities);
  response.set_values(values);
  response.solve();
  std::vector<mechanics::NetworkValues> directions;
  for (const CheckedParameter& parameter : parameters) directions.push_back(parameter.direction);
  std::vector<double> exact(parameters.size() * count);
  GradientCheck result{response.gradient(directions, exact), {}};
  if (!result.reason.empty()) return result;

  const Sequence own = sequence_of(response);
  std::vector<std::string> why_none;
  for (std::size_t i = 0; i < count; ++i) why_none.push_back(response.why_no_derivative(i));
  for (std::size_t d = 0; d < parameters.size(); ++d) {
    std::vector<DerivativeCheck>& column = result.columns.emplace_back(count);
    for (std::size_t i = 0; i < count; ++i) column[i] = {exact[d * count + i], kNone, kNone, why_none[i]};
    if (by == CheckedBy::nothing) continue;
    const auto differences = central_differences(response, quantities, own, parameters[d]);
    for (std::size_t i = 0; i < count; ++i) {
      if (!why_none[i].empty()) continue;
      extrapolate(differences[i], 0.0, column[i]);
      extrapolate(differences[i], noise_of(differences[i], column[i].difference), column[i]);
    }
  }
  return result;
}

}  // namespace frahm::periodic
