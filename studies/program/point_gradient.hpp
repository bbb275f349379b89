#pragma once

#include <span>
#include <string>
#include <vector>

#include "solvers/response/gradient_check.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// The derivatives of the differentiable standard quantities by each number parameter on which the network
// depends, but for those in factors of directions; by the excitation frequency itself if no parameter sets
// it.
struct PointGradient {
  struct By {
    std::string parameter;
    std::string unit;  // SI, of the parameter; "1" where it has none or none is known
    std::vector<periodic::DerivativeCheck> derivatives;  // of each quantity
  };
  std::string reason;  // why the point has no derivatives; otherwise empty
  std::vector<periodic::QuantityDescription> quantities;
  std::vector<By> by;  // empty if there is a reason
};

// parameters: SI values of all parameters, complete. Throws mechanics::MechanicsError where the network's
// values there are out of range.
PointGradient gradient_at(const Study& study, std::span<const double> parameters,
                          periodic::CheckedBy by = periodic::CheckedBy::differences);

}  // namespace frahm::studies
