#pragma once

#include <Eigen/Core>

namespace frahm::periodic {

// The inverse of B = 1 - dg/dz, kept from step to step and from orbit to orbit, and corrected by what each
// step shows, where computing B anew takes as long as many passages. Of all corrections that agree with the
// last step the least is made (C. G. Broyden, Math. Comp. 19 (1965) 577; its inverse form by Sherman and
// Morrison).
class Broyden {
 public:
  bool is_set() const { return inverse_.size() > 0; }
  void forget() { inverse_.resize(0, 0); }
  void set(const Eigen::MatrixXd& B);

  // The step to the fixed point from a state of this residual g(z) - z.
  Eigen::VectorXd step(const Eigen::VectorXd& residual) const { return inverse_ * residual; }
  // After a step, to a state of the residual `after`. weighted: the step times the matrix of the energy norm,
  // in which corrections are measured.
  void correct(const Eigen::VectorXd& step, const Eigen::VectorXd& weighted, const Eigen::VectorXd& after);

 private:
  Eigen::MatrixXd inverse_;
};

}  // namespace frahm::periodic
