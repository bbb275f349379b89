#include "solvers/transient/forced_motion.hpp"

#include <algorithm>
#include <boost/numeric/odeint.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "tests/known_answers/event_integrator.hpp"
#include "tests/known_answers/responses.hpp"
#include "tests/known_answers/rig.hpp"
#include "tests/known_answers/single_mass.hpp"

// Forced motion from given initial values, against independent integrations and the periodic responses.
namespace frahm::transient::forced_motion_test {
namespace {

using Catch::Matchers::WithinAbs, Catch::Matchers::WithinRel;
using periodic::rig, periodic::rig_values;

constexpr double kPeriod250 = 60.0 / 250.0;  // [s] at 250 rpm
constexpr double k250 = 2.0 * std::numbers::pi / kPeriod250;

ValuesAt always(const mechanics::NetworkValues& values) {
  return [values](double omega) {
    mechanics::NetworkValues at = values;
    at.omega = omega;
    return at;
  };
}

TEST_CASE("The rig from rest moves as the independent integration says") {
  const mechanics::NetworkValues values = rig_values(k250, 6.36, 0.0419);
  const double duration = 12.0 * kPeriod250;
  const ForcedMotion motion =
      forced_motion(rig(), always(values), {}, {.from = k250, .duration = duration, .samples = 61});
  REQUIRE(motion.failure.empty());
  CHECK(std::isnan(motion.discretisation_error));
  const mechanics::Assembly assembly(rig());
  mechanics::LinearSystem system;
  assembly.set_values(values, system);
  assembly.set_forcing(values, system);
  periodic::EventIntegrator reference(system);
  reference.start(0.0, Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero());
  constexpr double kIntegrated = 1e-10;  // [m] of 0.02
  double error = 0.0;
  for (std::size_t i = 1; i < 61; ++i) {
    reference.advance_to(motion.history.time[i]);
    error = std::max({error, std::abs(motion.history.displacement[0][i] - reference.displacements()[0]),
                      std::abs(motion.history.displacement[1][i] - reference.displacements()[1])});
  }
  INFO("events " << reference.events() << " error " << error);
  CHECK(error < kIntegrated);
}

TEST_CASE("After many periods the transient is the periodic orbit") {
  for (const double I : {6.36, 12.9}) {
    const mechanics::NetworkValues values = rig_values(k250, I, 0.0419);
    periodic::Responses responses(rig());
    responses.solve(values);
    const double settle = 400.0 * kPeriod250;
    const ForcedMotion settled =
        forced_motion(rig(), always(values), {}, {.from = k250, .duration = settle, .samples = 401});
    REQUIRE(settled.failure.empty());
    const auto last = [&](const std::vector<double>& samples) { return samples.back(); };
    // From the state reached, two more periods: their peaks are the orbit's.
    const InitialState state{{last(settled.history.displacement[0]), last(settled.history.displacement[1])},
                             {last(settled.history.velocity[0]), last(settled.history.velocity[1])}};
    const ForcedMotion orbit =
        forced_motion(rig(), always(values), state, {.from = k250, .duration = 2.0 * kPeriod250});
    INFO("I " << I);
    constexpr double kSettled = 1e-10;  // relative; the slowest multiplier, 0.9, to the power 400
    CHECK_THAT(std::abs(orbit.peaks[0].displacement), WithinRel(responses["main_peak"], kSettled));
    CHECK_THAT(std::abs(orbit.peaks[1].displacement), WithinRel(responses["tmd_peak"], kSettled));
  }
}

TEST_CASE(
    "Stops and releases of a mass that is dragged through its guide alternate, and the first release is "
    "known") {
  // cos(r tau) reaches f first on its way: at rest under x'' + x + f Sgn x' = sin(r tau).
  const double r = 0.2, f = 0.6;
  mechanics::NetworkValues values = periodic::single_mass_values(r, 0.05, f);
  values.excitation[0].phase = -0.5 * std::numbers::pi;
  const ForcedMotion motion =
      forced_motion(periodic::single_mass(), always(values), {}, {.from = r, .duration = 200.0});
  REQUIRE(motion.failure.empty());
  const auto& stops = motion.stops[0];
  REQUIRE(stops.size() > 4);
  CHECK(stops[0].onset == 0.0);
  CHECK_THAT(stops[0].release, WithinRel(std::asin(f) / r, 1e-12));
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
    CHECK(stops[i].onset < stops[i].release);
    CHECK(stops[i].release < stops[i + 1].onset);
  }
}

// x'' + 2 zeta x' + x = p(omega) cos(phi), phi = from t + alpha t^2/2, by Boost.odeint alone.
struct SweptOscillator {
  double zeta, from, alpha;
  bool unbalance;  // p = omega^2, otherwise 1

  std::vector<double> at(const std::vector<double>& times, std::vector<double> x) const {
    namespace odeint = boost::numeric::odeint;
    using State = std::vector<double>;
    const auto rate = [this](const State& z, State& dz, double t) {
      const double omega = from + alpha * t, p = unbalance ? omega * omega : 1.0;
      dz = {z[1], p * std::cos(from * t + 0.5 * alpha * t * t) - 2.0 * zeta * z[1] - z[0]};
    };
    std::vector<double> displacements;
    odeint::integrate_times(odeint::make_controlled<odeint::runge_kutta_fehlberg78<State>>(1e-14, 1e-14),
                            rate, x, times.begin(), times.end(), 0.01,
                            [&](const State& z, double) { displacements.push_back(z[0]); });
    return displacements;
  }
};

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

TEST_CASE("Running up and down through resonance is the integrated motion, within the error it states") {
  for (const auto& swept : {SweptOscillator{0.02, 0.3, 0.01, false}, SweptOscillator{0.02, 0.3, 0.05, true},
                            SweptOscillator{0.05, 1.8, -0.02, true}}) {
    mechanics::NetworkValues values = periodic::single_mass_values(1.0, swept.zeta, 0.0);
    const ValuesAt values_at = [&](double omega) {
      mechanics::NetworkValues at = values;
      at.omega = omega;
      at.excitation[0].amplitude = swept.unbalance ? omega * omega : 1.0;
      return at;
    };
    const double to = swept.alpha > 0.0 ? 1.8 : 0.3;
    const double duration = std::abs((to - swept.from) / swept.alpha);
    const ForcedMotion motion = forced_motion(
        periodic::single_mass(), values_at, {{0.2}, {-0.1}},
        {.from = swept.from, .run_up = {to, std::abs(swept.alpha)}, .duration = duration, .samples = 301});
    REQUIRE(motion.failure.empty());
    const double error =
        largest_difference(motion.history.displacement[0], swept.at(motion.history.time, {0.2, -0.1}));
    const double peak = std::abs(motion.peaks[0].displacement);
    INFO("alpha " << swept.alpha << " stairs " << motion.stairs << " stated " << motion.discretisation_error
                  << " true " << error << " peak " << peak);
    CHECK(motion.discretisation_error <= kRunUpTolerance * peak);
    CHECK(error < motion.discretisation_error);
    CHECK_THAT(motion.frequency.back(), WithinRel(to, 1e-12));
  }
}

// The support is felt through spring, damper and inerter alike:
//   m x'' + c (x' - y') + k (x - y) + b (x'' - y'') = 0,  y = cos(phi).
TEST_CASE("A run-up of a support that is felt through an inerter has the angular acceleration in its force") {
  using namespace mechanics;
  const double m = 1.0, c = 0.06, k = 1.0, b = 0.5, from = 0.3, alpha = 0.05, to = 1.5;
  const Node mass{NodeKind::mass, 0}, support{NodeKind::prescribed, 0};
  const Network network{.masses = {"x"},
                        .prescribed = {"y"},
                        .elements = {{"spring", ElementType::spring, support, mass},
                                     {"damper", ElementType::damper, support, mass},
                                     {"inerter", ElementType::inerter, support, mass}},
                        .excitations = {{ExcitationKind::motion, 0, 1}}};
  const NetworkValues values{.mass = {m}, .element = {k, c, b}, .excitation = {{1.0, 0.0}}};
  const ForcedMotion motion =
      forced_motion(network, always(values), {{1.0}, {0.0}},
                    {.from = from, .run_up = {to, alpha}, .duration = (to - from) / alpha, .samples = 201});
  REQUIRE(motion.failure.empty());
  namespace odeint = boost::numeric::odeint;
  using State = std::vector<double>;
  const auto rate = [&](const State& z, State& dz, double t) {
    const std::complex<double> i(0.0, 1.0), y = std::exp(i * (from * t + 0.5 * alpha * t * t));
    const double omega = from + alpha * t;
    const double y_1 = (i * omega * y).real(), y_2 = ((i * alpha - omega * omega) * y).real();
    dz = {z[1], (b * y_2 + c * (y_1 - z[1]) + k * (y.real() - z[0])) / (m + b)};
  };
  std::vector<double> expected;
  State z{1.0, 0.0};
  odeint::integrate_times(odeint::make_controlled<odeint::runge_kutta_fehlberg78<State>>(1e-14, 1e-14), rate,
                          z, motion.history.time.begin(), motion.history.time.end(), 0.01,
                          [&](const State& at, double) { expected.push_back(at[0]); });
  const double error = largest_difference(motion.history.displacement[0], expected);
  INFO("stairs " << motion.stairs << " stated " << motion.discretisation_error << " true " << error);
  CHECK(error < motion.discretisation_error);
  CHECK(motion.discretisation_error <= kRunUpTolerance * std::abs(motion.peaks[0].displacement));
}

// x'' + 2 zeta x' + x + f Sgn(x') = cos(phi) from rest, sticking as long as it may; odeint between the
// events.
double swept_with_friction(double zeta, double f, double from, double alpha, double end) {
  boost::numeric::odeint::runge_kutta_fehlberg78<std::vector<double>> stepper;
  constexpr double h = 0.01;
  double t = 0.0, direction = 0.0;
  std::vector<double> z{0.0, 0.0};
  const auto drive = [&](double at) { return std::cos(from * at + 0.5 * alpha * at * at); };
  const auto rate = [&](const std::vector<double>& x, std::vector<double>& dx, double at) {
    dx = {x[1], drive(at) - 2.0 * zeta * x[1] - x[0] - direction * f};
  };
  while (t < end) {
    const auto moved = [&](double step) {
      std::vector<double> x = z;
      stepper.do_step(rate, x, t, step);
      return x;
    };
    double step = std::min(h, end - t);
    if (direction == 0.0) {  // stuck: until the force exceeds f
      const auto excess = [&](double after) { return std::abs(drive(t + after) - z[0]) - f; };
      if (excess(step) > 0.0) {
        double lo = 0.0, hi = step;
        for (int i = 0; i < 60; ++i) (excess(0.5 * (lo + hi)) > 0.0 ? hi : lo) = 0.5 * (lo + hi);
        t += hi;
        direction = drive(t) - z[0] > 0.0 ? 1.0 : -1.0;
        step = std::min(1e-3, end - t);  // away from the velocity's root at the release
        z = moved(step);
      }
      t += step;
      continue;
    }
    const std::vector<double> next = moved(step);
    if (direction * next[1] > 0.0) {
      z = next;
      t += step;
      continue;
    }
    double lo = 0.0, hi = step;
    for (int i = 0; i < 60; ++i) (direction * moved(0.5 * (lo + hi))[1] > 0.0 ? lo : hi) = 0.5 * (lo + hi);
    z = moved(hi);
    t += hi;
    z[1] = 0.0;
    const double force = drive(t) - z[0];
    direction = std::abs(force) <= f ? 0.0 : std::copysign(1.0, force);
    if (direction != 0.0) {
      step = std::min(1e-3, end - t);
      z = moved(step);
      t += step;
    }
  }
  return z[0];
}

TEST_CASE(
    "A run-up with friction, stops and resonance is the integrated motion, within the error it states") {
  constexpr double zeta = 0.02, f = 0.7, from = 0.2, alpha = 0.02;
  const mechanics::NetworkValues values = periodic::single_mass_values(1.0, zeta, f);
  for (const double end : {20.0, 45.0, 70.0}) {
    const ForcedOptions options{.from = from, .run_up = {1.6, alpha}, .duration = end, .samples = 201};
    const ForcedMotion motion = forced_motion(periodic::single_mass(), always(values), {}, options);
    REQUIRE(motion.failure.empty());
    const double error =
        std::abs(motion.history.displacement[0].back() - swept_with_friction(zeta, f, from, alpha, end));
    INFO("stairs " << motion.stairs << " stated " << motion.discretisation_error << " true " << error);
    CHECK(motion.discretisation_error <= kRunUpTolerance * std::abs(motion.peaks[0].displacement));
    CHECK(error <= motion.discretisation_error);
    CHECK(motion.stops[0].size() > 2);
  }
}

TEST_CASE("A mass that friction holds on a shaken support rides along through a run-up") {
  using namespace mechanics;
  const Node mass{NodeKind::mass, 0}, support{NodeKind::prescribed, 0};
  const Network network{.masses = {"x"},
                        .prescribed = {"y"},
                        .elements = {{"spring", ElementType::spring, Node{}, mass},
                                     {"grip", ElementType::coulomb, support, mass}},
                        .excitations = {{ExcitationKind::motion, 0, 1}}};
  const NetworkValues values{.mass = {1.0}, .element = {1.0, 50.0}, .excitation = {{1.0, 0.0}}};
  const double from = 0.5, alpha = 0.1, to = 2.5;
  const ForcedMotion motion =
      forced_motion(network, always(values), {{1.0}, {0.0}},
                    {.from = from, .run_up = {to, alpha}, .duration = (to - from) / alpha, .samples = 201});
  REQUIRE(motion.failure.empty());
  double error = 0.0;
  for (std::size_t i = 0; i < 201; ++i) {
    const double t = motion.history.time[i];
    error = std::max(error,
                     std::abs(motion.history.displacement[0][i] - std::cos(from * t + 0.5 * alpha * t * t)));
  }
  INFO("stairs " << motion.stairs << " stated " << motion.discretisation_error << " true " << error);
  CHECK(motion.discretisation_error <= kRunUpTolerance);
  CHECK(error <= motion.discretisation_error);
  CHECK(motion.stops[0].size() == 1);
}

TEST_CASE("After a run-up the frequency is kept") {
  const mechanics::NetworkValues values = periodic::single_mass_values(1.0, 0.2, 0.0);
  const ForcedOptions options{.from = 0.2, .run_up = {0.7, 0.05}, .duration = 210.0, .samples = 421};
  const ForcedMotion motion = forced_motion(periodic::single_mass(), always(values), {}, options);
  REQUIRE(motion.failure.empty());
  const auto& x = motion.history.displacement[0];
  const double expected = 1.0 / std::hypot(1.0 - 0.49, 2.0 * 0.2 * 0.7);
  const double largest = *std::max_element(x.end() - 100, x.end());
  CHECK(largest <= expected * (1.0 + 1e-9));
  CHECK(largest > 0.98 * expected);  // samples half a second apart miss the maximum by a little
  CHECK(motion.frequency.back() == Approx(0.7).epsilon(1e-14));
}

TEST_CASE("A transient of more steps than anyone waits for fails at once with its reason") {
  const mechanics::NetworkValues values = periodic::single_mass_values(1.0, 0.1, 0.1);
  const ForcedMotion motion =
      forced_motion(periodic::single_mass(), always(values), {}, {.from = 1.0, .duration = 1e9});
  CHECK_THAT(motion.failure, Catch::Contains("steps"));
}

}  // namespace
}  // namespace frahm::transient::forced_motion_test
