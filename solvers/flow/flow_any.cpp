#include "solvers/flow/flow_bodies.hpp"

template class frahm::periodic::Flow<Eigen::Dynamic, Eigen::Dynamic>;
