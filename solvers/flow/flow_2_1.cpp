#include "solvers/flow/flow_bodies.hpp"
#include "solvers/flow/linear_form.hpp"

template class frahm::periodic::Flow<2, 1>;
template class frahm::periodic::Forms<2, 1>;
