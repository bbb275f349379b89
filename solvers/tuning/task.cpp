#include "solvers/tuning/task.hpp"

#include <algorithm>

namespace frahm::tuning {

bool may_take_several_orbits(const mechanics::Network& network) {
  return std::ranges::any_of(network.elements, [](const mechanics::Element& element) {
    const bool bends_over_displacement = std::ranges::any_of(
        element.bends, [](const mechanics::BendPlace& bend) { return !bend.law->of_velocity; });
    return element.has_static_force || bends_over_displacement;
  });
}

}  // namespace frahm::tuning
