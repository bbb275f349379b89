#include "solvers/exact/sized_solver.hpp"

template class frahm::periodic::Coexistence<Eigen::Dynamic, Eigen::Dynamic>;
template class frahm::periodic::OrbitSearch<Eigen::Dynamic, Eigen::Dynamic>;
template class frahm::periodic::SizedSolver<Eigen::Dynamic, Eigen::Dynamic>;
