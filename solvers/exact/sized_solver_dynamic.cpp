#include "solvers/exact/sized_solver.hpp"

template class frahm::periodic::SizedSolver<Eigen::Dynamic, Eigen::Dynamic>;
