#pragma once

namespace frahm::tuning {

// The objective of an optimisation.
struct Goal {
  enum class Of {
    worst,          // t, the worst weighted response at the active frequencies (epigraph)
    mean_square,    // of the weighted response over the band
    mean_response,  // over the band, with the worst response held under `held`
    variance,       // under white noise
    violation,      // t, the largest of the limits' curves at the active frequencies (epigraph): 1 just meets
                    // them
  };
  Of of = Of::worst;
  double held = 0.0;

  bool is_epigraph() const { return of == Of::worst || of == Of::violation; }
};

}  // namespace frahm::tuning
