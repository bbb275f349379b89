#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "solvers/response/periodic_response.hpp"

namespace frahm::periodic {

// A parameter on which the network's values depend.
struct CheckedParameter {
  double value = 0.0;                                              // in its SI unit
  mechanics::NetworkValues direction;                              // derivative of the network's values by it
  std::function<mechanics::NetworkValues(double)> values_at = {};  // the network's values at another value
};

// The derivative of one quantity by one parameter, twice.
struct DerivativeCheck {
  double exact = 0.0;        // NaN: no derivative, see why_none
  double difference = 0.0;   // by central differences; NaN: none could be taken
  double uncertainty = 0.0;  // of the difference: what its extrapolation last changed, and noise
  std::string why_none = {};

  // |exact - difference| over the larger of both; 0 where both are zero.
  double relative_difference() const;
};

struct GradientCheck {
  std::string reason;                                 // why there are no derivatives at all; otherwise empty
  std::vector<std::vector<DerivativeCheck>> columns;  // of each parameter, of each quantity; empty then
};

// What stands next to the exact derivatives: central differences, or NaN in their place.
enum class CheckedBy { differences, nothing };

// The exact derivatives of the quantities at the periodic response of `values`, and central differences
// next to them. The responses on both sides are solved without known orbits, at steps from 2 % of the
// parameter (of 1 where it is zero) down to 5e-6 of it, extrapolated to zero (C. Ridders, Adv. Eng. Software
// 4 (1982) 75); steps at which other events occur are left out. Differences are refused where the exact
// derivative is: at grazing a central difference is the mean of two derivatives.
// Throws mechanics::MechanicsError where `values` are out of range; on either side such a step is left out.
GradientCheck check_gradient(const mechanics::Network& network, const std::vector<Quantity>& quantities,
                             const mechanics::NetworkValues& values,
                             std::span<const CheckedParameter> parameters,
                             CheckedBy by = CheckedBy::differences);

}  // namespace frahm::periodic
