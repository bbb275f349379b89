#pragma once

#include <Eigen/Core>
#include <vector>

#include "solvers/laws/bend.hpp"
#include "solvers/mechanics/network.hpp"

namespace frahm::mechanics {

struct Incidence;

// The bends of a network's elements (laws/bend.hpp). Beyond its place each adds the force
//   k (u - D) + c u',  or  c (u' - D) of a velocity,   u = w^T q + p^T y along its side.
// b bends, n masses, p prescribed nodes.
struct Bends {
  Eigen::MatrixXd W, W_support;               // n x b, p x b
  Eigen::VectorXd stiffness, damping, place;  // [N/m], [N s/m], [m or m/s]
  std::vector<const laws::Bend*> law;
  std::vector<double> side;          // of each along its element: +1, -1
  std::vector<std::size_t> element;  // whose bend it is

  Eigen::Index count() const { return stiffness.size(); }
};

// Directions and laws of all bends, in the order of their elements; numbers are zero.
Bends place_bends(const Network& network, const std::vector<Incidence>& incidences);

// The numbers of all bends. Throws MechanicsError where one breaks a rule.
void set_bends(const Network& network, const NetworkValues& values, Bends& bends);

// Whether some force bends over a displacement: a stop, a play, or a table of a spring.
bool has_stop(const Network& network);

// Whether the response may be one of several: some law may not be monotone.
bool may_have_several_responses(const Network& network);

// Whether every bend leaves its element monotone: it bends over the velocity, and the whole characteristic
// never falls.
bool are_monotone(const Network& network, const NetworkValues& values);

}  // namespace frahm::mechanics
