#pragma once

#include "solvers/flow/linear_form.hpp"

// The flow of each size is compiled once, in a file of its own (flow_1_1.cpp ...), and not again by whoever
// follows it.
namespace frahm::periodic {

extern template class Flow<1, 1>;
extern template class Flow<1, 2>;
extern template class Flow<2, 1>;
extern template class Flow<Eigen::Dynamic, Eigen::Dynamic>;
extern template class Forms<1, 1>;
extern template class Forms<1, 2>;
extern template class Forms<2, 1>;
extern template class Forms<Eigen::Dynamic, Eigen::Dynamic>;

}  // namespace frahm::periodic
