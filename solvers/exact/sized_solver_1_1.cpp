#include "solvers/exact/sized_solver.hpp"

template class frahm::periodic::SizedSolver<1, 1>;
