#include "solvers/periodic/response_solver.hpp"

template class frahm::periodic::SizedSolver<Eigen::Dynamic, Eigen::Dynamic>;
