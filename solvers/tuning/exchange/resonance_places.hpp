#pragma once

#include <functional>
#include <vector>

#include "solvers/mechanics/network.hpp"
#include "solvers/tuning/task.hpp"

namespace frahm::tuning {

// The network's numbers at a point of the band (one scenario, one design).
using ValuesAt = std::function<const mechanics::NetworkValues&(double band)>;

// How densely they lie.
struct PlacesFineness {
  int intervals = 1;      // of the even grid
  double nearest = 1e-7;  // to a resonance, of an interval
};

// Points of the band between which no peak is missed (find_band_maxima): its ends, `kinks` (ascending), an
// even grid, and points at and about every resonance as close as its width, but not nearer than told.
//
// Between events the network is linear: one of the configurations with some contacts stuck and the others
// sliding. So its response is made of pieces whose poles -decay +- i omega_d are known, and friction only
// adds damping: a peak about omega_d/order is at least decay/order wide. The configurations used are all
// contacts sliding, all stuck, and each alone in either state. Of elements that bend over their displacement,
// also with all bends of one side passed; but a peak of theirs may lie anywhere between, and be narrower.
std::vector<double> resonance_places(const mechanics::Network& network, const ValuesAt& values_at,
                                     const Band& band, const std::vector<double>& kinks,
                                     const PlacesFineness& fineness);

}  // namespace frahm::tuning
