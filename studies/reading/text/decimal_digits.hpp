#pragma once

namespace frahm::studies {

// A number to so many significant decimal digits: 0.1 + 0.2 to 6 digits is 0.3. Also of the smallest numbers,
// at which std::stod throws.
double to_digits(double value, int digits);

}  // namespace frahm::studies
