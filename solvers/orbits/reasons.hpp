#pragma once

#include <string>

// Why there is no periodic orbit: plain sentences for rows of a map and for points.
namespace frahm::periodic {

inline constexpr const char* kTooManySteps =
    "the excitation is too slow, or the system too stiff: more than 200000 steps a period";
inline constexpr const char* kUnresolved =
    "the response is so much larger than the static one that rounding hides the forces";
inline constexpr const char* kUnbounded =
    "an undamped mode is driven at its resonance, and no friction holds it";

// The search ended after this many passages with this residual.
std::string no_convergence(int passages, double residual);
// For so many starts none led to a stable orbit of up to this multiple of the period.
std::string none_stable(int starts, int most_multiple, bool found_unstable);
// The motion that was followed for so many periods came to none.
std::string not_settled(int periods, int most_multiple);
// The energies put in and dissipated in a period differ by this fraction.
std::string unbalanced(double balance);
// The same over a motion, relative to the largest of them.
std::string unbalanced_motion(double balance);

}  // namespace frahm::periodic
