#include "solvers/transient/record_facts.hpp"

#include <catch2/catch.hpp>
#include <numbers>

namespace frahm::transient::record_facts_test {
namespace {

constexpr double rounding = 1e-13;

// a = 1 + t from 0 to 2:  v = t + t^2/2 = 4,  y = t^2/2 + t^3/6 = 10/3, whatever the samples in between.
TEST_CASE("A support's acceleration is integrated exactly between uneven samples") {
  const RecordFacts facts =
      facts_of({"line", RecordOf::acceleration, {0.0, 0.3, 1.7, 2.0}, {1.0, 1.3, 2.7, 3.0}});
  CHECK_THAT(facts.end_velocity, Catch::WithinRel(4.0, rounding));
  CHECK_THAT(facts.end_displacement, Catch::WithinRel(10.0 / 3.0, rounding));
  CHECK_FALSE(facts.even);
  CHECK_THAT(facts.shortest, Catch::WithinRel(0.3, rounding));
  CHECK_THAT(facts.longest, Catch::WithinRel(1.4, rounding));
  CHECK(facts.peak == 3.0);
  CHECK(facts.peak_time == 2.0);
  CHECK(facts.start == 1.0);
  CHECK(facts.end == 3.0);
}

TEST_CASE("A support's velocity leaves it displaced, and forces are not integrated") {
  const RecordFacts velocity = facts_of({"step", RecordOf::velocity, {0.0, 1.0, 2.0}, {0.0, -2.0, 0.0}});
  CHECK_THAT(velocity.end_displacement, Catch::WithinRel(-2.0, rounding));
  CHECK_THAT(velocity.peak_displacement, Catch::WithinRel(2.0, rounding));
  CHECK(velocity.end_velocity == 0.0);
  CHECK(velocity.even);
  CHECK(velocity.peak == 2.0);
  CHECK(velocity.peak_time == 1.0);
  const RecordFacts force = facts_of({"step", RecordOf::force, {0.0, 1.0}, {1.0, 1.0}});
  CHECK(force.end_velocity == 0.0);
  CHECK(force.end_displacement == 0.0);
}

}  // namespace
}  // namespace frahm::transient::record_facts_test
