#pragma once

#include <Eigen/Core>

#include "solvers/flow/sizes.hpp"

namespace frahm::periodic {

// The inverse of B = 1 - dg/dz of a large system, where computing B again takes as long as some passages:
// kept from step to step and from orbit to orbit, and corrected by what each step shows. Of all corrections
// that agree with the last step the least is made (C. G. Broyden, Math. Comp. 19 (1965) 577; its inverse form
// by Sherman and Morrison).
class KeptDerivative {
 public:
  // What B is the derivative of; that of another map is of no use.
  struct Map {
    double section = 0.0, sign = 0.0, step = 0.0;
    ContactMask stuck_throughout = 0, held = 0;
    friend bool operator==(const Map&, const Map&) = default;
  };

  bool serves(const Map& map) const { return inverse_.size() > 0 && map_ == map; }
  void forget() { inverse_.resize(0, 0); }
  void set(const Map& map, const Eigen::MatrixXd& B);

  // The step to the fixed point from a state of this residual g(z) - z.
  Eigen::VectorXd step(const Eigen::VectorXd& residual) const { return inverse_ * residual; }
  // After a step, or part of one, by which the residual fell by `fall`. weighted: the step times the matrix
  // of the energy norm, in which corrections are measured.
  void correct(const Eigen::VectorXd& step, const Eigen::VectorXd& weighted, const Eigen::VectorXd& fall);

  // Whether further steps, each of which leaves the part `left` of the residual, until this part `needed` is
  // left, would take longer than B again and the steps after it.
  bool is_worth_renewing(double left, double needed) const;

 private:
  Eigen::MatrixXd inverse_;
  Map map_;
};

}  // namespace frahm::periodic
