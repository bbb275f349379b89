#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace frahm::periodic {

// The cuts through contacts at rest with the directions W (n x m, any rank): all c (m), but for their size,
// with c = W^T n for some n and no smaller set of contacts. The motion alone gives the force
//   sum c_j lambda_j = n^T W lambda
// however a loop of contacts shares it, and no more than  sum |c_j| F_j  crosses a cut. Forces within the
// limits F exist where every cut carries no more than that: the set W lambda, |lambda_j| <= F_j, is a
// zonotope, whose facets have these n (McMullen, On zonotopes, 1971). Of a contact outside loops: c = e_j.
// Largest entry 1; first those of contacts outside loops, in their order. None if a loop has too many cuts.
std::optional<std::vector<Eigen::VectorXd>> contact_cuts(const Eigen::MatrixXd& W);

}  // namespace frahm::periodic
