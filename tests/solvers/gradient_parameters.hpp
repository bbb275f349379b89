#pragma once

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "solvers/response/gradient_check.hpp"

// The numbers of a network as parameters of a gradient check, for tests.
namespace frahm::periodic {

struct NamedParameter {
  std::string name;
  CheckedParameter parameter;
};

inline mechanics::NetworkValues zero_direction(const mechanics::NetworkValues& values) {
  mechanics::NetworkValues zero;
  zero.mass.resize(values.mass.size());
  zero.element.resize(values.element.size());
  zero.second.resize(values.second.size());
  for (const auto& bends : values.bends) zero.bends.emplace_back(bends.size());
  zero.damping.resize(values.damping.size());
  zero.excitation.resize(values.excitation.size());
  return zero;
}

// The number that `place` picks out of the values.
template <class Place>
NamedParameter named_parameter(std::string name, const mechanics::NetworkValues& values, Place place) {
  mechanics::NetworkValues at = values, direction = zero_direction(values);
  place(direction) = 1.0;
  const auto values_at = [values, place](double x) {
    mechanics::NetworkValues changed = values;
    place(changed) = x;
    return changed;
  };
  return {std::move(name), {place(at), direction, values_at}};
}

// The frequency, and every number that is not zero, of masses, elements, their bends and excitations.
inline std::vector<NamedParameter> all_parameters(const mechanics::Network& network,
                                                  const mechanics::NetworkValues& values) {
  using mechanics::NetworkValues;
  std::vector<NamedParameter> list;
  const auto add = [&](std::string name, auto place) {
    NamedParameter parameter = named_parameter(std::move(name), values, place);
    if (parameter.parameter.value != 0.0) list.push_back(std::move(parameter));
  };
  add("omega", [](NetworkValues& v) -> double& { return v.omega; });
  for (std::size_t i = 0; i < values.mass.size(); ++i) {
    add("mass of " + network.masses[i], [i](NetworkValues& v) -> double& { return v.mass[i]; });
  }
  for (std::size_t e = 0; e < values.element.size(); ++e) {
    add(network.elements[e].name, [e](NetworkValues& v) -> double& { return v.element[e]; });
    if (e >= values.second.size()) continue;
    add(network.elements[e].name + " second", [e](NetworkValues& v) -> double& { return v.second[e]; });
  }
  for (std::size_t e = 0; e < values.bends.size(); ++e) {
    for (std::size_t i = 0; i < values.bends[e].size(); ++i) {
      const std::string name = network.elements[e].name + " bend " + std::to_string(i);
      add(name + " place", [e, i](NetworkValues& v) -> double& { return v.bends[e][i].place; });
      add(name + " stiffness", [e, i](NetworkValues& v) -> double& { return v.bends[e][i].stiffness; });
      add(name + " damping", [e, i](NetworkValues& v) -> double& { return v.bends[e][i].damping; });
    }
  }
  for (std::size_t i = 0; i < values.damping.size(); ++i) {
    add("damping " + std::to_string(i), [i](NetworkValues& v) -> double& { return v.damping[i]; });
  }
  for (std::size_t k = 0; k < values.excitation.size(); ++k) {
    const std::string name = "excitation " + std::to_string(k);
    add(name + " amplitude", [k](NetworkValues& v) -> double& { return v.excitation[k].amplitude; });
    add(name + " phase", [k](NetworkValues& v) -> double& { return v.excitation[k].phase; });
    add(name + " rod", [k](NetworkValues& v) -> double& { return v.excitation[k].rod; });
  }
  return list;
}

// Checks every derivative against a difference, by a relative tolerance or by the difference's own
// uncertainty.
inline void check_derivatives(const mechanics::Network& network, const std::vector<Quantity>& quantities,
                              const mechanics::NetworkValues& values, double tolerance) {
  std::vector<CheckedParameter> parameters;
  for (const NamedParameter& named : all_parameters(network, values)) parameters.push_back(named.parameter);
  const GradientCheck check = check_gradient(network, quantities, values, parameters);
  INFO("omega " << values.omega << " " << check.reason);
  REQUIRE(check.reason.empty());
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    for (std::size_t q = 0; q < quantities.size(); ++q) {
      const DerivativeCheck& each = check.columns[p][q];
      INFO("parameter " << p << " quantity " << q << ": " << each.exact << " against " << each.difference);
      const bool agrees = each.relative_difference() < tolerance ||
                          std::abs(each.exact - each.difference) < 10.0 * each.uncertainty + 1e-9;
      CHECK(agrees);
    }
  }
}

}  // namespace frahm::periodic
