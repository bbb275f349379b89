#pragma once

#include <algorithm>
#include <iterator>
#include <vector>

#include "solvers/branches/branch.hpp"
#include "solvers/laws/elastic_stop.hpp"
#include "tests/known_answers/single_mass.hpp"

// Networks next to that of known_answers/single_mass.hpp.
namespace frahm::periodic::one_mass {

inline const mechanics::Node ground{}, mass{mechanics::NodeKind::mass, 0};

inline mechanics::Network driven_mass() {
  mechanics::Network network = single_mass();
  network.elements.pop_back();
  return network;
}

inline mechanics::Network mass_before_a_stop() {
  mechanics::Network network = driven_mass();
  network.elements.push_back({"stops", mechanics::ElementType::gap, ground, mass});
  network.elements[2].bends = {{1.0, &laws::elastic_stop}};
  return network;
}

inline mechanics::Network mass_between_stops() {
  mechanics::Network network = mass_before_a_stop();
  network.elements[2].bends.push_back({-1.0, &laws::elastic_stop});
  return network;
}

inline mechanics::Network held_mass() {  // its friction has a static force
  mechanics::Network network = single_mass();
  network.elements[2].has_static_force = true;
  return network;
}

inline std::vector<SpecialPoint> of_kind(const Branch& branch, SpecialKind kind) {
  std::vector<SpecialPoint> found;
  std::ranges::copy_if(branch.special, std::back_inserter(found),
                       [kind](const SpecialPoint& each) { return each.kind == kind; });
  return found;
}

}  // namespace frahm::periodic::one_mass
