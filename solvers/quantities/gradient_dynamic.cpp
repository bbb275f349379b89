#include "solvers/quantities/gradient.hpp"

template class frahm::periodic::Gradient<Eigen::Dynamic, Eigen::Dynamic>;
