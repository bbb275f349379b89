#include "solvers/response/sized_solver.hpp"

template class frahm::periodic::SizedSolver<Eigen::Dynamic, Eigen::Dynamic>;
