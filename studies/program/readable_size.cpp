#include "studies/program/readable_size.hpp"

#include <fmt/format.h>

namespace frahm::studies {

std::string readable_size(double bytes) {
  for (const char* unit : {"bytes", "kB", "MB", "GB"}) {
    if (bytes < 999.5) return fmt::format("{:.3g} {}", bytes, unit);
    bytes /= 1000.0;
  }
  return fmt::format("{:.3g} TB", bytes);
}

}  // namespace frahm::studies
