#include "solvers/smooth/smooth_force.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "solvers/mechanics/smooth_laws.hpp"

namespace frahm::smooth {

// d/dv F (2/pi) arctan(slope v) = F (2/pi) slope / (1 + (slope v)^2)
ForceAndSlope Arctan::at(double v) const {
  const double steepness = slope * v, F = limit * (2.0 / std::numbers::pi);
  return {F * std::atan(steepness), F * slope / (1.0 + steepness * steepness)};
}

ForceAndSlope Cubic::at(double u) const {
  return {cubic * u * u * u, 3.0 * cubic * u * u};
}

SmoothForce::Law SmoothForce::law_of(const mechanics::Element& element, const mechanics::SmoothValue& value,
                                     double limit) {
  switch (element.law) {
    case mechanics::ForceLaw::exact:
      break;
    case mechanics::ForceLaw::arctan:
      return Arctan{limit, value.slope};
    case mechanics::ForceLaw::stribeck:
      return FrictionCurve(value.curve);
    case mechanics::ForceLaw::cubic:
      return Cubic{value.cubic};
  }
  throw std::logic_error("the exact law of '" + element.name + "' is not smooth");
}

SmoothForce::SmoothForce(const mechanics::Element& element, const mechanics::SmoothValue& value, double limit)
    : law_(law_of(element, value, limit)), is_of_velocity_(!mechanics::is_of_displacement(element.law)) {}

// cubic u^3 = u / compliance; the end of a curve.
double SmoothForce::bent_displacement(double omega, double compliance) const {
  if (const auto* spring = std::get_if<Cubic>(&law_))
    return spring->cubic != 0.0 ? 1.0 / std::sqrt(std::abs(spring->cubic) * compliance) : 0.0;
  if (const auto* curve = std::get_if<FrictionCurve>(&law_)) return curve->last_speed() / omega;
  return 0.0;
}

}  // namespace frahm::smooth
