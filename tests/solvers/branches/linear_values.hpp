#pragma once

#include "solvers/branches/branch.hpp"
#include "solvers/mechanics/network_values.hpp"

namespace frahm::periodic {

// The numbers of a network that change linearly with the parameter: their derivative is a difference.
template <class Values>
ValuesAlong linear(const Values& values) {
  const auto derivative = [values](double parameter) {
    mechanics::NetworkValues by = values(parameter + 0.5);
    mechanics::add(values(parameter - 0.5), -1.0, by);
    return by;
  };
  return {values, derivative};
}

}  // namespace frahm::periodic
