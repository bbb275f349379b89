#include "solvers/quantities/gradient.hpp"

template class frahm::periodic::Gradient<2, 1>;
