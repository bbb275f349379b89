#include "solvers/events/walk_bodies.hpp"

template class frahm::periodic::Walk<Eigen::Dynamic, Eigen::Dynamic>;
