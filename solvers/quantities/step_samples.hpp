#pragma once

#include <span>
#include <vector>

#include "solvers/quantities/observed_motion.hpp"
#include "solvers/quantities/passage_sensitivity.hpp"

// Samples of a motion within its steps, with their derivatives at fixed time in seconds.
namespace frahm::periodic {

using ObservedPolynomials = Eigen::Matrix<double, kTerms, Eigen::Dynamic>;

// Taylor polynomials over a step of what is observed, z^(k) / h^k [SI], a column each.
// z: of the state, or of its derivative.  masses: how many there are.  step: h [s].
template <class StatePolynomials>
ObservedPolynomials observed_polynomials(const StatePolynomials& z, std::span<const Observed> observed,
                                         Eigen::Index masses, double step) {
  ObservedPolynomials result(kTerms, static_cast<Eigen::Index>(observed.size()));
  Eigen::Index column = 0;
  for (const Observed& what : observed) {
    auto p = result.col(column++);
    if (what.order == 0) p = z.col(what.mass);
    if (what.order == 1) p = z.col(masses + what.mass) / step;
    if (what.order == 2) p = derivative(z.col(masses + what.mass)) / (step * step);
  }
  return result;
}

// A step's part of an observed motion: fills rows of values and derivatives.
template <int N, int H>
class StepSamples {
 public:
  explicit StepSamples(std::span<const Observed> observed) : observed_(observed) {}

  void set_step(const Flow<N, H>& flow, const PassageStep<N, H>& step) {
    const StepEquations<N, H>& eq = flow.equations();
    polynomials_ = observed_polynomials(step.expansion.z, observed_, eq.masses(), eq.step);
    slopes_.resizeLike(polynomials_);
    for (Eigen::Index i = 0; i < slopes_.cols(); ++i) slopes_.col(i) = derivative(polynomials_.col(i));
  }
  // Along a direction, of the step last set, which is number `step` of its passage:
  //   d(x / h^k) = dx / h^k - k (x / h^k) dh/h
  void set_direction(const Flow<N, H>& flow, const PassageSensitivity<N, H>& sensitivity, std::size_t step) {
    const StepEquations<N, H>& eq = flow.equations();
    log_step_ = sensitivity.equations().log_step;
    by_ = observed_polynomials(sensitivity.polynomials(step), observed_, eq.masses(), eq.step);
    Eigen::Index column = 0;
    for (const Observed& what : observed_) {
      by_.col(column) -= (what.order * log_step_) * polynomials_.col(column);
      ++column;
    }
  }

  // At a fraction of the step whose powers are given.
  template <class Row>
  void values(const Polynomial& power, double sign, Row&& row) const {
    row.noalias() = sign * (power.transpose() * polynomials_);
  }
  // time: there, in steps since time 0 [s]. With t = h tau held, tau shifts by dtau = -tau dh/h:
  //   dx|_t = dx|_tau + x' dtau
  template <class Row>
  void derivatives(const Polynomial& power, double time, double sign, Row&& row) const {
    row.noalias() = sign * (power.transpose() * by_);
    if (log_step_ != 0.0) row.noalias() -= (sign * log_step_ * time) * (power.transpose() * slopes_);
  }

 private:
  std::span<const Observed> observed_;
  ObservedPolynomials polynomials_, slopes_, by_;
  double log_step_ = 0.0;
};

}  // namespace frahm::periodic
