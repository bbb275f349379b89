#pragma once

#include <cstdint>

#include "solvers/mechanics/network.hpp"

// Networks drawn at random over everything that a study may hold: loops of contacts, light masses on stiff
// springs, all but no damping, tiny and huge friction, high orders, Maxwell and hysteretic elements, supports
// that shake.
namespace frahm::invariants {

struct Case {
  std::uint64_t seed = 0;
  mechanics::Network network;
  mechanics::NetworkValues values;
};

// The network of a seed. Values have two digits, so that it is short to write down.
Case draw(std::uint64_t seed);

}  // namespace frahm::invariants
