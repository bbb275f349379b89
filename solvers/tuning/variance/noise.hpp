#pragma once

#include <cstddef>

namespace frahm::tuning {

enum class NoiseKind {
  force_on,         // w(t) is a force on a mass [N]; the prescribed nodes rest
  acceleration_of,  // w(t) is the acceleration of a prescribed node [m/s^2]; the others rest
};

// White noise w(t) as the only excitation. `intensity` is its two-sided spectral density S_0 over the angular
// frequency, -infinity < omega < infinity [unit of w squared, per rad/s], so that E[w(t) w(t')] =
// 2 pi S_0 delta(t - t'). (A one-sided density over the frequency in Hz is 4 pi S_0.)
struct Noise {
  NoiseKind kind = NoiseKind::force_on;
  std::size_t node = 0;  // index into Network::masses or Network::prescribed
  double intensity = 1.0;
};

}  // namespace frahm::tuning
