#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace frahm::smooth {

// A motion over an interval as the integrator knows it: over each step a polynomial about the step's end.
class Trajectory {
 public:
  static constexpr Eigen::Index kTerms = 6;  // BDF's highest order is 5

  struct Step {
    double start = 0.0, end = 0.0;  // time [s]
  };

  void clear(Eigen::Index size) {
    size_ = size;
    steps_.clear();
    coefficients_.clear();
  }
  // A step, and the coefficients of (t - end)^k: size x kTerms, column-major, to be filled in.
  Eigen::Map<Eigen::MatrixXd> add(double start, double end) {
    steps_.push_back({start, end});
    coefficients_.resize(coefficients_.size() + static_cast<std::size_t>(size_ * kTerms), 0.0);
    return {coefficients_.data() + coefficients_.size() - size_ * kTerms, size_, kTerms};
  }

  const std::vector<Step>& steps() const { return steps_; }

  // The step that covers time t; the first or last one outside the interval.
  std::size_t step_at(double t) const {
    const auto found =
        std::partition_point(steps_.begin(), steps_.end(), [t](const Step& step) { return step.end < t; });
    return static_cast<std::size_t>(std::min(found, steps_.end() - 1) - steps_.begin());
  }

  // The state at time t within a step.
  void state(std::size_t step, double t, Eigen::VectorXd& z) const {
    const Eigen::Map<const Eigen::MatrixXd> c(
        coefficients_.data() + step * static_cast<std::size_t>(size_ * kTerms), size_, kTerms);
    const double x = t - steps_[step].end;
    z = c.col(kTerms - 1);
    for (Eigen::Index k = kTerms - 1; k-- > 0;) z = c.col(k) + x * z;
  }

 private:
  Eigen::Index size_ = 0;
  std::vector<Step> steps_;
  std::vector<double> coefficients_;
};

}  // namespace frahm::smooth
