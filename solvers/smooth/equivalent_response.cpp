#include "solvers/smooth/equivalent_response.hpp"

#include <cmath>

namespace frahm::smooth {
namespace {

// ln(c_next/c) of each damper; 0 where one of the two is none.
Eigen::VectorXd change(const Eigen::VectorXd& slope, const Eigen::VectorXd& next) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(slope.size());
  for (Eigen::Index j = 0; j < slope.size(); ++j) {
    if (slope[j] > 0.0 && next[j] > 0.0) result[j] = std::log(next[j] / slope[j]);
  }
  return result;
}

StraightTerms first_terms(const Equation& equation, Equivalents begin) {
  if (begin == Equivalents::from_sliding) {
    const SteadyState sliding = equation.linear_response();
    if (sliding.is_finite()) return equation.equivalent(sliding);
  }
  return equation.at_rest();
}

}  // namespace

// c := c (c_next/c)^share, the share halved where the changes turn back: under a curve that saturates a
// damper grows or shrinks steadily to where it belongs, under one that grows steeper it turns about it.
SteadyState equivalent_response(const Equation& equation, Equivalents begin) {
  constexpr int kMostSteps = 60;
  constexpr double kAgrees = 1e-3;  // of a damper: of a start
  StraightTerms terms = first_terms(equation, begin);
  SteadyState state = equation.linear_response(terms);
  Eigen::VectorXd before = Eigen::VectorXd::Zero(equation.terms());
  double share = 1.0;
  for (int step = 0; step < kMostSteps && state.is_finite(); ++step) {
    const StraightTerms next = equation.equivalent(state);
    const Eigen::VectorXd now = change(terms.slope, next.slope);
    if (now.dot(before) < 0.0) share *= 0.5;
    for (Eigen::Index j = 0; j < now.size(); ++j)
      terms.slope[j] = now[j] != 0.0 ? terms.slope[j] * std::exp(share * now[j]) : next.slope[j];
    terms.force += share * (next.force - terms.force);
    before = now;
    state = equation.linear_response(terms);
    if (!(now.size() > 0 && now.cwiseAbs().maxCoeff() > kAgrees)) break;
  }
  return state;
}

std::optional<Eigen::VectorXd> equivalent_start(const Equation& equation, Equivalents begin) {
  constexpr double kLargest = 1e6;  // of the static response
  const SteadyState state = equivalent_response(equation, begin);
  if (!state.is_finite()) return std::nullopt;
  Eigen::VectorXd z = equation.at(0.0, state);
  if (equation.energy_norm(z) > kLargest * equation.static_norm()) return std::nullopt;
  return z;
}

}  // namespace frahm::smooth
