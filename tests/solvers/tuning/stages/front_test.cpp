#include "solvers/tuning/stages/front.hpp"

#include <catch2/catch.hpp>

namespace frahm::tuning::front_test {
namespace {

Optimum point(double limit, double objective, Outcome outcome = Outcome::converged) {
  Optimum optimum;
  optimum.trade_off = limit;
  optimum.objective = objective;
  optimum.outcome = outcome;
  return optimum;
}

TEST_CASE("a point of a front is undercut by a lower one under no higher limit, the lowest of them") {
  const auto found = undercut({point(4.0, 2.0), point(3.0, 1.5), point(2.0, 1.0), point(1.0, 3.0)});
  REQUIRE(found.size() == 2);
  CHECK((found[0].problem == 0 && found[0].by == 2));
  CHECK((found[1].problem == 1 && found[1].by == 2));
}

TEST_CASE("a point of a front that fell short of its limit is undercut by any that met a lower one") {
  const auto found = undercut({point(2.0, 0.5, Outcome::infeasible), point(1.0, 3.0)});
  REQUIRE(found.size() == 1);
  CHECK((found[0].problem == 0 && found[0].by == 1));
}

TEST_CASE("equal objectives do not undercut each other") {
  CHECK(undercut({point(2.0, 1.0), point(1.0, 1.0 + 1e-9)}).empty());
}

}  // namespace
}  // namespace frahm::tuning::front_test
