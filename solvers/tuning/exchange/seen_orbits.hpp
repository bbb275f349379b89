#pragma once

#include <map>
#include <vector>

#include "solvers/orbits/known_orbit.hpp"

namespace frahm::tuning {

// Stable orbits that a tuning has found, by their place in the band, whatever the design: the search at a
// place near them looks there first. So a branch of large responses that few starts reach is not lost from
// one frequency, or one design, to the next.
class SeenOrbits {
 public:
  // Replaces what was found at the same place.
  void keep(double band, std::vector<periodic::KnownOrbit> orbits);
  // Those of the nearest places, on both sides.
  std::vector<periodic::KnownOrbit> near(double band) const;

 private:
  struct AtPlace {
    std::vector<periodic::KnownOrbit> orbits;  // at least one
    unsigned long age = 0;                     // number of the call that kept it
  };
  std::map<double, AtPlace> places_;
  unsigned long calls_ = 0;
};

}  // namespace frahm::tuning
