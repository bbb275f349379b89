#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "solvers/laws/damper_bend.hpp"
#include "tests/known_answers/responses.hpp"
#include "tests/known_answers/single_mass.hpp"

// Which laws hold a resonance without other damping, x'' + x + N(x') = P cos(tau): in a period of amplitude X
// the force puts in pi P X at most.
namespace frahm::periodic::unbounded_laws_test {
namespace {

using Catch::Matchers::WithinRel;
using namespace mechanics;
constexpr double kExact = 1e-10;

// The damper's table has the slope `first` up to the velocity `place` on both sides, and `last` beyond.
NetworkValues with_table(Network& network, double first, double place, double last, double P) {
  network.elements[1].bends = {{+1.0, &laws::damper_bend}, {-1.0, &laws::damper_bend}};
  NetworkValues values = single_mass_values(1.0, 0.5 * first, 0.0);
  values.excitation[0].amplitude = P;
  const BendValue bend{.place = place, .damping = last - first};
  values.bends = {{}, {bend, bend}, {}};
  return values;
}

TEST_CASE("A damper whose table ends level holds a resonance up to pi/4 of the force there") {
  Network network = single_mass();
  const NetworkValues weak = with_table(network, 3.0, 0.1, 0.0, 0.05);
  Responses responses(network);
  REQUIRE(responses.solve(weak).status == Status::ok);
  CHECK_THAT(responses["x_peak"], WithinRel(0.05 / 3.0, kExact));  // below the end of the slope: P/(c omega)
  const double most = 4.0 * 0.3 / std::numbers::pi;
  CHECK(responses.solve(with_table(network, 3.0, 0.1, 0.0, 0.9 * most)).status == Status::ok);
  CHECK(responses.solve(with_table(network, 3.0, 0.1, 0.0, 1.001 * most)).status == Status::unbounded);
}

TEST_CASE("A damper whose table ends rising holds every resonance, though it begins level") {
  Network network = single_mass();
  const NetworkValues values = with_table(network, 0.0, 0.1, 0.5, 10.0);
  Responses responses(network);
  const auto summary = responses.solve(values);
  INFO(summary.reason);
  CHECK(has_response(summary.status));
  CHECK(responses["energy_balance"] < kExact);
}

TEST_CASE("Static friction holds a mass at rest at its resonance, though a motion once begun grows") {
  Network network = single_mass();
  network.elements[2].has_static_force = true;
  const auto with_static = [](double static_force) {
    NetworkValues values = single_mass_values(1.0, 0.0, 0.1);
    values.excitation[0].amplitude = 0.3;  // more than 4 F/pi = 0.127
    values.second = {0.0, 0.0, static_force};
    return values;
  };
  Responses responses(network);
  const auto at_rest = responses.solve(with_static(0.5));  // more than 0.3
  INFO(at_rest.reason);
  CHECK(at_rest.status == Status::ok);
  CHECK(responses["x_peak"] == 0.0);
  // More than 4 F_s/pi: no force of friction balances it.
  CHECK(responses.solve(with_static(0.2)).status == Status::unbounded);
  // Not held at rest, and what slides grows.
  CHECK(responses.solve(with_static(0.25)).status == Status::unbounded);
}

}  // namespace
}  // namespace frahm::periodic::unbounded_laws_test
