#pragma once

#include "solvers/laws/law.hpp"

namespace frahm::laws {

// A spring k_t in series with a slider of limit F: Jenkins's element, one Prandtl body. The displacement
// across it is that of the spring and of the slider, u = s/k_t + u_slider, and its force s is the spring's:
//
//   s' = k_t u'   while |s| < F, or while u' takes |s| down again  (the slider sticks)
//   s  = F sgn u'                                                  (it slides, s' = 0)
//
// So it is a Maxwell element with a slider for its damper: one internal force, and while it sticks the
// network is as stiff as with the spring alone, since u' is free. s is continuous: where u' reaches zero the
// slider sticks at +-F and the spring unloads, regardless of the other contacts: no choice is needed at rest.
// A whole cycle of amplitude X > F/k_t takes the energy 4 F (X - F/k_t); below F/k_t it is a spring. For k_t
// -> infinity it is Coulomb's law, for F -> infinity the spring.
//
// For two motions 1 and 2, (s_1 - s_2)(u_1' - u_2') >= d/dt (s_1 - s_2)^2/(2 k_t): the sliders only take
// energy from the difference, so the distance of the energy norm with (s_1 - s_2)^2/k_t never grows. So the
// element has every guarantee of a monotone law. A slider that never slides leaves a family of orbits, which
// differ in the constant part of s.
inline constexpr Law jenkins{.name = "jenkins", .holds_velocity = false, .merges = false};

}  // namespace frahm::laws
