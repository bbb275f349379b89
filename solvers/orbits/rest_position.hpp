#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <span>

#include "solvers/orbits/orbit.hpp"
#include "solvers/orbits/rest_directions.hpp"

namespace frahm::periodic {

// A force over the period that contacts at rest carry, alone or together across a cut (contact_cuts.hpp), and
// its limit [N].
struct StuckForce {
  Eigen::VectorXd shares;  // of the contacts that stick throughout
  double least = 0.0, most = 0.0, limit = 0.0;
  // At the limit it is not to stay, where rounding would let it go and throw the motion elsewhere: it falls
  // to a kinetic limit, or an orbit with bends is followed once more from there.
  bool stays_inside = false;
};
inline bool break_limits(std::span<const StuckForce> forces) {
  constexpr double kBeyond = 1.0 + 1e-9;
  return std::ranges::any_of(forces, [](const StuckForce& force) {
    return std::max(force.most, -force.least) > force.limit * kBeyond;
  });
}

// The shift of the mean forces of contacts that stick throughout [N].
struct RestShift {
  enum class Verdict {
    inside,    // every force stays below its limit
    at_limit,  // some force reaches its limit
    none,      // no shift keeps the forces within their limits
  };
  Eigen::VectorXd delta;
  Verdict verdict = Verdict::none;
};

// Contacts that never slide may rest anywhere in an interval (rest_directions.hpp). By convention the mean
// position of least energy is taken: with the mean state z_mean, and for all forces lambda with shares a
// |lambda(t) + a^T delta| <= F,
//   minimise ||z_mean + E delta||_E^2,  which is  1/2 delta^T G delta - c^T delta,
//   G = L^T E,  c = -L^T z_mean.
RestShift least_energy_shift(const RestDirections& rest, const Eigen::VectorXd& z_mean,
                             std::span<const StuckForce> forces);

// The family of orbits about one of them, where bends make the whole motion change with the rest position:
// mean state and forces, and what they change by per force delta of each contact.
struct RestFamily {
  Eigen::VectorXd mean, least, most, limit;    // states; contacts
  Eigen::MatrixXd of_mean, of_least, of_most;  // states x contacts; contacts x contacts
  Eigen::MatrixXd energy_of_mean;              // energy-weighted `of_mean`
};
// The delta to the rest position of least energy of the mean state, as far as the family is linear.
RestShift least_energy_step(const RestFamily& family);

// To the middle of what the limits allow, each contact by itself: `inside` where there is room about it.
RestShift middle_shift(std::span<const StuckForce> forces);

// Moves the whole orbit by a displacement of its state.
template <int N, int H>
void shift_orbit(const Eigen::VectorXd& by, Orbit<N, H>& orbit) {
  orbit.z += by;
  orbit.passage.end += by;
  for (Segment<N, H>& segment : orbit.passage.segments) segment.z += by;
}

// Under symmetric forcing the rest positions have zero mean, so contacts to a fixed support that never slide
// rest at zero: removes the rounding of these positions, orthogonally in the energy norm.
template <int N, int H>
void centre_rest_position(const Flow<N, H>& flow, Orbit<N, H>& orbit) {
  const StepEquations<N, H>& eq = flow.equations();
  ContactMask at_rest = 0;
  for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
    if (contains(orbit.stuck_throughout, j) && eq.holds(j) && eq.support_velocity.row(j).isZero(0.0))
      at_rest |= bit(j);
  }
  if (at_rest == 0) return;
  const Eigen::MatrixXd off =
      Eigen::MatrixXd::Identity(eq.states(), eq.states()) - shift_projector(rest_directions(eq, at_rest));
  const auto centre = [&](typename Sizes<N, H>::State& z) { z = (off * z).eval(); };
  centre(orbit.z);
  centre(orbit.passage.end);
  for (Segment<N, H>& segment : orbit.passage.segments) centre(segment.z);
}

}  // namespace frahm::periodic
