#pragma once

#include "solvers/mechanics/network.hpp"

// A network and its values under the law F (2/pi) arctan(slope v) in place of Coulomb's.
namespace frahm::periodic {

inline mechanics::Network under_arctan(mechanics::Network network) {
  for (mechanics::Element& element : network.elements) {
    if (element.type == mechanics::ElementType::coulomb) element.law = mechanics::ForceLaw::arctan;
  }
  return network;
}

// slope [s/m] of every element; those of another law do not read it.
inline mechanics::NetworkValues with_slope(mechanics::NetworkValues values, double slope) {
  values.smooth.assign(values.element.size(), {.slope = slope});
  return values;
}

}  // namespace frahm::periodic
