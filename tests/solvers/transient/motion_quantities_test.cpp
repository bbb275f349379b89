#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "solvers/transient/forced_motion.hpp"

// The quantities of forced motions against closed forms and densely sampled histories.
namespace frahm::transient::motion_quantities_test {
namespace {

using Catch::Matchers::WithinAbs, Catch::Matchers::WithinRel;
using namespace mechanics;
using enum MotionMeasure;

constexpr double kExact = 1e-11;   // relative, of closed forms over some periods
constexpr double kSampled = 1e-9;  // relative, of parabolas through samples ten thousand to a period apart
constexpr double kBalanced = 1e-10;

const Node ground{};

Network oscillator() {
  Network network;
  network.masses = {"mass"};
  const Node mass{NodeKind::mass, 0};
  network.elements = {{"spring", ElementType::spring, ground, mass},
                      {"friction", ElementType::coulomb, ground, mass}};
  network.excitations = {{.kind = ExcitationKind::force, .node = 0, .order = 1},
                         {.kind = ExcitationKind::force, .node = 0, .order = 0}};
  return network;
}

// Of the oscillator: spring, friction, amplitude of the force at omega = 1, constant force.
NetworkValues values(double k, double F, double P, double constant) {
  return {.omega = 1.0, .mass = {1.7}, .element = {k, F}, .excitation = {{P}, {constant}}};
}

std::vector<double> numbers_of(const Network& network, const NetworkValues& at, const InitialState& initial,
                               double duration, const std::vector<MotionQuantity>& quantities) {
  const ForcedMotion motion =
      forced_motion(network, [&](double) { return at; }, initial,
                    {.from = at.omega, .duration = duration, .quantities = quantities});
  REQUIRE(motion.failure.empty());
  REQUIRE(motion.numbers.size() == quantities.size());
  return motion.numbers;
}

// x = (P/k) (1 - cos w t)
TEST_CASE("The peaks of a mass under a force that is suddenly there are those of the closed form") {
  const double m = 1.7, k = 3.1, P = 0.7, w = std::sqrt(k / m), static_x = P / k;
  const double duration = 2.6 * std::numbers::pi / w;
  const auto found = numbers_of(oscillator(), values(k, 0.0, 0.0, P), {}, duration,
                                {{peak},
                                 {peak_time},
                                 {velocity_peak},
                                 {acceleration_peak},
                                 {residual},
                                 {stroke, 0},
                                 {energy_input},
                                 {energy_balance},
                                 {status},
                                 {pseudo_velocity},
                                 {pseudo_acceleration}});
  CHECK_THAT(found[0], WithinRel(2.0 * static_x, kExact));
  CHECK_THAT(found[1], WithinRel(std::numbers::pi / w, kExact));
  CHECK_THAT(found[2], WithinRel(static_x * w, kExact));
  CHECK_THAT(found[3], WithinRel(P / m, kExact));
  CHECK_THAT(found[4], WithinRel(static_x * (1.0 - std::cos(w * duration)), kExact));
  CHECK_THAT(found[5], WithinRel(2.0 * static_x, kExact));
  CHECK_THAT(found[6], WithinRel(P * static_x * (1.0 - std::cos(w * duration)), kExact));
  CHECK(found[7] < kBalanced);
  CHECK(found[8] == 1.0);
  CHECK_THAT(found[9], WithinRel(2.0 * static_x * w, kExact));
  CHECK_THAT(found[10], WithinRel(2.0 * P / m, kExact));
}

// Thrown with v0 it turns at A = sqrt(x_f^2 + (v0/w)^2) - x_f, x_f = F/k, where its acceleration jumps from
// (k A + F)/m to (k A - F)/m; for x_f < A < 3 x_f it rests at 2 x_f - A.
TEST_CASE("The largest acceleration is the limit of the jump where friction turns over") {
  const double m = 1.7, k = 3.1, F = 0.4, w = std::sqrt(k / m), x_f = F / k, v0 = 3.0 * x_f * w;
  const double A = std::sqrt(x_f * x_f + v0 * v0 / (w * w)) - x_f;
  REQUIRE(A > x_f);
  REQUIRE(A < 3.0 * x_f);
  const auto found = numbers_of(oscillator(), values(k, F, 0.0, 0.0), {{0.0}, {v0}}, 20.0,
                                {{peak},
                                 {acceleration_peak},
                                 {residual},
                                 {slips, 1},
                                 {energy, 1},
                                 {energy_share, 1},
                                 {final_energy},
                                 {velocity_peak}});
  const double rest = 2.0 * x_f - A;
  CHECK_THAT(found[0], WithinRel(A, kExact));
  CHECK_THAT(found[1], WithinRel((k * A + F) / m, kExact));
  CHECK_THAT(found[2], WithinAbs(rest, kExact * A));
  CHECK(found[3] == 1.0);  // a reversal without a stop is one phase
  CHECK_THAT(found[4], WithinRel(F * (A + 2.0 * (A - x_f)), kExact));
  CHECK(found[5] == 1.0);
  CHECK_THAT(found[6], WithinAbs(0.5 * k * rest * rest, kExact * k * A * A));
  CHECK_THAT(found[7], WithinRel(v0, kExact));
}

TEST_CASE(
    "A contact that never lets go has no slip phase, and one that slides at first has one more than "
    "releases") {
  const MotionQuantity contact{slips, 1};
  CHECK(numbers_of(oscillator(), values(3.1, 0.5, 0.4, 0.0), {}, 60.0, {contact})[0] == 0.0);
  const NetworkValues stops = values(40.0, 0.5, 0.6, 0.0);  // slow and stiff: it stops at every turn
  const ForcedMotion motion =
      forced_motion(oscillator(), [&](double) { return stops; }, {}, {.from = 1.0, .duration = 60.0});
  const auto released = std::ranges::count_if(motion.stops[0], [](const Stop& s) { return s.release > 0.0; });
  REQUIRE(released > 5);
  REQUIRE(motion.stops[0].front().onset > 0.0);
  CHECK(numbers_of(oscillator(), stops, {}, 60.0, {contact})[0] == static_cast<double>(released + 1));
}

// A chain that slips here and there, shaken at its base and its end.
struct Chain {
  static constexpr std::size_t masses = 4;
  Network network;
  NetworkValues values;

  Chain() {
    values.omega = 1.3;
    network.prescribed = {"base"};
    const Node base{NodeKind::prescribed, 0};
    Node below = base;
    for (std::size_t i = 0; i < masses; ++i) {
      const Node here{NodeKind::mass, i};
      const std::string number = std::to_string(i);
      network.masses.push_back("m" + number);
      values.mass.push_back(1.0 + 0.2 * static_cast<double>(i));
      network.elements.emplace_back("spring" + number, ElementType::spring, below, here);
      values.element.push_back(9.0 - static_cast<double>(i));
      network.elements.emplace_back("damper" + number, ElementType::damper, below, here);
      values.element.push_back(0.1);
      if (i % 2 == 0) {
        network.elements.emplace_back("friction" + number, ElementType::coulomb, below, here);
        values.element.push_back(0.25);
      }
      below = here;
    }
    network.excitations = {{.kind = ExcitationKind::motion, .node = 0, .order = 1},
                           {.kind = ExcitationKind::force, .node = masses - 1, .order = 2}};
    values.excitation = {{0.3}, {0.4, 0.7}};
    network.signals = {{.name = "drift", .along = {{base, -1.0}, {{NodeKind::mass, 2}, 1.0}}}};
  }
};

// The vertex of the parabola through value, slope and curvature of the largest sample.
double vertex(const std::vector<double>& x, const std::vector<double>& v, const std::vector<double>& a) {
  const auto most = std::ranges::max_element(x, {}, [](double each) { return std::abs(each); }) - x.begin();
  const auto i = static_cast<std::size_t>(most);
  return std::abs(x[i] - 0.5 * v[i] * v[i] / a[i]);
}

TEST_CASE("The peaks of a chain that sticks and slips are those of its densely sampled history") {
  const Chain chain;
  constexpr double duration = 30.0;
  constexpr int samples = 300'001;
  const auto at = [&](double) { return chain.values; };
  const ForcedMotion history =
      forced_motion(chain.network, at, {}, {.from = 1.3, .duration = duration, .samples = samples});
  REQUIRE(history.failure.empty());
  std::vector<MotionQuantity> quantities;
  for (std::size_t i = 0; i <= Chain::masses; ++i)
    quantities.insert(quantities.end(),
                      {{peak, i}, {peak_time, i}, {velocity_peak, i}, {acceleration_peak, i}});
  const auto found = numbers_of(chain.network, chain.values, {}, duration, quantities);
  for (std::size_t i = 0; i <= Chain::masses; ++i) {
    INFO("coordinate " << i);
    const Samples& h = history.history;
    const double exact = vertex(h.displacement[i], h.velocity[i], h.acceleration[i]);
    CHECK_THAT(found[4 * i], WithinRel(exact, kSampled));
    CHECK(found[4 * i] == std::abs(history.peaks[i].displacement));
    CHECK(found[4 * i + 1] == history.peaks[i].time);
    const auto largest = [](const std::vector<double>& of) {
      return std::abs(*std::ranges::max_element(of, {}, [](double each) { return std::abs(each); }));
    };
    // Samples 1e-4 apart lie below a peak by less than 1e-7 of it, and below the limit of a jump by its
    // slope's share of that time.
    CHECK(found[4 * i + 2] >= largest(h.velocity[i]) * (1.0 - 1e-14));
    CHECK_THAT(found[4 * i + 2], WithinRel(largest(h.velocity[i]), 1e-6));
    CHECK(found[4 * i + 3] >= largest(h.acceleration[i]) * (1.0 - 1e-12));
    CHECK_THAT(found[4 * i + 3], WithinRel(largest(h.acceleration[i]), 2e-3));
  }
}

TEST_CASE("The root mean squares of a chain that sticks and slips are those of its densely sampled history") {
  const Chain chain;
  constexpr double duration = 30.0, of_samples = 1e-6;  // the rectangles' error at 1e-4 s
  const auto at = [&](double) { return chain.values; };
  const ForcedMotion history =
      forced_motion(chain.network, at, {}, {.from = 1.3, .duration = duration, .samples = 300'001});
  REQUIRE(history.failure.empty());
  const auto root_mean_square = [](const std::vector<double>& values) {
    double sum = -0.5 * (values.front() * values.front() + values.back() * values.back());
    for (const double value : values) sum += value * value;
    return std::sqrt(sum / static_cast<double>(values.size() - 1));
  };
  for (std::size_t i = 0; i <= Chain::masses; ++i) {
    const auto found = numbers_of(chain.network, chain.values, {}, duration, {{rms, i}, {velocity_rms, i}});
    CHECK_THAT(found[0], WithinRel(root_mean_square(history.history.displacement[i]), of_samples));
    CHECK_THAT(found[1], WithinRel(root_mean_square(history.history.velocity[i]), of_samples));
  }
}

TEST_CASE("A quantity of a motion does not depend on what else is asked") {
  const Chain chain;
  const std::vector<MotionQuantity> all = all_motion_quantities(chain.network, false);
  const auto together = numbers_of(chain.network, chain.values, {}, 12.0, all);
  for (std::size_t q = 0; q < all.size(); ++q) {
    INFO(describe(all[q], chain.network, false).name);
    CHECK(numbers_of(chain.network, chain.values, {}, 12.0, {all[q]})[0] == together[q]);
  }
}

TEST_CASE("A run-up tells the peaks of its finest stairs and their error") {
  const Chain chain;
  const std::vector<MotionQuantity> asked{{peak, 3}, {discretisation_error}, {energy_balance}};
  const auto at = [&](double omega) {
    NetworkValues here = chain.values;
    here.omega = omega;
    return here;
  };
  ForcedOptions options{.from = 0.4, .run_up = {.to = 1.4, .rate = 0.05}, .duration = 20.0, .samples = 101};
  const ForcedMotion single = forced_motion(chain.network, at, {}, options);
  options.quantities = asked;
  const ForcedMotion asked_alone = forced_motion(chain.network, at, {}, options);
  CHECK(asked_alone.numbers[0] == std::abs(single.peaks[3].displacement));
  CHECK(asked_alone.numbers[1] == single.discretisation_error);
  CHECK(asked_alone.numbers[2] == single.energy.balance);
}

}  // namespace
}  // namespace frahm::transient::motion_quantities_test
