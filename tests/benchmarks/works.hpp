#pragma once

#include <string>
#include <vector>

#include "solvers/mechanics/network.hpp"

// The maps whose speed is measured: rows of points that share their matrices.
namespace frahm::benchmarks {

struct Work {
  std::string name;
  mechanics::Network network;
  std::vector<std::vector<mechanics::NetworkValues>> rows;
};

// x'' + 2 zeta x' + x + f Sgn(x') = cos(r t), zeta = 0.02, r in 0.2..2, f in 0..0.7.
Work one_mass();
// The same without damping, r in 0.1..2, f in 0..1.1: Den Hartog's map, with its stops and where nothing
// moves.
Work den_hartog();
// The rig (README, studies/rig/rig_atlas.toml): 150..350 rpm, friction 0..0.3.  inertances: of 4.72 to 12.9
// kg.
Work rig(int inertances);
// Masses of 1 in a chain of springs and light dampers, with friction from `every`th storey to the one below;
// shaken at the ground, over its first resonances.
Work shear_building(int storeys, int every);
// Five masses with three contacts, in another order of size.
Work five_masses();

// Every so many points of every so many rows.
Work thinned(Work work, std::size_t rows, std::size_t points);

}  // namespace frahm::benchmarks
