#include "solvers/orbits/broyden.hpp"

#include <cmath>

#include "solvers/algebra/solve.hpp"

namespace frahm::periodic {

void Broyden::set(const Eigen::MatrixXd& B) {
  inverse_ = algebra::inverse(B);
}

// With s the step, r the residual after it and H = B^-1, B s is to be the fall of the residual:
//   H += H r (s^T H) / (s^T (s - H r))
void Broyden::correct(const Eigen::VectorXd& step, const Eigen::VectorXd& weighted,
                      const Eigen::VectorXd& after) {
  const Eigen::VectorXd missed = inverse_ * after;
  const double size = weighted.dot(step), share = size - weighted.dot(missed);
  if (!(std::abs(share) > 0.1 * size)) return;  // the corrected matrix would be all but singular
  const Eigen::RowVectorXd row = weighted.transpose() * inverse_;
  inverse_.noalias() += (missed / share) * row;
}

}  // namespace frahm::periodic
