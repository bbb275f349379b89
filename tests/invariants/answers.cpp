#include "tests/invariants/answers.hpp"

#include <cmath>
#include <exception>
#include <limits>

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/orbits/orbit.hpp"
#include "solvers/response/periodic_response.hpp"

namespace frahm::invariants {
namespace {

using mechanics::NetworkValues;
using periodic::PeriodicResponse;

Answer refused(const std::exception& error) {
  Answer result;
  result.reason = error.what();
  return result;
}

Answer told(PeriodicResponse& response, const Case& asked,
            const std::vector<periodic::Quantity>& quantities) {
  Answer result;
  const periodic::ResponseSummary& summary = response.solve();
  result.status = static_cast<int>(summary.status);
  result.reason = summary.reason;
  std::vector<double> values(quantities.size());
  response.quantities(values);
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    const auto description = describe(quantities[i], asked.network, false);
    result.figures.push_back({description.name, description.unit, quantities[i], values[i]});
  }
  if (!result.has_response()) return result;
  const periodic::History history = response.history(periodic::phases_of_a_period(65));
  for (std::size_t i = 0; i < asked.network.masses.size(); ++i)
    result.displacements.push_back(history.columns[2 * i]);
  return result;
}

NetworkValues at_share_of_frequency(NetworkValues values, double share) {
  values.omega *= share;
  return values;
}

// Ten frequencies from 0.9 of the last.
void sweep(PeriodicResponse& response, const NetworkValues& values) {
  constexpr int kSteps = 10;
  response.set_values(at_share_of_frequency(values, 0.9));
  for (int i = 0; i < kSteps; ++i) {
    response.set_forcing(at_share_of_frequency(values, 0.9 + 0.1 * i / kSteps));
    response.solve();
  }
  response.set_forcing(values);
}

}  // namespace

double factor_of(const std::string& unit, const Factors& f) {
  if (unit == "m") return f.length;
  if (unit == "m s-1") return f.length / f.time;
  if (unit == "m s-2") return f.length / (f.time * f.time);
  if (unit == "N") return f.force;
  if (unit == "J") return f.force * f.length;
  if (unit == "rad s-1") return 1.0 / f.time;
  return 1.0;
}

const Figure* Answer::find(const std::string& name) const {
  for (const Figure& figure : figures) {
    if (figure.name == name) return &figure;
  }
  return nullptr;
}

double Answer::operator[](const std::string& name) const {
  const Figure* figure = find(name);
  return figure != nullptr ? figure->value : std::numeric_limits<double>::quiet_NaN();
}

Answer answer(const Case& asked) try {
  const auto quantities = periodic::all_quantities(asked.network);
  PeriodicResponse response(asked.network, quantities);
  response.set_values(asked.values);
  return told(response, asked, quantities);
} catch (const mechanics::MechanicsError& error) {
  return refused(error);
}

Answer answer_of_sweep(const Case& asked) try {
  const auto quantities = periodic::all_quantities(asked.network);
  PeriodicResponse response(asked.network, quantities);
  NetworkValues row_before = asked.values;
  for (std::size_t e = 0; e < row_before.element.size(); ++e) {
    if (asked.network.elements[e].type == mechanics::ElementType::coulomb) row_before.element[e] *= 1.1;
  }
  response.begin_row();
  sweep(response, row_before);
  response.solve();
  response.begin_row();
  sweep(response, asked.values);
  return told(response, asked, quantities);
} catch (const mechanics::MechanicsError& error) {
  return refused(error);
}

}  // namespace frahm::invariants
