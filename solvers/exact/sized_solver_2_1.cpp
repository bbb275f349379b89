#include "solvers/exact/sized_solver.hpp"

template class frahm::periodic::Coexistence<2, 1>;
template class frahm::periodic::OrbitSearch<2, 1>;
template class frahm::periodic::SizedSolver<2, 1>;
