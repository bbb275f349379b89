#pragma once

#include <vector>

#include "solvers/mechanics/network.hpp"
#include "solvers/quantities/quantity.hpp"
#include "solvers/response/periodic_response.hpp"

// The systems of the classical papers as networks: a mass of 1 on a spring of 1 and a damper of 2 zeta, with
// friction, so that time is omega_n t, displacements are in P/k (or in the base's amplitude) and forces in P
// (or k Y).
namespace frahm::studies {

inline constexpr mechanics::Node moving_mass{mechanics::NodeKind::mass, 0};  // the one that moves

mechanics::Network forced_mass(
    const std::vector<int>& orders);                     // a force of each order on the mass, all to ground
mechanics::Network mass_on_base(bool friction_on_base);  // spring and damper to a base that moves

// One component of amplitude 1 and phase 0; for more than one replace `excitation`.
mechanics::NetworkValues mass_values(double r, double zeta, double f);

// The quantities of a response that are known in closed form.
struct KnownQuantities {
  double amplitude = 0.0;       // (max x - min x)/2
  double stroke = 0.0;          // of the spring
  double peak_phase = 0.0;      // omega t at the maximum [rad]
  double floquet_radius = 0.0;  // 1
  double energy_balance = 0.0;  // 1
  double stuck_fraction = 0.0;  // 1
  bool has_orbit = false;       // status ok or grazing
  bool unbounded = false;
  periodic::Regime regime = periodic::Regime::not_computed;
};

// Responses of one such network, each searched from nothing known.
class ClassicalSystem {
 public:
  explicit ClassicalSystem(const mechanics::Network& network);
  KnownQuantities solve(const mechanics::NetworkValues& values);

 private:
  periodic::PeriodicResponse response_;
  std::vector<double> found_;
};

}  // namespace frahm::studies
