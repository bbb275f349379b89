#include "solvers/flow/flow_sizes.hpp"

template class frahm::periodic::Flow<Eigen::Dynamic, Eigen::Dynamic>;
template class frahm::periodic::Forms<Eigen::Dynamic, Eigen::Dynamic>;
