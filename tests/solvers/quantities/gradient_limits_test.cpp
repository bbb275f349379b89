#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "solvers/orbits/closed_forms.hpp"
#include "tests/known_answers/arctan.hpp"
#include "tests/known_answers/rig.hpp"
#include "tests/known_answers/single_mass.hpp"
#include "tests/solvers/gradient_parameters.hpp"

// Where a periodic response, or one quantity of it, has no derivative.
namespace frahm::periodic::gradient_limits_test {
namespace {

using namespace mechanics;

using Pair = std::array<double, 2>;

// `values` have no gradient for a reason that starts with `expected`, and every place is NaN.
void check_refused(const Network& network, const NetworkValues& values, const std::string& expected) {
  PeriodicResponse response(network, {{Measure::peak, 0}, {Measure::rms, 0}});
  response.set_values(values);
  response.solve();
  const std::vector<NetworkValues> directions(2, zero_direction(values));
  std::vector<double> gradient(4, 0.0);
  CHECK_THAT(response.gradient(directions, gradient), Catch::Matchers::StartsWith(expected));
  for (const double by : gradient) CHECK(std::isnan(by));
  CHECK_THAT(response.why_no_derivative(1), Catch::Matchers::StartsWith(expected));
}

TEST_CASE("No gradient is given at grazing, beyond a resonance without bounds, or of the arctan law") {
  // The limit of the motions without stops.
  for (const auto& [r, zeta] : {Pair{0.15, 0.05}, Pair{0.22, 0.05}, Pair{0.35, 0.05}}) {
    INFO("r " << r << " zeta " << zeta);
    constexpr double kJustBelow = 1.0 - 1e-11;
    check_refused(single_mass(), single_mass_values(r, zeta, kJustBelow * critical_friction(r, zeta)),
                  "grazing");
  }
  check_refused(single_mass(), single_mass_values(1.0, 0.0, 0.1), "the response is unbounded");
  check_refused(under_arctan(single_mass()), with_slope(single_mass_values(0.8, 0.1, 0.2), 1e3),
                "a response under a smooth law");
}

TEST_CASE("Where both sides of a peak tie it has no derivative, and each side by itself has") {
  // A second harmonic of no amplitude: the response is symmetric, and the harmonic would break that.
  Network network = single_mass();
  network.excitations.push_back({ExcitationKind::force, 0, 2});
  NetworkValues values = single_mass_values(0.8, 0.1, 0.2);
  values.excitation.push_back({0.0, 0.3});
  const std::vector<Quantity> quantities = {{Measure::peak, 0},
                                            {Measure::peak, 0, Side::most},
                                            {Measure::peak, 0, Side::least},
                                            {Measure::amplitude, 0},
                                            {Measure::mean, 0}};
  PeriodicResponse response(network, quantities);
  response.set_values(values);
  CHECK_FALSE(response.solve().half_period);
  std::vector<NetworkValues> directions(2, zero_direction(values));
  directions[0].excitation[1].amplitude = 1.0;
  directions[1].element[2] = 1.0;
  std::vector<double> gradient(10);
  REQUIRE(response.gradient(directions, gradient).empty());
  CHECK(std::isnan(gradient[0]));
  CHECK_THAT(response.why_no_derivative(0), Catch::Matchers::StartsWith("two extremes tie"));
  CHECK(gradient[1] == Approx(-gradient[2]).epsilon(1e-9));
  CHECK(response.why_no_derivative(1).empty());
  // By the friction both sides change alike, and so does their peak.
  CHECK(gradient[5] == Approx(gradient[6]).epsilon(1e-9));
  CHECK(gradient[5] == Approx(gradient[7]).epsilon(1e-9));
}

TEST_CASE("A symmetric response has one derivative of both its sides, and says that it is symmetric") {
  PeriodicResponse response(
      rig(), {{Measure::peak, 0}, {Measure::peak, 0, Side::most}, {Measure::peak, 0, Side::least}});
  const NetworkValues values = rig_values(22.0, 6.36, 0.05);
  response.set_values(values);
  CHECK(response.solve().half_period);
  std::vector<NetworkValues> directions(1, zero_direction(values));
  directions[0].omega = 1.0;
  std::vector<double> gradient(3), own(3);
  REQUIRE(response.gradient(directions, gradient).empty());
  response.quantities(own);
  CHECK(own[1] == own[0]);
  CHECK(own[2] == own[0]);
  CHECK(gradient[1] == gradient[0]);
  CHECK(gradient[2] == gradient[0]);
}

TEST_CASE("Counts, flags and figures of the computation have no derivative and say so") {
  const Network network = single_mass();
  const NetworkValues values = single_mass_values(0.8, 0.1, 0.2);
  const std::vector<Quantity> quantities = all_quantities(network);
  PeriodicResponse response(network, quantities);
  response.set_values(values);
  response.solve();
  std::vector<NetworkValues> directions(1, zero_direction(values));
  directions[0].omega = 1.0;
  std::vector<double> gradient(quantities.size());
  REQUIRE(response.gradient(directions, gradient).empty());
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    INFO(describe(quantities[i], network, false).name);
    CHECK(std::isnan(gradient[i]) == !response.why_no_derivative(i).empty());
    if (!is_differentiable(quantities[i].measure)) CHECK(std::isnan(gradient[i]));
  }
}

}  // namespace
}  // namespace frahm::periodic::gradient_limits_test
