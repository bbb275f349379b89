#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "solvers/laws/damper_bend.hpp"
#include "solvers/transient/forced_motion.hpp"
#include "tests/known_answers/event_integrator.hpp"
#include "tests/known_answers/responses.hpp"

// A block on a belt of constant speed V, held by a spring k. It rides until the spring pulls as hard as
// friction holds, k x = f_s, slides back against f_k, and is caught where its velocity is V again. With D =
// (f_s - f_k)/k and w = sqrt(k/m):
//   x - f_k/k = D cos wt + (V/w) sin wt while it slides;  T = 2 D/V + (2/w)(pi - atan(w D/V))
namespace frahm::periodic::belt_test {
namespace {

using Catch::Matchers::WithinAbs, Catch::Matchers::WithinRel;
using namespace mechanics;
using transient::forced_motion, transient::ForcedMotion;

constexpr double kExact = 1e-10;    // relative, of the exact flow
constexpr double kBalance = 1e-10;  // of the energy
constexpr double kClosure = 1e-8;   // of a motion after its period, relative
constexpr double kSmoothed = 1e-4;  // of the arctan law of slope 1e5, relative

const Node ground{}, block{NodeKind::mass, 0}, belt{NodeKind::prescribed, 0};

Network block_on_belt(bool has_static_force) {
  Network network{.masses = {"block"},
                  .prescribed = {"belt"},
                  .elements = {{"spring", ElementType::spring, ground, block},
                               {"friction", ElementType::coulomb, belt, block}},
                  .excitations = {{ExcitationKind::belt, 0, 0}}};
  network.elements[1].has_static_force = has_static_force;
  return network;
}

struct Block {
  double m = 1.0, k = 1.0, V = 0.1, f_k = 0.2, f_s = 0.5;

  NetworkValues values() const {
    return {.omega = 0.7, .mass = {m}, .element = {k, f_k}, .excitation = {{V, 0.0}}, .second = {0.0, f_s}};
  }
  double w() const { return std::sqrt(k / m); }
  double D() const { return (f_s - f_k) / k; }
  double stick() const { return 2.0 * D() / V; }
  double period() const { return stick() + 2.0 / w() * (std::numbers::pi - std::atan(w() * D() / V)); }
  double amplitude() const { return std::hypot(D(), V / w()); }
};

TEST_CASE("A block on a belt sticks and slips with the period and the amplitude of the closed form") {
  for (const Block& of : {Block{}, Block{2.0, 800.0, 0.05, 3.0, 8.0}, Block{1.0, 1.0, 2.0, 0.5, 0.51}}) {
    INFO("V " << of.V << " k " << of.k);
    const NetworkValues values = of.values();
    const ForcedMotion motion =
        forced_motion(block_on_belt(true), [&](double) { return values; }, {{0.0}, {of.V}},
                      {.from = values.omega, .duration = 20.0 * of.period()});
    REQUIRE(motion.failure.empty());
    const auto& stops = motion.stops[0];
    REQUIRE(stops.size() > 15);
    CHECK_THAT(stops[0].release, WithinRel(of.f_s / (of.k * of.V), kExact));
    for (std::size_t i = 1; i + 1 < stops.size(); ++i) {
      CHECK_THAT(stops[i].release - stops[i - 1].release, WithinRel(of.period(), kExact));
      CHECK_THAT(stops[i].release - stops[i].onset, WithinRel(of.stick(), kExact));
    }
    CHECK_THAT(motion.peaks[0].displacement, WithinRel(of.f_k / of.k + of.amplitude(), kExact));
    CHECK(motion.energy.balance < kBalance);
    CHECK(motion.energy.dissipated[1] > 0.0);
  }
}

// The belt drags with 0.5, the ground holds with 0.2: from rest x = -0.3 (1 - cos t) until the block stands
// at -0.6 for ever, where the spring, the belt and the ground balance. Nothing but the belt moves it.
TEST_CASE("A block that a belt alone drags over rubbing ground comes to rest") {
  Network network = block_on_belt(false);
  network.elements.push_back({"ground", ElementType::coulomb, ground, block});
  const NetworkValues values{
      .omega = 0.5, .mass = {1.0}, .element = {1.0, 0.5, 0.2}, .excitation = {{-0.4, 0.0}}};
  const ForcedMotion motion = forced_motion(network, [&](double) { return values; }, {},
                                            {.from = 0.5, .duration = 20.0, .samples = 21});
  REQUIRE(motion.failure.empty());
  for (std::size_t i = 0; i < motion.history.time.size(); ++i) {
    const double t = std::min(motion.history.time[i], std::numbers::pi);
    CHECK_THAT(motion.history.displacement[0][i], WithinAbs(-0.3 * (1.0 - std::cos(t)), kExact));
  }
  CHECK(motion.energy.balance < kBalance);
}

// Over whole periods the belt's work is what friction takes: f_k times the way it slides, D D' = V slip + 2
// D.
TEST_CASE("The belt puts in what friction takes and the spring and the block have") {
  const Block of;
  const NetworkValues values = of.values();
  const auto motion_of = [&](double periods) {
    return forced_motion(block_on_belt(true), [&](double) { return values; }, {{of.f_s / of.k}, {of.V}},
                         {.from = values.omega, .duration = periods * of.period()});
  };
  const ForcedMotion once = motion_of(1.0), thrice = motion_of(3.0);
  const double slip = of.period() - of.stick();
  const double lost = of.f_k * (of.V * slip + 2.0 * of.D());
  CHECK_THAT(once.energy.dissipated[1], WithinRel(lost, kExact));
  CHECK_THAT(thrice.energy.input, WithinRel(3.0 * lost, kExact));
  CHECK_THAT(thrice.energy.final, WithinRel(thrice.energy.initial, kExact));
}

// A belt faster than the block ever is: friction is the constant f_k, a damper to it pulls with c V.
TEST_CASE("Under a fast belt the block swings about where friction and dampers pull it") {
  Network network = block_on_belt(false);
  network.elements.push_back({"damper", ElementType::damper, belt, block});
  network.elements.push_back({"table", ElementType::damper, belt, block});
  network.elements[3].bends = {{1.0, &laws::damper_bend}, {-1.0, &laws::damper_bend}};
  const double V = 3.0, c = 0.2, D = 0.5, c_1 = 0.1, c_2 = 0.3;
  const NetworkValues values{.omega = 1.0,
                             .mass = {1.0},
                             .element = {2.0, 0.4, c, c_1},
                             .excitation = {{V, 0.0}},
                             .bends = {{}, {}, {}, {{D, 0.0, c_2}, {D, 0.0, c_2}}}};
  const ForcedMotion motion = forced_motion(network, [&](double) { return values; }, {},
                                            {.from = 1.0, .duration = 400.0, .samples = 3});
  REQUIRE(motion.failure.empty());
  const double pull = 0.4 + c * V + c_1 * V + c_2 * (V - D);
  CHECK_THAT(motion.history.displacement[0].back(), WithinRel(pull / 2.0, kExact));
  CHECK(motion.energy.balance < kBalance);
}

Network driven_block(bool has_static_force) {
  Network network = block_on_belt(has_static_force);
  network.elements.push_back({"damper", ElementType::damper, ground, block});
  network.elements.push_back({"leash", ElementType::jenkins, belt, block});
  network.excitations.push_back({ExcitationKind::force, 0, 1});
  return network;
}

NetworkValues drive(double r, double V, double f_s) {
  return {.omega = r,
          .mass = {1.0},
          .element = {1.0, 0.3, 0.2, 0.5},
          .excitation = {{V, 0.0}, {1.0, 0.0}},
          .second = {0.0, f_s, 0.0, 0.1}};
}

TEST_CASE("A driven block on a belt has the periodic motion that the independent integration returns to") {
  for (const double f_s : {0.0, 0.45}) {
    Responses responses(driven_block(f_s > 0.0));
    for (const double V : {0.05, 0.4, -0.8}) {
      for (const double r : {0.31, 0.8, 1.7}) {
        INFO("f_s " << f_s << " V " << V << " r " << r);
        const NetworkValues values = drive(r, V, f_s);
        const ResponseSummary summary = responses.solve(values);
        INFO(summary.reason);
        REQUIRE(has_response(summary.status));
        CHECK(responses["energy_balance"] < kBalance);
        if (f_s == 0.0) CHECK(responses["error_bound"] < kExact);
        const Assembly assembly(driven_block(f_s > 0.0));
        LinearSystem system;
        assembly.set_values(values, system);
        assembly.set_forcing(values, system);
        const History start = responses.response().history(phases_of_a_period(2));
        const auto at_start = [&](std::size_t column) {
          return Eigen::VectorXd::Constant(1, start.columns[column][0]);
        };
        EventIntegrator reference(system);
        reference.start(0.0, at_start(0), at_start(1), at_start(2 + 3));
        reference.advance_to(summary.multiple * 2.0 * std::numbers::pi / r);
        CHECK_THAT(reference.displacements()[0], WithinAbs(start.columns[0][0], kClosure));
        CHECK_THAT(reference.velocities()[0], WithinAbs(start.columns[1][0], kClosure));
        // The belt takes its two elements' forces, at most f_s + F.
        CHECK(responses["belt_transmitted_force"] <= std::max(f_s, 0.3) + 0.1 + kExact);
        CHECK(responses["belt_transmitted_force"] >= 0.4 - kExact);
      }
    }
  }
}

TEST_CASE("A strip that never stands still has no stroke on the belt") {
  const Network network = driven_block(false);
  CHECK_FALSE(find_quantity("friction_stroke", network));
  CHECK_FALSE(find_quantity("leash_phase", network));
  CHECK(find_quantity("friction_force_peak", network));
  CHECK(find_quantity("damper_stroke", network));
}

TEST_CASE("The smoothed law on a belt differs from the exact one as its slope lets it") {
  Network exact = block_on_belt(false), smooth = exact;
  for (Network* network : {&exact, &smooth}) network->excitations.push_back({ExcitationKind::force, 0, 1});
  for (Network* network : {&exact, &smooth})
    network->elements.push_back({"damper", ElementType::damper, ground, block});
  smooth.elements[1].law = ForceLaw::arctan;
  NetworkValues values = drive(0.8, 0.3, 0.0);
  values.element = {1.0, 0.3, 0.2};
  Responses of_exact(exact), of_smooth(smooth);
  of_exact.solve(values);
  values.smooth = {{}, {.slope = 1e5}, {}};
  of_smooth.solve(values);
  CHECK_THAT(of_smooth["block_peak"], WithinRel(of_exact["block_peak"], kSmoothed));
  CHECK_THAT(of_smooth["energy_input"], WithinRel(of_exact["energy_input"], kSmoothed));
}

// With u = x - V t:  m u'' + c u' + k u = P cos(omega t), u(0) = 0, u'(0) = -V.
TEST_CASE("A mass pulled through a spring and a damper swings about where the belt is") {
  Network network{
      .masses = {"block"},
      .prescribed = {"belt"},
      .elements = {{"rope", ElementType::spring, belt, block}, {"damper", ElementType::damper, belt, block}},
      .excitations = {{ExcitationKind::belt, 0, 0}, {ExcitationKind::force, 0, 1}},
      .signals = {{"lag", between(belt, block)}}};
  const double m = 2.0, k = 8.0, c = 0.4, V = 0.7, omega = 1.3;
  for (const double P : {0.0, 0.5}) {
    const NetworkValues values{
        .omega = omega, .mass = {m}, .element = {k, c}, .excitation = {{V, 0.0}, {P, 0.0}}};
    const ForcedMotion motion = forced_motion(network, [&](double) { return values; }, {},
                                              {.from = omega, .duration = 30.0, .samples = 61});
    REQUIRE(motion.failure.empty());
    CHECK(motion.energy.balance < kBalance);
    const double b = c / (2.0 * m), w = std::sqrt(k / m - b * b);
    const std::complex<double> X = P / std::complex<double>(k - m * omega * omega, c * omega);
    const double A = -X.real(), B = (-V + omega * X.imag() + b * A) / w;
    for (std::size_t i = 0; i < motion.history.time.size(); ++i) {
      const double t = motion.history.time[i];
      const double u = std::exp(-b * t) * (A * std::cos(w * t) + B * std::sin(w * t)) +
                       (X * std::polar(1.0, omega * t)).real();
      CHECK_THAT(motion.history.displacement[0][i], WithinAbs(V * t + u, 1e-12));
      CHECK_THAT(motion.history.displacement[1][i], WithinAbs(u, 1e-12));
    }
  }
}

}  // namespace
}  // namespace frahm::periodic::belt_test
