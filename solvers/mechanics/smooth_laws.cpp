#include "solvers/mechanics/smooth_laws.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "solvers/mechanics/linear_system.hpp"

namespace frahm::mechanics {
namespace {

void require(bool is_met, const Element& element, const char* key, double value, const char* rule) {
  if (is_met) return;
  std::ostringstream message;
  message << key << " of '" << element.name << "' = " << value << ": " << rule;
  throw MechanicsError(message.str());
}

bool never_falls(const std::vector<CurvePoint>& curve) {
  return std::ranges::is_sorted(curve, {}, &CurvePoint::force);
}

// Whether the smooth force of a spring is not zero.
bool adds_a_force(const SmoothValue& value) {
  return std::ranges::any_of(smooth_numbers, [&](auto number) { return value.*number != 0.0; });
}

// Whether the force of a law of friction never falls with the speed.
bool rises(FrictionLaw law, const SmoothValue& value) {
  switch (law) {
    case FrictionLaw::exact:
    case FrictionLaw::arctan:
      return true;
    case FrictionLaw::stribeck:
      return never_falls(value.curve);
  }
  return false;
}

}  // namespace

bool has_smooth_law(const Element& element) {
  const bool rubs_smoothly = element.type == ElementType::coulomb && element.law != FrictionLaw::exact;
  return rubs_smoothly || element.has_smooth_spring;
}

bool has_smooth_law(const Network& network) {
  return std::ranges::any_of(network.elements, [](const Element& each) { return has_smooth_law(each); });
}

const SmoothValue& smooth_value(const NetworkValues& values, std::size_t element) {
  static const SmoothValue none;
  return element < values.smooth.size() ? values.smooth[element] : none;
}

void check_curve(const Element& element, const std::vector<CurvePoint>& curve) {
  const char* table = "a point of the table";
  const auto count = static_cast<double>(curve.size());
  require(curve.size() >= 2, element, "points of the table", count, "must be at least two");
  require(curve.front() == CurvePoint{}, element, table, curve.front().force, "the first must be [0, 0]");
  for (std::size_t i = 1; i < curve.size(); ++i) {
    const auto [speed, force] = curve[i];
    require(std::isfinite(speed) && speed > curve[i - 1].speed, element, table, speed, "must rise");
    require(std::isfinite(force) && force >= 0.0, element, table, force, "must not be negative");
  }
}

double friction_at_high_speed(const Element& element, const SmoothValue& value, double F) {
  switch (element.law) {
    case FrictionLaw::exact:
    case FrictionLaw::arctan:
      return F;
    case FrictionLaw::stribeck:
      return value.curve.back().force;
  }
  return F;
}

bool smooth_laws_are_monotone(const Network& network, const NetworkValues& values) {
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    const SmoothValue& value = smooth_value(values, e);
    if (network.elements[e].has_smooth_spring && adds_a_force(value)) return false;
    if (!rises(network.elements[e].law, value)) return false;
  }
  return true;
}

}  // namespace frahm::mechanics
