#include "solvers/quantities/gradient_bodies.hpp"

template class frahm::periodic::Gradient<Eigen::Dynamic, Eigen::Dynamic>;
