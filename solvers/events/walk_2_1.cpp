#include "solvers/events/walk_bodies.hpp"

template class frahm::periodic::Walk<2, 1>;
