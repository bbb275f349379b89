#include "solvers/exact/sized_solver.hpp"

template class frahm::periodic::Coexistence<1, 2>;
template class frahm::periodic::OrbitSearch<1, 2>;
template class frahm::periodic::SizedSolver<1, 2>;
