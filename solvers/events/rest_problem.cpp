#include "solvers/events/rest_problem.hpp"

#include <cmath>

#include "solvers/events/box_minimum.hpp"
#include "solvers/events/tolerances.hpp"

namespace frahm::periodic {
namespace {

using Eigen::Index, Eigen::VectorXd;

// Where forces `lambda` leave the accelerations G (needed - lambda), or their rates.
void find_sliding(const RestProblem& rest, const VectorXd& needed, const VectorXd& lambda, ContactMask among,
                  RestOutcome& outcome) {
  // For the terms, and of those of other contacts, whose rounding reaches one that nothing pulls at.
  constexpr double kRounding = 1e-9, kOfOthers = 1e-12;
  const VectorXd pull = rest.G * (needed - lambda);
  const VectorXd size = rest.G.cwiseAbs() * (needed.cwiseAbs() + lambda.cwiseAbs());
  for (Index i = 0; i < pull.size(); ++i) {
    const double tie = kTie * rest.G(i, i) * rest.weight[i];  // to sticking
    if (std::abs(pull[i]) <= kRounding * size[i] + kOfOthers * size.maxCoeff() + tie) continue;
    if ((rest.at(i) & among) == 0) continue;
    outcome.slides |= rest.at(i);
    if (pull[i] > 0.0) outcome.forward |= rest.at(i);
  }
}

ContactMask at_bounds(const RestProblem& rest, const VectorXd& lambda) {
  ContactMask result = rest.letting_go;
  for (Index i = 0; i < lambda.size(); ++i) {
    if (std::abs(lambda[i]) >= (1.0 - kTie) * rest.bound[i]) result |= rest.at(i);
  }
  return result;
}

// The rates of the forces just after an instant at which they are `lambda`, those `at_bound` at their bounds.
BoxMinimum rates_after(const RestProblem& rest, const VectorXd& lambda, ContactMask at_bound) {
  constexpr double kWithoutBound = 1e9;
  const double fastest = rest.rate.cwiseQuotient(rest.weight).cwiseAbs().maxCoeff();
  VectorXd most = (kWithoutBound * fastest) * rest.weight, least = -most;
  for (Index i = 0; i < lambda.size(); ++i) {
    if ((rest.at(i) & at_bound) != 0) (lambda[i] > 0.0 ? most : least)[i] = 0.0;
  }
  return box_minimum(rest.G, rest.G * rest.rate, least, most, rest.weight);
}

// Forces within the bounds a little later.
VectorXd soon_after(const RestProblem& rest, const VectorXd& lambda, const VectorXd& rate) {
  constexpr double kSoon = 1e-6;  // of a bound
  const double fastest = rate.cwiseQuotient(rest.weight).cwiseAbs().maxCoeff();
  if (fastest == 0.0) return lambda;
  double time = kSoon / fastest;
  for (Index i = 0; i < lambda.size(); ++i) {
    const double room = rest.bound[i] - (rate[i] > 0.0 ? lambda[i] : -lambda[i]);
    if (room > 0.0 && std::abs(rate[i]) * time > 0.5 * room) time = 0.5 * room / std::abs(rate[i]);
  }
  return (lambda + time * rate).cwiseMax(-rest.bound).cwiseMin(rest.bound);
}

}  // namespace

RestOutcome outcome_of(const RestProblem& rest) {
  RestOutcome outcome;
  const BoxMinimum held = box_minimum(rest.G, rest.G * rest.force, -rest.bound, rest.bound, rest.weight);
  outcome.found = held.found;
  find_sliding(rest, rest.force, held.lambda, ~ContactMask{0}, outcome);
  if (!held.found || outcome.slides != 0) return outcome;

  const VectorXd lambda = least_shares(rest.W, held.lambda, rest.bound, rest.weight).lambda;
  const ContactMask at_bound = at_bounds(rest, lambda);
  const BoxMinimum rates = rates_after(rest, lambda, at_bound);
  outcome.found = rates.found;
  outcome.is_slow = true;
  find_sliding(rest, rest.rate, rates.lambda, at_bound, outcome);
  outcome.shares = least_shares(rest.W, soon_after(rest, lambda, rates.lambda), rest.bound, rest.weight);
  return outcome;
}

}  // namespace frahm::periodic
