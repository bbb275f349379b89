#include "solvers/flow/flow_sizes.hpp"

template class frahm::periodic::Flow<2, 1>;
template class frahm::periodic::Forms<2, 1>;
