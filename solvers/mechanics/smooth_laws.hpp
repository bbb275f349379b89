#pragma once

#include "solvers/mechanics/network.hpp"

// Laws that are smooth and not linear: friction by arctan or by a curve over the speed, and springs with a
// cubic part. Their motion is integrated (smooth/).
namespace frahm::mechanics {

bool has_smooth_law(const Element& element);
bool has_smooth_law(const Network& network);

// Whether the force is one of the displacement, not of the velocity.
bool is_of_displacement(ForceLaw law);
// Whether the response may be one of several under it: it is not monotone, or its numbers decide.
bool may_have_several_responses(ForceLaw law);
// Whether the orbit under the exact law is near that under this one.
bool is_near_exact(ForceLaw law);

// The numbers of the element's smooth law; zero where it has none.
const SmoothValue& smooth_value(const NetworkValues& values, std::size_t element);

// Throws MechanicsError, naming element, value and rule, where the curve of a stribeck element breaks one: it
// starts at (0, 0), its speeds rise, and its forces are not negative.
void check_curve(const Element& element, const std::vector<CurvePoint>& curve);

// The friction at high speed of an element whose value is F [N]: F, or the end of its curve, where it has one.
double friction_at_high_speed(const SmoothValue& value, double F);

// Whether two motions can only come nearer to each other by these laws: no spring has a cubic part, and no
// curve falls.
bool smooth_laws_are_monotone(const Network& network, const NetworkValues& values);

}  // namespace frahm::mechanics
