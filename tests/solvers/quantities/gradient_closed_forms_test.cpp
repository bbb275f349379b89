#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "solvers/orbits/closed_forms.hpp"
#include "tests/known_answers/single_mass.hpp"
#include "tests/solvers/gradient_parameters.hpp"

// Exact derivatives of periodic responses against those of closed forms.
namespace frahm::periodic::gradient_closed_forms_test {
namespace {

using namespace mechanics;

using Triple = std::array<double, 3>;
constexpr double kClosedForm = 1e-9;

std::vector<double> single_mass_gradient(double r, double zeta, double f,
                                         const std::vector<Quantity>& quantities) {
  const Network network = single_mass();
  const NetworkValues values = single_mass_values(r, zeta, f);
  PeriodicResponse response(network, quantities);
  response.set_values(values);
  response.solve();
  std::vector<NetworkValues> directions(3, zero_direction(values));
  directions[0].omega = 1.0;
  directions[1].element[1] = 2.0;  // c = 2 zeta
  directions[2].element[2] = 1.0;
  std::vector<double> gradient(3 * quantities.size());
  CHECK(response.gradient(directions, gradient).empty());
  return gradient;
}

// Of a closed form, by a sixth-order difference: good to 1e-10.
template <class Function>
double difference(const Function& f, double x) {
  const double h = 5e-4;
  return (45.0 * (f(x + h) - f(x - h)) - 9.0 * (f(x + 2 * h) - f(x - 2 * h)) + f(x + 3 * h) - f(x - 3 * h)) /
         (60.0 * h);
}

TEST_CASE(
    "Den Hartog's amplitude without stops has the derivatives of its closed form, by f in closed form too") {
  for (const Triple& at : {Triple{0.7, 0.05, 0.2}, Triple{1.0, 0.1, 0.5}, Triple{1.3, 0.0, 0.1},
                           Triple{0.9, 1.2, 0.05}, Triple{2.0, 0.02, 0.4}}) {
    const double r = at[0], zeta = at[1], f = at[2];
    INFO("r " << r << " zeta " << zeta << " f " << f);
    REQUIRE(non_stop_response(r, zeta, f).valid());
    const auto gradient = single_mass_gradient(r, zeta, f, {{Measure::peak, 0}});
    const auto [V, G, H] = den_hartog_functions(r, zeta);
    // X = sqrt(V^2 - H^2 f^2) - G f
    CHECK(gradient[2] == Approx(-H * H * f / std::sqrt(V * V - H * H * f * f) - G).epsilon(1e-11));
    CHECK(gradient[0] ==
          Approx(difference([&](double x) { return non_stop_response(x, zeta, f).amplitude; }, r))
              .epsilon(kClosedForm));
    if (zeta == 0.0) continue;
    CHECK(gradient[1] ==
          Approx(difference([&](double x) { return non_stop_response(r, x, f).amplitude; }, zeta))
              .epsilon(kClosedForm));
  }
}

TEST_CASE("With one stop a half cycle too") {
  for (const Triple& at : {Triple{0.5, 0.05, 0.6}, Triple{0.8, 0.1, 0.8}, Triple{1.2, 0.02, 0.85}}) {
    const double r = at[0], zeta = at[1], f = at[2];
    INFO("r " << r << " zeta " << zeta << " f " << f);
    REQUIRE(one_stop_response(r, zeta, f).valid());
    const auto gradient =
        single_mass_gradient(r, zeta, f, {{Measure::peak, 0}, {Measure::stuck_fraction, 2}});
    const auto amplitude = [](double x, double y, double z) { return one_stop_response(x, y, z).amplitude; };
    // It slides for Ts of every half period pi/r.
    const auto stuck = [](double x, double y, double z) {
      return 1.0 - one_stop_response(x, y, z).sliding_time * x / std::numbers::pi;
    };
    CHECK(gradient[0] ==
          Approx(difference([&](double x) { return amplitude(x, zeta, f); }, r)).epsilon(kClosedForm));
    CHECK(gradient[2] ==
          Approx(difference([&](double x) { return amplitude(r, x, f); }, zeta)).epsilon(kClosedForm));
    CHECK(gradient[4] ==
          Approx(difference([&](double x) { return amplitude(r, zeta, x); }, f)).epsilon(kClosedForm));
    CHECK(gradient[1] ==
          Approx(difference([&](double x) { return stuck(x, zeta, f); }, r)).epsilon(kClosedForm));
    CHECK(gradient[5] ==
          Approx(difference([&](double x) { return stuck(r, zeta, x); }, f)).epsilon(kClosedForm));
  }
}

TEST_CASE("At no friction the derivative by it is the closed form's, and by r that of V") {
  const double r = 0.8, zeta = 0.1;
  const auto gradient = single_mass_gradient(r, zeta, 0.0, {{Measure::peak, 0}});
  const auto [V, G, H] = den_hartog_functions(r, zeta);
  CHECK(gradient[2] == Approx(-G).epsilon(1e-11));
  // V^-2 = (1 - r^2)^2 + (2 zeta r)^2
  CHECK(gradient[0] ==
        Approx(-0.5 * V * V * V * (-4.0 * r * (1.0 - r * r) + 8.0 * zeta * zeta * r)).epsilon(1e-11));
}

TEST_CASE("The natural frequency and its damping have the derivatives of sqrt(k/m) and c/(2 sqrt(k m))") {
  const Network network = single_mass();
  NetworkValues values = single_mass_values(0.8, 0.1, 0.2);
  values.mass[0] = 2.0;
  PeriodicResponse response(network, {{Measure::natural_frequency, 0}, {Measure::modal_damping, 0}});
  response.set_values(values);
  response.solve();
  std::vector<NetworkValues> directions(2, zero_direction(values));
  directions[0].mass[0] = 1.0;
  directions[1].element[1] = 1.0;
  std::vector<double> gradient(4);
  REQUIRE(response.gradient(directions, gradient).empty());
  CHECK(gradient[0] == Approx(-0.5 * std::pow(2.0, -1.5)).epsilon(1e-13));
  CHECK(gradient[1] == Approx(-0.2 / 4.0 * std::pow(2.0, -1.5)).epsilon(1e-13));
  CHECK(std::abs(gradient[2]) < 1e-15);
  CHECK(gradient[3] == Approx(0.5 / std::sqrt(2.0)).epsilon(1e-13));
}

}  // namespace
}  // namespace frahm::periodic::gradient_closed_forms_test
