#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/tuning/variance/noise.hpp"

namespace frahm::tuning {

enum class NoisyKind {
  displacement,  // of a coordinate, under NoiseKind::acceleration_of relative to that which follows the
                 // support
  stroke,        // relative displacement of an element's ends
};

struct NoisyQuantity {
  NoisyKind kind = NoisyKind::displacement;
  std::size_t index = 0;  // of the coordinate (mechanics/coordinates.hpp) or into Network::elements
};

// Stationary mean square of one quantity [m^2] of a linear network under white noise; the network's own
// excitation plays no part. With z = (q, v, s) the displacements, velocities and Maxwell forces, q relative
// to the moving support, z' = A z + B w and the quantity h^T z:
//
//   A P + P A^T + 2 pi S_0 B B^T = 0,   mean square = h^T P h.
//
// Source: S. H. Crandall, W. D. Mark, Random Vibration in Mechanical Systems, 1963; the Lyapunov form e.g. in
// K. Zhou, J. C. Doyle, K. Glover, Robust and Optimal Control, 1996, section 4.6 (H2 norm).
class Variance {
 public:
  // Throws MechanicsError for a coulomb or hysteretic element (not linear, or not causal), for one whose
  // force would depend on how far or how fast the moving support has drifted, and for the stroke of such an
  // inerter.
  Variance(const mechanics::Network& network, const Noise& noise, const NoisyQuantity& measure);

  // Throws MechanicsError for a value out of range and where the mean square is infinite.
  double mean_square(const mechanics::NetworkValues& values) const;

  // The same, and its derivatives along `directions`, each of which holds derivatives of mass, element,
  // second and damping (empty: 0; of a network with damping of its structure whole directions). slopes: size
  // of directions. Exact, by the adjoint equation A^T Q + Q A + h h^T = 0.
  double mean_square(const mechanics::NetworkValues& values,
                     const std::vector<mechanics::NetworkValues>& directions, std::span<double> slopes) const;

 private:
  struct State;     // the equation z' = A z + B w at some values
  struct Gradient;  // derivatives by every value

  void find_drifting_motion();
  void check_drift() const;
  State state(const mechanics::NetworkValues& values) const;
  Gradient gradient(const State& state, const mechanics::NetworkValues& values, const Eigen::MatrixXd& P,
                    const Eigen::MatrixXd& Q) const;
  double drift(const mechanics::Incidence& at) const;

  mechanics::Assembly assembly_;
  Noise noise_;
  NoisyQuantity measure_;
  Eigen::VectorXd drifting_;  // displacements of the masses that follow the support's slowly, by its own
};

}  // namespace frahm::tuning
