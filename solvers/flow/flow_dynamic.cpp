#include "solvers/flow/flow_bodies.hpp"
#include "solvers/flow/linear_form.hpp"

template class frahm::periodic::Flow<Eigen::Dynamic, Eigen::Dynamic>;
template class frahm::periodic::Forms<Eigen::Dynamic, Eigen::Dynamic>;
