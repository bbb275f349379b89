#include "solvers/flow/flow_bodies.hpp"

template class frahm::periodic::Flow<1, 1>;
