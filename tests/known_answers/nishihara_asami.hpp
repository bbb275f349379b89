#pragma once

#include <cmath>

// The exact H-infinity optimum of an absorber of mass ratio mu on an undamped mass.
// Source: O. Nishihara, T. Asami, J. Vib. Acoust. 124 (2002) 576-582. tests/known_answers/tuning_test.cpp
// shows that it is a minimum.
struct AbsorberOptimum {
  double f;     // omega_a / omega of the mass
  double zeta;  // c / (2 m omega_a)
  double peak;  // worst magnification
};

inline AbsorberOptimum nishihara_asami(double mu) {
  const double q = std::sqrt(4.0 + 3.0 * mu);
  return {2.0 / (1.0 + mu) *
              std::sqrt(2.0 * (16.0 + 23.0 * mu + 9.0 * mu * mu + 2.0 * (2.0 + mu) * q) /
                        (3.0 * (64.0 + 80.0 * mu + 27.0 * mu * mu))),
          0.25 * std::sqrt((8.0 + 9.0 * mu - 4.0 * q) / (1.0 + mu)),
          1.0 / (3.0 * mu) *
              std::sqrt((std::pow(8.0 + 9.0 * mu, 2) * (16.0 + 9.0 * mu) - 128.0 * q * q * q) /
                        (3.0 * (32.0 + 27.0 * mu)))};
}
