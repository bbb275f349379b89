#include "solvers/flow/flow_bodies.hpp"
#include "solvers/flow/linear_form.hpp"

template class frahm::periodic::Flow<1, 1>;
template class frahm::periodic::Forms<1, 1>;
