#include "solvers/orbits/shooting_bodies.hpp"

template class frahm::periodic::Shooting<Eigen::Dynamic, Eigen::Dynamic>;
