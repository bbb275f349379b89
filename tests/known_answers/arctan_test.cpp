// The arctan law against an integrator of its own, against the exact law, and in its linear limit.
#include "tests/known_answers/arctan.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/orbits/closed_forms.hpp"
#include "tests/known_answers/responses.hpp"
#include "tests/known_answers/rig.hpp"
#include "tests/known_answers/single_mass.hpp"

namespace frahm::periodic::arctan_test {
namespace {

using std::numbers::pi;

constexpr double kOrbit =
    1e-8;  // of an orbit, next to its size: what the integrator's tolerance is chosen for
constexpr double kLinear = 1e-9;      // of the response without friction
constexpr double kBalance = 1e-7;     // energy put in less energy lost, relative
constexpr double kPaperSlope = 1e5;   // [s/m], of the rig's paper
constexpr double kPaperError = 1e-4;  // of the main mass's peak at that slope

// x'' + 2 zeta x' + x + f (2/pi) arctan(slope x') = cos(r t) from rest by Runge-Kutta-Fehlberg 7(8) until the
// start is forgotten; state at r t = 0, and the largest |x| met at a thousandth of the period.
struct Integrated {
  double x, v, peak;
};
Integrated integrated(double r, double zeta, double f, double slope, int periods) {
  using State = std::array<double, 2>;
  namespace odeint = boost::numeric::odeint;
  const auto rate = [&](const State& z, State& dz, double t) {
    dz[0] = z[1];
    dz[1] = std::cos(r * t) - 2 * zeta * z[1] - z[0] - f * 2 / pi * std::atan(slope * z[1]);
  };
  const auto stepper = odeint::make_controlled(1e-13, 1e-13, odeint::runge_kutta_fehlberg78<State>());
  State z{};
  const double period = 2 * pi / r;
  double peak = 0.0;
  for (int cycle = 0; cycle < periods; ++cycle) {
    const int parts = cycle + 1 == periods ? 1000 : 1;
    for (int i = 0; i < parts; ++i) {
      const double h = period / parts;
      odeint::integrate_adaptive(stepper, rate, z, i * h, (i + 1) * h, 1e-3 * h);
      peak = parts == 1 ? 0.0 : std::max(peak, std::abs(z[0]));
    }
  }
  return {z[0], z[1], peak};
}

TEST_CASE("the arctan orbit is the one that an integrator from rest comes to") {
  Responses smooth(under_arctan(single_mass()));
  struct Case {
    double r, zeta, f, slope;
  };
  for (const auto& [r, zeta, f, slope] :
       {Case{0.9, 0.05, 0.2, 1e3}, Case{0.5, 0.1, 0.3, 1e2}, Case{0.3, 0.1, 0.6, 1e3},
        Case{1.3, 0.08, 0.1, 1e4},
        Case{0.5, 0.1, 1.2, 1e2}}) {  // the last one sticks throughout under the exact law
    INFO("r " << r << ", f " << f << ", slope " << slope);
    REQUIRE(smooth.solve(with_slope(single_mass_values(r, zeta, f), slope)).status == Status::ok);
    const Integrated expected = integrated(r, zeta, f, slope, 60);
    const History history = smooth.response().history(frahm::periodic::phases_of_a_period(2));
    const double size = std::max(expected.peak, 1e-2);  // static displacement 1
    CHECK_THAT(history.columns[0][0], Catch::WithinAbs(expected.x, kOrbit * size));
    CHECK_THAT(history.columns[1][0], Catch::WithinAbs(expected.v, kOrbit * size));
    CHECK(smooth["x_peak"] >= expected.peak - kOrbit * size);
    // The samples miss the peak by at most a (h/2)^2 / 2 with |a| < 2.5.
    CHECK(smooth["x_peak"] < expected.peak + 2.5 / 8 * std::pow(2 * pi / (1000 * r), 2));
  }
}

TEST_CASE("without friction the arctan solver gives the linear response") {
  Responses smooth(under_arctan(rig())), exact(rig());
  for (const double rpm : {150.0, 197.0, 233.0, 350.0}) {
    const auto values = rig_values(rpm * pi / 30, 6.36, 0.0, 0.0);
    REQUIRE(smooth.solve(with_slope(values, kPaperSlope)).status == Status::ok);
    exact.solve(values);
    for (const char* name : {"main_peak", "tmd_peak", "main_amplitude", "main_rms", "tmd_velocity_peak",
                             "main_acceleration_peak", "main_phase", "tmd_peak_phase", "drive_stroke",
                             "tmd_spring_force_peak", "inerter_force_peak", "tmd_damper_energy",
                             "transmitted_force", "exciter_transmitted_force", "floquet_radius"}) {
      INFO(name << " at " << rpm << " rpm");
      CHECK_THAT(smooth[name],
                 Catch::WithinRel(exact[name], kLinear) || Catch::WithinAbs(exact[name], 1e-12));
    }
    // What is left of a power that goes in and out many times as large.
    CHECK_THAT(smooth["energy_input"], Catch::WithinRel(exact["energy_input"], 10 * kLinear));
  }
}

TEST_CASE(
    "a Maxwell element under the arctan solver has its complex stiffness, and its share of the energy") {
  using namespace mechanics;
  const Node ground{}, mass{NodeKind::mass, 0};
  const Network network{.masses = {"x"},
                        .elements = {{"spring", ElementType::spring, ground, mass},
                                     {"maxwell", ElementType::maxwell, ground, mass},
                                     {"friction", ElementType::coulomb, ground, mass}},
                        .excitations = {{ExcitationKind::force, 0, 1}}};
  const double r = 0.8, k = 0.7, c = 0.4;
  NetworkValues values{.omega = r, .mass = {1.0}, .element = {1.0, k, 0.0}, .excitation = {{1.0, 0.0}}};
  values.second = {0.0, c, 0.0};
  values.smooth.assign(3, {.slope = 1e3});
  Responses smooth(under_arctan(network));
  REQUIRE(smooth.solve(values).status == Status::ok);
  // k i omega c / (k + i omega c)
  const std::complex<double> damper(0.0, r * c), maxwell = k * damper / (k + damper);
  const std::complex<double> x = 1.0 / (1.0 - r * r + maxwell);
  CHECK_THAT(smooth["x_peak"], Catch::WithinRel(std::abs(x), kLinear));
  CHECK_THAT(smooth["x_phase"], Catch::WithinAbs(-std::arg(x), kLinear));
  CHECK_THAT(smooth["maxwell_force_peak"], Catch::WithinRel(std::abs(maxwell * x), kLinear));
  CHECK_THAT(smooth["maxwell_energy"], Catch::WithinRel(pi * std::norm(x) * maxwell.imag(), kLinear));

  values.element[2] = 0.3;
  REQUIRE(smooth.solve(values).status == Status::ok);
  CHECK(smooth["energy_balance"] < kBalance);
  CHECK_THAT(smooth["maxwell_energy"] + smooth["friction_energy"],
             Catch::WithinRel(smooth["energy_input"], kBalance));
}

TEST_CASE("at the paper's slope the rig's main peak is the exact one to 1e-4 wherever nothing stops",
          "[slow]") {
  Responses smooth(under_arctan(rig())), exact(rig());
  int compared = 0;
  for (const double I : {4.72, 6.36, 8.81, 12.9}) {
    for (double rpm = 150; rpm <= 350; rpm += 12.5) {
      const auto values = rig_values(rpm * pi / 30, I, 0.0419);  // the friction that was identified
      exact.solve(values);
      if (exact["guide_stops"] > 0 || exact["tmd_friction_stops"] > 0) continue;
      INFO("I " << I << ", " << rpm << " rpm");
      REQUIRE(smooth.solve(with_slope(values, kPaperSlope)).status == Status::ok);
      CHECK_THAT(smooth["main_peak"], Catch::WithinRel(exact["main_peak"], kPaperError));
      CHECK(smooth["energy_balance"] < kBalance);
      CHECK(smooth["floquet_radius"] < 1.0);
      ++compared;
    }
  }
  CHECK(compared > 40);
}

// The smoothed rig by Runge-Kutta-Fehlberg 7(8) from the state z = (q, q') at omega t = 0 over `periods`.
std::array<double, 4> rig_integrated(const mechanics::NetworkValues& values, double slope,
                                     std::array<double, 4> z, int periods) {
  using State = std::array<double, 4>;
  namespace odeint = boost::numeric::odeint;
  const auto& e = values.element;
  const double M = values.mass[0], m = values.mass[1], b = e[6];
  const double determinant = M * m + b * (M + m);  // of the mass matrix [M+b, -b; -b, m+b]
  const auto rate = [&](const State& x, State& dx, double t) {
    const double drive = kRigSpring * kRigCrank * std::sin(values.omega * t);
    const double between =
        e[4] * (x[0] - x[1]) + e[5] * (x[2] - x[3]) + e[7] * 2 / pi * std::atan(slope * (x[2] - x[3]));
    const double on_main =
        drive - (e[0] + e[1]) * x[0] - e[2] * x[2] - e[3] * 2 / pi * std::atan(slope * x[2]) - between;
    dx = {x[2], x[3], ((m + b) * on_main + b * between) / determinant,
          (b * on_main + (M + b) * between) / determinant};
  };
  const auto stepper = odeint::make_controlled(1e-14, 1e-12, odeint::runge_kutta_fehlberg78<State>());
  const double period = 2 * pi / values.omega;
  for (int cycle = 0; cycle < periods; ++cycle)
    odeint::integrate_adaptive(stepper, rate, z, 0.0, period, 1e-5 * period);
  return z;
}

TEST_CASE(
    "where the law's error on the rig is largest it is the law's own: an integrator keeps to the orbit") {
  Responses smooth(under_arctan(rig())), exact(rig());
  const auto values = rig_values(350 * pi / 30, 12.9, 0.3);
  exact.solve(values);
  REQUIRE(smooth.solve(with_slope(values, kPaperSlope)).status == Status::ok);
  CHECK_THAT(std::abs(smooth["main_peak"] / exact["main_peak"] - 1.0), Catch::WithinRel(1.907e-4, 1e-2));
  const History history = smooth.response().history(frahm::periodic::phases_of_a_period(2));
  const auto at_start = [&](std::size_t column) { return history.columns[column][0]; };
  const std::array<double, 4> start{at_start(0), at_start(2), at_start(1), at_start(3)};
  // From 1e-3 next to the orbit: within 40 periods the multiplier 0.72 brings it back to 2e-9 of that.
  std::array<double, 4> beside = start;
  for (double& component : beside) component *= 1.001;
  const auto end = rig_integrated(values, kPaperSlope, beside, 40);
  for (std::size_t i = 0; i < 4; ++i) {
    const double size = i < 2 ? exact["tmd_peak"] : exact["tmd_velocity_peak"];
    CHECK_THAT(end[i], Catch::WithinAbs(start[i], kOrbit * size));
  }
}

// B of X_arctan = X + (A + B ln(slope)) / slope, see studies/rig/law_error_slope.toml: the response at the
// maximum to a kick |a+| dt at each reversal, dt slope / ln(slope) = (2 f/pi) (1/a-^2 - 1/a+^2). From just
// after one reversal to just after the next the perturbation z = (dx, dv) goes as -D E z + (0, kick), D =
// diag(1, a+/a-), E free decay over half a period.
double predicted_log_coefficient(double r, double zeta, double f) {
  const ClosedForm response = non_stop_response(r, zeta, f);
  const double forcing = std::cos(response.peak_lag);  // of the force at the maximum
  const double before = response.amplitude - forcing + f, behind = response.amplitude - forcing - f;
  const double kick = behind * (2 * f / pi) * (1 / (before * before) - 1 / (behind * behind));
  const double s = std::sqrt(1 - zeta * zeta), tau = pi / r, decay = std::exp(-zeta * tau);
  const double c = decay * std::cos(s * tau), d = decay * std::sin(s * tau) / s;
  Eigen::Matrix2d half;  // I + D E
  half << 1 + c + zeta * d, d, -behind / before * d, 1 + behind / before * (c - zeta * d);
  return (half.inverse() * Eigen::Vector2d(0, kick))[0];
}

TEST_CASE("the error of the arctan law falls with the slope as (A + B ln slope) / slope") {
  Responses smooth(under_arctan(single_mass()));
  struct Case {
    double r, zeta, f;
  };
  for (const auto& [r, zeta, f] :
       {Case{0.9, 0.05, 0.2}, Case{1.3, 0.02, 0.1}, Case{0.8, 0.1, 0.1}, Case{1.1, 0.05, 0.3}}) {
    INFO("r " << r << ", zeta " << zeta << ", f " << f);
    const double exact = non_stop_response(r, zeta, f).amplitude;
    const auto scaled_error = [&, r = r, zeta = zeta, f = f](double slope) {
      REQUIRE(smooth.solve(with_slope(single_mass_values(r, zeta, f), slope)).status == Status::ok);
      return slope * (smooth["x_peak"] - exact);
    };
    const double at_3 = scaled_error(1e3), at_4 = scaled_error(1e4), at_5 = scaled_error(1e5);
    // What is left out is of the order of ln^2(slope) / slope^2; the orbit's own error times 1e5 is some
    // 1e-4.
    constexpr double kRate = 0.03;
    const double expected = predicted_log_coefficient(r, zeta, f) * std::log(10.0);
    CHECK_THAT(at_4 - at_3, Catch::WithinRel(expected, kRate));
    CHECK_THAT(at_5 - at_4, Catch::WithinRel(expected, kRate));
  }
}

TEST_CASE("stops become a creep: the arctan orbit goes to the exact one with stops as the slope grows") {
  Responses smooth(under_arctan(single_mass())), exact(single_mass());
  exact.solve(single_mass_values(0.3, 0.05, 0.6));
  REQUIRE(exact["friction_stops"] == 2.0);
  double before = 1.0;
  for (const double slope : {1e2, 1e3, 1e4, 1e5, 1e6}) {
    REQUIRE(smooth.solve(with_slope(single_mass_values(0.3, 0.05, 0.6), slope)).status == Status::ok);
    const double error = std::abs(smooth["x_peak"] / exact["x_peak"] - 1.0);
    CHECK(error < 0.7 * before);
    CHECK(smooth["energy_balance"] < kBalance);
    before = error;
  }
  CHECK(before < 3e-4);
  CHECK(smooth["friction_stops"] == -1.0);
  CHECK(smooth["friction_regime"] == 0.0);
  CHECK(std::isnan(smooth["friction_stuck_fraction"]));
  CHECK(std::isnan(smooth["error_bound"]));
  CHECK(smooth.response().stretches().empty());
}

TEST_CASE("where no arctan orbit is found there is a status and a reason, and no number") {
  Responses smooth(under_arctan(single_mass()));
  const auto unbounded = smooth.solve(with_slope(single_mass_values(1.0, 0.0, 0.7), kPaperSlope));
  CHECK(unbounded.status == Status::unbounded);
  CHECK_FALSE(unbounded.reason.empty());
  for (const char* name : {"x_peak", "x_phase", "friction_energy", "floquet_radius", "energy_balance"}) {
    INFO(name);
    CHECK(std::isnan(smooth[name]));
  }
  // What is damped so weakly that the integrator's errors add up over about 1e5 periods is refused.
  const auto weak = smooth.solve(with_slope(single_mass_values(1.0, 1e-6, 0.0), kPaperSlope));
  CHECK(weak.status == Status::failed);
  CHECK_THAT(weak.reason, Catch::Contains("damped too weakly") && Catch::Contains("estimated error"));
  CHECK(std::isnan(smooth["x_peak"]));
  // As is what moves too slowly for its steepness.
  const auto slow = smooth.solve(with_slope(single_mass_values(1e-7, 0.0, 0.1), 1e12));
  CHECK(slow.status == Status::failed);
  CHECK_THAT(slow.reason, Catch::Contains("too many steps"));
  CHECK(std::isnan(smooth["x_peak"]));
}

TEST_CASE("the arctan orbit stays right beside the unbounded resonance and where damping is weak") {
  Responses smooth(under_arctan(single_mass())), exact(single_mass());
  for (const auto& [zeta, f] : {std::pair{0.0, 0.9}, {0.0, 0.79}, {1e-4, 0.3}, {1e-3, 0.0}}) {
    INFO("zeta " << zeta << ", f " << f);
    const auto values = single_mass_values(1.0, zeta, f);
    exact.solve(values);
    REQUIRE(smooth.solve(with_slope(values, 1e6)).status == Status::ok);
    CHECK(smooth["energy_balance"] < kBalance);
    // Where it sticks long the error of the law is of the order slope^-1/2 of what moves at all.
    CHECK_THAT(smooth["x_peak"], Catch::WithinRel(exact["x_peak"], f > 0.5 ? 2e-2 : 1e-7));
  }
}

TEST_CASE("friction laws are not mixed, and a slope is positive") {
  mechanics::Network network = under_arctan(rig());
  network.elements[3].law = mechanics::ForceLaw::exact;
  CHECK_THROWS_AS(PeriodicResponse(network, {}), mechanics::MechanicsError);
  Responses smooth(under_arctan(single_mass()));
  CHECK_THROWS_AS(smooth.solve(with_slope(single_mass_values(0.9, 0.05, 0.2), 0.0)),
                  mechanics::MechanicsError);
}

TEST_CASE("a network with the arctan law is solved the same along a row as point by point") {
  Responses row(under_arctan(rig())), alone(under_arctan(rig()));
  for (const double rpm : {190.0, 195.0, 200.0, 205.0}) {
    const auto values = with_slope(rig_values(rpm * pi / 30, 6.36, 0.1), kPaperSlope);
    const Status status = rpm == 190.0 ? row.solve(values).status : row.follow(values).status;
    REQUIRE(status == Status::ok);
    REQUIRE(alone.solve(values).status == Status::ok);
    CHECK_THAT(row["main_peak"], Catch::WithinRel(alone["main_peak"], kOrbit));
    CHECK_THAT(row["tmd_rms"], Catch::WithinRel(alone["tmd_rms"], kOrbit));
  }
}

// Twelve masses that are driven alike, each with friction to the ground and to all others: 78 contacts.
TEST_CASE("More contacts than the exact law can follow have the response of the one mass that they all are") {
  constexpr std::size_t kMasses = 12;
  constexpr double r = 0.8, zeta = 0.1, f = 0.2, slope = 10.0;
  mechanics::Network network;
  mechanics::NetworkValues values;
  values.omega = r;
  const mechanics::NetworkValues one = single_mass_values(r, zeta, f);
  const auto node = [](std::size_t i) { return mechanics::Node{mechanics::NodeKind::mass, i}; };
  for (std::size_t i = 0; i < kMasses; ++i) {
    const std::string name = "m" + std::to_string(i);
    network.masses.push_back(name);
    values.mass.push_back(1.0);
    network.excitations.push_back({mechanics::ExcitationKind::force, i, 1});
    values.excitation.push_back({1.0, 0.0});
    for (std::size_t e = 0; e < one.element.size(); ++e) {
      const mechanics::Element element = single_mass().elements[e];
      network.elements.push_back({name + element.name, element.type, {}, node(i)});
      values.element.push_back(one.element[e]);
    }
  }
  for (std::size_t i = 0; i < kMasses; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      network.elements.push_back({"p" + std::to_string(i) + "_" + std::to_string(j),
                                  mechanics::ElementType::coulomb, node(i), node(j)});
      values.element.push_back(f);
    }
  }
  Responses all(under_arctan(network)), alone(under_arctan(single_mass()));
  all.solve(with_slope(values, slope));
  alone.solve(with_slope(one, slope));
  CHECK(all["status"] == static_cast<double>(Status::ok));
  for (const char* peak : {"m0_peak", "m11_peak"})
    CHECK_THAT(all[peak], Catch::WithinRel(alone["x_peak"], kOrbit));
}

}  // namespace
}  // namespace frahm::periodic::arctan_test
