#include "solvers/mechanics/smooth_laws.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

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

// What is known of a law before its numbers are.
struct LawFacts {
  bool is_of_displacement;  // its force, and not of the velocity
  bool may_have_several_responses;
  bool is_near_exact;  // its orbit is near that under the exact law
};

LawFacts facts_of(ForceLaw law) {
  switch (law) {
    case ForceLaw::exact:
      return {.is_of_displacement = false, .may_have_several_responses = false, .is_near_exact = true};
    case ForceLaw::arctan:
      return {.is_of_displacement = false, .may_have_several_responses = false, .is_near_exact = true};
    case ForceLaw::stribeck:
      return {.is_of_displacement = false, .may_have_several_responses = true, .is_near_exact = false};
    case ForceLaw::cubic:
      return {.is_of_displacement = true, .may_have_several_responses = true, .is_near_exact = false};
  }
  throw std::logic_error("a law without a row");
}

// Whether two motions can only come nearer to each other by this law: its force is one of the velocity that
// never falls, or zero.
bool is_monotone(ForceLaw law, const SmoothValue& value) {
  if (!may_have_several_responses(law)) return true;
  if (!is_of_displacement(law)) return never_falls(value.curve);
  return std::ranges::all_of(smooth_numbers, [&](const auto number) { return value.*number == 0.0; });
}

}  // namespace

bool has_smooth_law(const Element& element) {
  return element.law != ForceLaw::exact;
}

bool is_of_displacement(ForceLaw law) {
  return facts_of(law).is_of_displacement;
}

bool may_have_several_responses(ForceLaw law) {
  return facts_of(law).may_have_several_responses;
}

bool is_near_exact(ForceLaw law) {
  return facts_of(law).is_near_exact;
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

double friction_at_high_speed(const SmoothValue& value, double F) {
  return value.curve.empty() ? F : value.curve.back().force;
}

bool smooth_laws_are_monotone(const Network& network, const NetworkValues& values) {
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    const SmoothValue& value = smooth_value(values, e);
    if (!is_monotone(network.elements[e].law, value)) return false;
  }
  return true;
}

}  // namespace frahm::mechanics
