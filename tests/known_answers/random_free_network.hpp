#pragma once

#include "tests/known_answers/random_network.hpp"

namespace frahm::periodic {

// Springs to the ground and one within the chain are taken away.
inline RandomNetwork without_some_springs(const RandomNetworkOptions& options, int free, bool keeps_dampers,
                                          std::mt19937& random) {
  RandomNetwork drawn = random_network(options, random);
  const auto n = static_cast<std::size_t>(options.masses);
  const auto take = [&](std::size_t spring) {
    drawn.values.element[spring] = 0.0;
    if (!keeps_dampers && drawn.network.elements[spring + 1].type == mechanics::ElementType::damper)
      drawn.values.element[spring + 1] = 0.0;
  };
  take(0);
  if (n > 1) take(2 * n);
  if (free == 2) take(2 * (n / 2));
  return drawn;
}

}  // namespace frahm::periodic
