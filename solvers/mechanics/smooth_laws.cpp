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

// Whether two motions can only come nearer to each other by this law: its force is one of the velocity that
// never falls, or zero.
bool is_monotone(ForceLaw law, const SmoothValue& value) {
  switch (law) {
    case ForceLaw::exact:
    case ForceLaw::arctan:
      return true;
    case ForceLaw::stribeck:
      return never_falls(value.curve);
    case ForceLaw::cubic:
      return value.cubic == 0.0;
  }
  return false;
}

}  // namespace

bool has_smooth_law(const Element& element) {
  return element.law != ForceLaw::exact;
}

bool is_of_displacement(ForceLaw law) {
  switch (law) {
    case ForceLaw::exact:
    case ForceLaw::arctan:
    case ForceLaw::stribeck:
      return false;
    case ForceLaw::cubic:
      return true;
  }
  return false;
}

bool may_have_several_responses(ForceLaw law) {
  switch (law) {
    case ForceLaw::exact:
    case ForceLaw::arctan:
      return false;
    case ForceLaw::stribeck:
    case ForceLaw::cubic:
      return true;
  }
  return false;
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
    case ForceLaw::exact:
    case ForceLaw::arctan:
    case ForceLaw::cubic:
      return F;
    case ForceLaw::stribeck:
      return value.curve.back().force;
  }
  return F;
}

bool smooth_laws_are_monotone(const Network& network, const NetworkValues& values) {
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    const SmoothValue& value = smooth_value(values, e);
    if (!is_monotone(network.elements[e].law, value)) return false;
  }
  return true;
}

}  // namespace frahm::mechanics
