#include "solvers/orbits/kept_derivative.hpp"

#include <cmath>

#include "solvers/algebra/solve.hpp"

namespace frahm::periodic {

void KeptDerivative::set(const Map& map, const Eigen::MatrixXd& B) {
  inverse_ = algebra::inverse(B);
  map_ = map;
}

// With s the step, y the fall of the residual and H = B^-1, B s is to be y:
//   H += (s - H y) (s^T H) / (s^T H y)
void KeptDerivative::correct(const Eigen::VectorXd& step, const Eigen::VectorXd& weighted,
                             const Eigen::VectorXd& fall) {
  const Eigen::VectorXd expected = inverse_ * fall;
  const double share = weighted.dot(expected);
  if (!(std::abs(share) > 0.1 * weighted.dot(step)))
    return;  // the corrected matrix would be all but singular
  const Eigen::RowVectorXd row = weighted.transpose() * inverse_;
  inverse_.noalias() += ((step - expected) / share) * row;
}

bool KeptDerivative::is_worth_renewing(double left, double needed) const {
  constexpr double kStatesAPassage = 40.0;  // columns of B that take as long as one passage
  constexpr double kAfterwards = 3.0;       // passages
  const double renewed = static_cast<double>(inverse_.rows()) / kStatesAPassage + kAfterwards;
  return std::log(needed) / std::log(left) > renewed;
}

}  // namespace frahm::periodic
