#include "solvers/periodic/response_solver.hpp"

template class frahm::periodic::SizedSolver<2, 1>;
