#include "solvers/exact/sized_solver.hpp"

template class frahm::periodic::Coexistence<1, 1>;
template class frahm::periodic::OrbitSearch<1, 1>;
template class frahm::periodic::SizedSolver<1, 1>;
