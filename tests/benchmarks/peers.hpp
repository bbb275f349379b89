#pragma once

#include "solvers/mechanics/network.hpp"

// What is used instead today: integration of the smoothed law F (2/pi) arctan(1e5 v) to a steady state by
// Boost.odeint's dopri5, until the peak changes by less than `settled` from one period to the next. Peak of
// the first mass.
namespace frahm::benchmarks {

struct PeerAccuracy {
  double relative = 1e-3, absolute = 1e-6;  // tolerances; absolute: of the excitation
  double settled = 1e-4;
};

double one_mass_peak(const mechanics::NetworkValues& values, const PeerAccuracy& accuracy);  // of one_mass()
double rig_peak(const mechanics::NetworkValues& values, const PeerAccuracy& accuracy);       // of rig()

}  // namespace frahm::benchmarks
