#pragma once

namespace frahm::periodic {

// All relative tolerances of switching.
//   kRest  a contact is at rest below this part of its velocity scale (workspace.hpp), of which the rounding
//          of a passage is 1e-13
//   kTie   between sticking and sliding: ties go to sticking, else zero-length slips would chatter for ever
//   kSameInstant  steps, relative to the time on the clock: what follows an event by less is at its instant,
//          as the clock's own rounding is of this size
inline constexpr double kRest = 1e-11;
inline constexpr double kTie = 1e-12;
inline constexpr double kSameInstant = 1e-15;

}  // namespace frahm::periodic
