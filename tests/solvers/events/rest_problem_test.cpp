#include "solvers/events/rest_problem.hpp"

#include <catch2/catch.hpp>

namespace frahm::periodic::rest_problem_test {
namespace {

using Catch::Matchers::WithinAbs;
using Eigen::VectorXd;
constexpr double kSoon = 1e-5;  // of the forces: shares are told of a little later

// Two contacts side by side that hold a mass against a force which changes at a rate. Without limits they
// take 0.1 and 0.9 of it.
RestProblem side_by_side(double force, double rate) {
  const VectorXd parts = Eigen::Vector2d(0.1, 0.9), limit = Eigen::Vector2d(1.0, 3.0);
  return {.contacts = {0, 1},
          .W = Eigen::MatrixXd::Ones(1, 2),
          .G = Eigen::MatrixXd::Ones(2, 2),
          .bound = limit,
          .weight = limit,
          .force = force * parts,
          .rate = rate * parts};
}

TEST_CASE("Contacts side by side hold as much as their limits together, and no more") {
  for (const double sign : {1.0, -1.0}) {
    INFO("towards " << sign);
    CHECK(outcome_of(side_by_side(sign * 3.9, sign)).slides == 0);
    CHECK(outcome_of(side_by_side(sign * 4.0, -sign)).slides == 0);
    const RestOutcome slow = outcome_of(side_by_side(sign * 4.0, sign));
    CHECK(slow.slides == 3);
    CHECK(slow.forward == (sign > 0.0 ? 3 : 0));
    CHECK(slow.is_slow);
    const RestOutcome sudden = outcome_of(side_by_side(sign * 5.0, -sign));
    CHECK(sudden.slides == 3);
    CHECK_FALSE(sudden.is_slow);
  }
}

TEST_CASE("A contact at its limit takes no more while the other can, and shares again as the force falls") {
  const double full = 3.0 / 0.9;  // the second is just at its limit
  for (const double rate : {-1.0, 1.0}) {
    INFO("rate " << rate);
    const RestOutcome outcome = outcome_of(side_by_side(full, rate));
    CHECK(outcome.slides == 0);
    CHECK(outcome.shares.bound.size() == (rate > 0.0 ? 1 : 0));
  }
  const RestOutcome beyond = outcome_of(side_by_side(3.7, -1.0));
  CHECK_THAT(beyond.shares.lambda[0], WithinAbs(0.7, kSoon));
  CHECK(beyond.shares.lambda[1] == 3.0);
}

TEST_CASE("The rounding of a rate lets no contact slide that the others hold") {
  // A triangle of contacts at rest in itself, one of them beyond its limit, beside one to the ground.
  Eigen::MatrixXd W(3, 4);
  W << 0, 0, 1, -1, -1, 1, -1, 0, 1, 0, 0, 1;
  const Eigen::Vector4d limit(0.087, 0.57, 0.059, 0.28);
  RestProblem rest{.contacts = {0, 1, 2, 3},
                   .W = W,
                   .G = W.transpose() * W,
                   .bound = limit,
                   .weight = limit,
                   .force = Eigen::Vector4d(0.0222, 0.066, -0.00375, 0.3141),
                   .rate = Eigen::Vector4d(8.4e-18, -0.031, 3.9e-18, -3.5e-18)};
  const RestOutcome outcome = outcome_of(rest);
  CHECK(outcome.found);
  CHECK(outcome.slides == 0);
  CHECK(outcome.shares.bound == std::vector<Eigen::Index>{3});
}

}  // namespace
}  // namespace frahm::periodic::rest_problem_test
