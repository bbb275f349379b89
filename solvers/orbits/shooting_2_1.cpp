#include "solvers/orbits/shooting_bodies.hpp"

template class frahm::periodic::Shooting<2, 1>;
