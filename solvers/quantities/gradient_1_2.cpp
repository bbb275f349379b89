#include "solvers/quantities/gradient_bodies.hpp"

template class frahm::periodic::Gradient<1, 2>;
