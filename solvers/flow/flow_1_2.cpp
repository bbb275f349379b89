#include "solvers/flow/flow_sizes.hpp"

template class frahm::periodic::Flow<1, 2>;
template class frahm::periodic::Forms<1, 2>;
