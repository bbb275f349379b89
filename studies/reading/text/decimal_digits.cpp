#include "studies/reading/text/decimal_digits.hpp"

#include <fmt/format.h>

#include <cstdlib>

namespace frahm::studies {

double to_digits(double value, int digits) {
  return std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr);
}

}  // namespace frahm::studies
