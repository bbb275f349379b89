#include "studies/tuning/optimum_entry.hpp"

#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

namespace optimum_entry_test {
namespace {

using namespace frahm;

tuning::Optimum sample() {
  tuning::Optimum optimum;
  optimum.outcome = tuning::Outcome::not_converged;
  optimum.reason = "the gap falls no more";
  optimum.trade_off = 0.08;
  optimum.parameters = {
      {{1.0 / 3.0, -0.0}, {tuning::AtBound::no, tuning::AtBound::upper}, {0.0, 1e-300}, {5e-324, 2.0}},
      {{11e3}, {tuning::AtBound::lower}, {0.0}, {0.0}}};
  optimum.parameters[0].knots = {15.0, 35.0};
  optimum.path_bound = 0.095;
  optimum.objective = 0.1;
  optimum.certificate_gap = std::numeric_limits<double>::quiet_NaN();
  optimum.kkt_residual = std::numeric_limits<double>::infinity();
  optimum.violation = 1e-9;
  optimum.constant_objective = 0.2;
  optimum.constant = {6.0, 11e3};
  optimum.peaks = {{1, 2, 25.0, 0.1, 0.5, {1.0, -2.0}}, {0, 0, 30.0, 0.09, 0.0, {}}};
  optimum.limits = {{0.07, 26.0, 1, 0.25, 3.5}};
  optimum.rounds = {{7, 12, 0.099, 0.101, 0.0}, {9, 4, 0.1, 0.1, 0.0}};
  optimum.iterations = 16;
  optimum.seen = {.cells = 121, .share = 0.75, .polished = {0.1, 0.2}};
  optimum.ends = {.least = 0.03, .objective_at_least = 0.2, .most = 0.09, .objective_at_most = 0.1};
  optimum.orbits = std::uint64_t{1} << 40;
  optimum.gradients = 123;
  return optimum;
}

engine::Bytes encoded(const std::vector<tuning::Optimum>& optima) {
  engine::Bytes bytes;
  studies::encode(optima, bytes);
  return bytes;
}

TEST_CASE("a record of optima is read back to the last bit") {
  const std::vector<tuning::Optimum> optima{sample(), tuning::Optimum{}};
  const engine::Bytes bytes = encoded(optima);
  const auto read = studies::decode_optima(bytes);
  REQUIRE(read.size() == 2);
  CHECK(encoded(read) == bytes);
  const tuning::Optimum& one = read.front();
  CHECK(one.outcome == tuning::Outcome::not_converged);
  CHECK(one.reason == "the gap falls no more");
  CHECK(std::signbit(one.parameters[0].value[1]));
  CHECK(one.parameters[0].at_bound[1] == tuning::AtBound::upper);
  CHECK(one.parameters[0].upper_multiplier[0] == 5e-324);
  CHECK(one.parameters[0].knots == std::vector<double>{15.0, 35.0});
  CHECK(one.path_bound == 0.095);
  CHECK(std::isnan(one.certificate_gap));
  CHECK(one.constant == std::vector<double>{6.0, 11e3});
  CHECK(one.peaks[0].record == 2);
  CHECK(one.peaks[0].sensitivity == std::vector<double>{1.0, -2.0});
  CHECK(one.limits[0].scenario == 1);
  CHECK(one.limits[0].excess == 0.25);
  CHECK(one.rounds[1].active == 9);
  CHECK(one.seen.cells == 121);
  CHECK(one.seen.polished == std::vector<double>{0.1, 0.2});
  CHECK(one.ends.most == 0.09);
  CHECK(one.orbits == std::uint64_t{1} << 40);
}

TEST_CASE("a record that is cut off anywhere, or goes on, is refused") {
  const engine::Bytes bytes = encoded({sample()});
  for (std::size_t size = 0; size < bytes.size(); ++size)
    CHECK_THROWS_AS(studies::decode_optima(std::span(bytes).first(size)), std::runtime_error);
  engine::Bytes longer = bytes;
  longer.push_back(std::byte{0});
  CHECK_THROWS_AS(studies::decode_optima(longer), std::runtime_error);
}

}  // namespace
}  // namespace optimum_entry_test
