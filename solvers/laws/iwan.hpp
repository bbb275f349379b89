#pragma once

#include <cmath>
#include <vector>

// A joint as many springs in series with sliders (laws/jenkins.hpp), side by side, whose limits are spread:
// it slips little by little. The sum of sliders of slip displacement phi and stiffness rho(phi) dphi each,
//   force = integral of rho(phi) min(u, phi) dphi,   rho = R phi^chi up to phi_max,
// has the stiffness K = R phi_max^(chi+1)/(chi+1) while nothing slips and the limit F = R phi_max^(chi+2)/
// (chi+2) of all. With chi = 0 the limits are spread evenly: the force rises along a parabola,
// K u - K^2 u^2/(4 F), up to u = 2 F/K.
// Sources: W. D. Iwan, J. Appl. Mech. 33 (1966) 893; D. J. Segalman, J. Appl. Mech. 72 (2005) 752.
namespace frahm::laws {

// A slider's part of the joint's stiffness and of its limit.
struct IwanShare {
  double stiffness = 0.0, force = 0.0;  // 1
};

// The sliders within n equal parts of phi_max each as one, of their stiffness and their limit together:
//   k_i/K = (i/n)^(chi+1) - ((i-1)/n)^(chi+1),   F_i/F = (i/n)^(chi+2) - ((i-1)/n)^(chi+2)
// evenly spread k_i = K/n, F_i = F (2 i - 1)/n^2; one alone is the jenkins element of K and F. chi > -1.
inline std::vector<IwanShare> iwan_shares(int n, double chi) {
  std::vector<IwanShare> shares;
  for (int i = 1; i <= n; ++i) {
    const double upper = static_cast<double>(i) / n, lower = static_cast<double>(i - 1) / n;
    shares.push_back({std::pow(upper, chi + 1.0) - std::pow(lower, chi + 1.0),
                      std::pow(upper, chi + 2.0) - std::pow(lower, chi + 2.0)});
  }
  return shares;
}

}  // namespace frahm::laws
