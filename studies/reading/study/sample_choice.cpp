#include "studies/reading/study/sample_choice.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace frahm::studies {

std::string quantile_name(double share) {
  std::string name = fmt::format("q{:.6g}", 100.0 * share);
  std::ranges::replace(name, '.', '_');
  return name;
}

}  // namespace frahm::studies
