#pragma once

#include <functional>
#include <vector>

#include "solvers/mechanics/network.hpp"
#include "solvers/tuning/task.hpp"

namespace frahm::tuning {

// The network's numbers at a place of the band (one scenario, one design).
using ValuesAt = std::function<const mechanics::NetworkValues&(double band)>;

// Places of the band from which no peak can hide (find_band_maxima): its ends, `kinks` (ascending), an even
// grid of `intervals`, and about every resonance places as close as its width.
//
// Between events the network is linear: one of the configurations with some contacts stuck and the others
// sliding. So its response is made of pieces whose poles -decay +- i omega_d are known, and friction only
// adds damping: a peak about omega_d/order is at least decay/order wide. Taken are the configurations with
// all contacts sliding, all stuck, and each alone in either state.
std::vector<double> resonance_places(const mechanics::Network& network, const ValuesAt& values_at,
                                     const Band& band, const std::vector<double>& kinks, int intervals);

}  // namespace frahm::tuning
