#pragma once

namespace frahm::periodic {

// All relative tolerances of switching.
//   kRest  a contact is at rest below this part of its velocity scale (workspace.hpp), of which the rounding
//          of a passage is 1e-13
//   kTie   between sticking and sliding: ties go to sticking, otherwise zero-length slips would chatter for
//   ever kSameInstant  steps: what follows an event by less, or by the rounding of the clock, is at its
//   instant, as
//          that is what the rounding of a passage makes of two events at one instant
inline constexpr double kRest = 1e-11;
inline constexpr double kTie = 1e-12;
inline constexpr double kSameInstant = 1e-13;

}  // namespace frahm::periodic
