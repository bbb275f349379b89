#pragma once

#include "solvers/identification/misfit.hpp"

// The least of a misfit's several minima. A motion that comes to rest has one for each number of half swings
// before that, and where friction holds the model nothing changes the sum of squares at all.
namespace frahm::identification {

// Uses the current weights of the misfit. iterations: counted up.
class Minima {
 public:
  Minima(const GreyBoxTask& task, Misfit& misfit, int& iterations);  // which must all outlive it

  // From the task's start: both by growing along the records and with all of them at once; if nothing moves
  // at the end, also from less friction.
  LeastSquaresFit from_start();
  // The nearest minimum.
  LeastSquaresFit from(const Eigen::VectorXd& p);
  // For a model with contacts, stops or tables also minima next to `fit`, as long as one is lower.
  LeastSquaresFit beside(LeastSquaresFit fit);
  // The unknowns at separate minima next to the last one returned that are as low to within noise.
  const std::vector<Eigen::VectorXd>& rivals() const { return rivals_; }

 private:
  LeastSquaresFit descend(const Eigen::VectorXd& p, const LeastSquaresOptions& options);
  LeastSquaresFit grown(const Eigen::VectorXd& start, double periods);
  void take(LeastSquaresFit fit, LeastSquaresFit& best);
  void search(const Eigen::VectorXd& start, LeastSquaresFit& best);
  void loosen(LeastSquaresFit& best);
  bool misses(const LeastSquaresFit& fit, double share) const;
  std::vector<Eigen::VectorXd> starts_beside(const LeastSquaresFit& fit);
  void keep_rival(const LeastSquaresFit& other, const LeastSquaresFit& fit);

  const GreyBoxTask& task_;
  Misfit& misfit_;
  int& iterations_;
  Residuals residuals_;
  bool switches_ = false;  // there are contacts, stops or tables
  bool free_ = false;      // there are free motions, which come to rest
  bool exact_ = false;     // the data are followed to rounding
  std::vector<Eigen::VectorXd> rivals_;
};

}  // namespace frahm::identification
