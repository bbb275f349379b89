#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "solvers/identification/decay_extrema.hpp"
#include "solvers/identification/free_decay.hpp"
#include "solvers/identification/log_decrement.hpp"
#include "solvers/transient/free_decay.hpp"
#include "tests/known_answers/free_oscillator.hpp"
#include "tests/solvers/coverage.hpp"

// Methods for free vibration, on decays that the engine makes.
namespace frahm::identification::measured_decay_test {
namespace {

using Catch::Matchers::WithinAbs, Catch::Matchers::WithinRel, Catch::Matchers::Contains;
using std::numbers::pi;
using transient::FreeOscillator;

constexpr double kExact = 1e-10;
constexpr double kExtremum = 1e-11;  // of the first displacement, from 60 samples a period on
// [s] of a period of 1.26 s: the last turns are a hundredth of the first, where an error of the displacement
// counts so much more.
constexpr double kTurn = 2e-10;

struct Trace {
  std::vector<double> time, displacement;
};

// Let go at 1; `periods` long.
Trace trace_of(const FreeOscillator& oscillator, double periods, double samples_a_period) {
  const double duration = periods * 2.0 * oscillator.half_period();
  const auto decay = transient::free_decay(
      oscillator.network(), oscillator.values(), {{1.0}, {}},
      {.duration = duration, .samples = static_cast<int>(periods * samples_a_period) + 1});
  return {decay.history.time, decay.history.displacement[0]};
}

DecayExtrema exact_extrema(const FreeOscillator& oscillator, std::size_t count) {
  DecayExtrema extrema;
  extrema.displacement = oscillator.turning_points(1.0, count);
  for (std::size_t i = 0; i < extrema.displacement.size(); ++i)
    extrema.time.push_back(static_cast<double>(i) * oscillator.half_period());
  return extrema;
}

TEST_CASE("Turning points of a sampled decay are those of the recursion, with friction and without") {
  for (const double zeta : {0.0, 0.01, 0.05, 0.2}) {
    for (const double x_f : {0.0, 0.01}) {
      for (const double samples : {60.0, 100.0, 333.3}) {
        const FreeOscillator oscillator{.m = 2.0, .k = 50.0, .zeta = zeta, .x_f = x_f};
        const Trace trace = trace_of(oscillator, 6.3, samples);
        const FoundExtrema found = find_extrema(trace.time, trace.displacement);
        INFO("zeta " << zeta << " x_f " << x_f << " samples " << samples << " " << found.failure);
        REQUIRE(found.failure == "");
        const auto expected = oscillator.turning_points(1.0, 100);
        REQUIRE(found.extrema.displacement.size() >= 4);
        double error = 0.0, late = 0.0;
        for (std::size_t i = 0; i < found.extrema.displacement.size(); ++i) {
          error = std::max(error, std::abs(found.extrema.displacement[i] - expected[i + 1]));
          late = std::max(
              late, std::abs(found.extrema.time[i] - static_cast<double>(i + 1) * oscillator.half_period()));
        }
        CHECK(error < kExtremum);
        CHECK(late < kTurn);
        CHECK(found.extrema.displacement_sigma.size() == found.extrema.displacement.size());
      }
    }
  }
}

TEST_CASE("What turns no more ends the extremes: a rest, the noise, the ends of the record") {
  const FreeOscillator oscillator{.m = 2.0, .k = 50.0, .zeta = 0.05, .x_f = 0.03};
  const auto expected = oscillator.turning_points(1.0, 100);
  const Trace trace = trace_of(oscillator, 12.0, 80.0);  // rests after four
  REQUIRE(expected.size() < 10);
  const FoundExtrema exact = find_extrema(trace.time, trace.displacement);
  // Without the release at the first sample, and the arrival at rest.
  CHECK(exact.extrema.displacement.size() == expected.size() - 2);
  CHECK(exact.noise < 1e-12);
  const FoundExtrema noisy = find_extrema(trace.time, Noise(1).on(trace.displacement, 0.01));
  CHECK(noisy.extrema.displacement.size() < exact.extrema.displacement.size());
  CHECK_THAT(noisy.noise, WithinRel(0.01, 0.15));  // of some 300 samples: 4 % is its standard deviation
  for (std::size_t i = 0; i < noisy.extrema.displacement.size(); ++i) {
    constexpr double kErrors = 4.0;
    CHECK_THAT(noisy.extrema.displacement[i],
               WithinAbs(expected[i + 1], kErrors * noisy.extrema.displacement_sigma[i]));
    CHECK_THAT(noisy.extrema.time[i], WithinAbs(static_cast<double>(i + 1) * oscillator.half_period(),
                                                kErrors * noisy.extrema.time_sigma[i]));
  }
}

TEST_CASE("Turning points of a noisy trace do not hang on rounding: other units of length, the same turns") {
  constexpr double kSame = 1e-9;  // the shift between fits of another degree is some 1e-3 of a half period
  const FreeOscillator oscillator{.m = 2.0, .k = 50.0, .zeta = 0.02, .x_f = 0.01};
  const Trace trace = trace_of(oscillator, 6.3, 60.0);
  for (int seed = 1; seed <= 20; ++seed) {
    const std::vector<double> noisy = Noise(seed).on(trace.displacement, 0.001);
    const FoundExtrema found = find_extrema(trace.time, noisy);
    for (const double unit : {1.0 / 3.0, 0.0254, 1.1}) {
      std::vector<double> scaled = noisy;
      for (double& x : scaled) x *= unit;
      const FoundExtrema again = find_extrema(trace.time, scaled);
      INFO("noise " << seed << ", unit " << unit);
      REQUIRE(again.extrema.time.size() == found.extrema.time.size());
      for (std::size_t i = 0; i < again.extrema.time.size(); ++i) {
        CHECK_THAT(again.extrema.time[i], WithinAbs(found.extrema.time[i], kSame));
        CHECK_THAT(again.extrema.displacement[i] / unit, WithinAbs(found.extrema.displacement[i], kSame));
      }
    }
  }
}

TEST_CASE("The logarithmic decrement of a viscous decay gives back the damping ratio, exactly") {
  for (const double zeta : {0.002, 0.05, 0.3}) {
    const FreeOscillator oscillator{.m = 2.0, .k = 50.0, .zeta = zeta};
    const Trace trace = trace_of(oscillator, 5.3, 100.0);
    const double delta = 2.0 * pi * zeta / oscillator.s();
    INFO("zeta " << zeta);
    const Identification all = log_decrement(trace.time, trace.displacement, std::nullopt);
    REQUIRE(all.failure == "");
    CHECK_THAT(value_of(all, "damping_ratio"), WithinAbs(zeta, kExact));
    CHECK_THAT(value_of(all, "natural_frequency"), WithinRel(5.0, kExact));
    const Identification two = log_decrement(trace.time, trace.displacement, 2);
    REQUIRE(two.failure == "");
    for (const char* suffix : {"", "_over_cycles"}) {
      const std::string of = suffix;
      CHECK_THAT(value_of(two, "log_decrement" + of), WithinAbs(delta, kExact));
      CHECK_THAT(value_of(two, "damping_ratio" + of), WithinAbs(zeta, kExact));
      CHECK_THAT(value_of(two, "damping_ratio_first_order" + of), WithinAbs(delta / (2.0 * pi), kExact));
    }
    CHECK_THAT(value_of(two, "damped_frequency"), WithinRel(pi / oscillator.half_period(), kExact));
    CHECK(two.records[0].at.size() == 5);
  }
}

TEST_CASE("Viscous damping and friction come out of a decay exactly, each alone and together") {
  for (const double zeta : {0.0, 0.004, 0.05, 0.15}) {
    for (const double x_f : {0.0, 0.003, 0.02}) {
      if (zeta + x_f == 0.0) continue;
      const FreeOscillator oscillator{.m = 2.0, .k = 50.0, .zeta = zeta, .x_f = x_f};
      const Trace trace = trace_of(oscillator, 5.3, 100.0);
      INFO("zeta " << zeta << " x_f " << x_f);
      const Identification result =
          free_decay(trace.time, trace.displacement, {.known = {.mass = 2.0, .stiffness = {}}});
      REQUIRE(result.failure == "");
      CHECK_THAT(value_of(result, "damping_ratio"), WithinAbs(zeta, kExact));
      CHECK_THAT(value_of(result, "friction_displacement"), WithinAbs(x_f, kExact));
      CHECK_THAT(value_of(result, "damping_ratio_first"), WithinAbs(zeta, kExact));
      CHECK_THAT(value_of(result, "friction_displacement_first"), WithinAbs(x_f, kExact));
      CHECK_THAT(value_of(result, "natural_frequency"), WithinRel(5.0, kExact));
      CHECK_THAT(value_of(result, "stiffness"), WithinRel(50.0, kExact));
      CHECK_THAT(value_of(result, "damping"), WithinAbs(2.0 * zeta * 10.0, 20.0 * kExact));
      CHECK_THAT(value_of(result, "friction_force"), WithinAbs(50.0 * x_f, 50.0 * kExact));
    }
  }
}

TEST_CASE("A decay that does not decay cannot tell damping from negative friction, and says so") {
  const Trace trace = trace_of({.m = 2.0, .k = 50.0}, 5.3, 100.0);
  const Identification result = free_decay(trace.time, trace.displacement, {});
  REQUIRE(result.failure == "");
  for (const char* name : {"damping_ratio", "friction_displacement", "damping_ratio_first"}) {
    CHECK(std::isnan(value_of(result, name)));
    CHECK(std::isinf(estimate_of(result, name).high));
  }
  CHECK_THAT(value_of(result, "damped_frequency"), WithinRel(5.0, kExact));
  REQUIRE(result.notes.size() == 2);
  CHECK_THAT(result.notes[0], Contains("cannot be distinguished"));
  const Identification viscous = log_decrement(trace.time, trace.displacement, std::nullopt);
  REQUIRE(viscous.failure == "");
  CHECK_THAT(value_of(viscous, "damping_ratio"), WithinAbs(0.0, kExact));
  CHECK_THAT(value_of(viscous, "natural_frequency"), WithinRel(5.0, kExact));
}

TEST_CASE("A sensor's offset is told from friction, and a stiffness gives mass, damping and force") {
  const FreeOscillator oscillator{.m = 2.0, .k = 50.0, .zeta = 0.03, .x_f = 0.01};
  Trace trace = trace_of(oscillator, 5.3, 100.0);
  for (double& x : trace.displacement) x += 0.07;
  const Identification result = free_decay(trace.time, trace.displacement,
                                           {.known = {.mass = {}, .stiffness = 50.0}, .sensor_offset = true});
  REQUIRE(result.failure == "");
  CHECK_THAT(value_of(result, "offset"), WithinAbs(0.07, kExact));
  CHECK_THAT(value_of(result, "damping_ratio"), WithinAbs(0.03, kExact));
  CHECK_THAT(value_of(result, "friction_displacement"), WithinAbs(0.01, kExact));
  CHECK_THAT(value_of(result, "mass"), WithinRel(2.0, kExact));
  CHECK_THAT(value_of(result, "damping"), WithinRel(0.6, 1e-8));
  CHECK_THAT(value_of(result, "friction_force"), WithinRel(0.5, 1e-8));
}

TEST_CASE("Extremes that others have read need no times, and as many as unknowns give no interval") {
  const FreeOscillator oscillator{.m = 2.0, .k = 50.0, .zeta = 0.03, .x_f = 0.01};
  DecayExtrema extrema = exact_extrema(oscillator, 3);
  const Identification timed = free_decay(extrema, {});
  REQUIRE(timed.failure == "");
  CHECK_THAT(value_of(timed, "damping_ratio"), WithinAbs(0.03, kExact));
  CHECK(std::isnan(estimate_of(timed, "damping_ratio").high));
  CHECK_THAT(value_of(timed, "natural_frequency"), WithinRel(5.0, kExact));
  extrema.time.clear();
  const Identification untimed = free_decay(extrema, {});
  REQUIRE(untimed.failure == "");
  CHECK(untimed.estimates.size() == timed.estimates.size() - 2);
  CHECK_THAT(value_of(untimed, "friction_displacement"), WithinAbs(0.01, kExact));
  CHECK_THAT(free_decay(extrema, {.known = {.mass = 1.0, .stiffness = {}}}).failure,
             Contains("have no times"));
  // Standard errors of the extremes themselves take the place of residuals.
  extrema.displacement_sigma.assign(3, 1e-3);
  extrema.degrees_of_freedom = 50.0;
  const Identification weighed = free_decay(extrema, {});
  CHECK(estimate_of(weighed, "damping_ratio").standard_error > 1e-5);
  CHECK(holds(weighed, "damping_ratio", 0.03));
  const Identification logarithm = log_decrement(extrema, std::nullopt);
  CHECK(logarithm.failure == "");
}

TEST_CASE("Of a hundred noisy viscous decays the decrement's intervals hold the truth in ninety at least") {
  const FreeOscillator oscillator{.m = 2.0, .k = 50.0, .zeta = 0.02};
  const double delta = 2.0 * pi * 0.02 / oscillator.s();
  const Trace trace = trace_of(oscillator, 12.3, 60.0);
  std::vector<Truth> truths{{"log_decrement", delta},
                            {"damping_ratio", 0.02},
                            {"damping_ratio_over_cycles", 0.02},
                            {"natural_frequency", 5.0}};
  count_held(truths, [&](unsigned seed) {
    return log_decrement(trace.time, Noise(seed).on(trace.displacement, 0.005), std::nullopt);
  });
  for (const Truth& truth : truths) {
    INFO(truth.name << " held " << truth.held);
    CHECK(truth.held >= kHeld);
  }
}

TEST_CASE("Of a hundred noisy decays the intervals of damping and friction hold the truth in ninety at least",
          "[slow]") {
  for (const auto& [zeta, x_f] : {std::pair{0.02, 0.008}, {0.0, 0.012}, {0.03, 0.0}}) {
    const FreeOscillator oscillator{.m = 2.0, .k = 50.0, .zeta = zeta, .x_f = x_f};
    const Trace trace = trace_of(oscillator, 10.3, 100.0);
    std::vector<Truth> truths{{"damping_ratio", zeta},
                              {"friction_displacement", x_f},
                              {"natural_frequency", 5.0},
                              {"friction_force", 50.0 * x_f}};
    count_held(truths, [&](unsigned seed) {
      return free_decay(trace.time, Noise(seed).on(trace.displacement, 0.003),
                        {.known = {.mass = {}, .stiffness = 50.0}});
    });
    for (const Truth& truth : truths) {
      INFO("zeta " << zeta << " x_f " << x_f << " " << truth.name << " held " << truth.held);
      CHECK(truth.held >= kHeld);
    }
  }
}

TEST_CASE("A record that tells no damping says why") {
  const Trace trace = trace_of({.m = 2.0, .k = 50.0, .zeta = 0.02}, 5.3, 50.0);
  Trace growing = trace;
  std::reverse(growing.displacement.begin(), growing.displacement.end());
  CHECK_THAT(free_decay(growing.time, growing.displacement, {}).failure, Contains("grows"));
  CHECK_THAT(log_decrement(growing.time, growing.displacement, std::nullopt).failure, Contains("grows"));
  CHECK_THAT(log_decrement(trace.time, trace.displacement, 9).failure, Contains("19 extremes"));
  CHECK_THAT(log_decrement(trace.time, trace.displacement, 0).failure, Contains("0 cycles"));
  Trace wrong = trace;
  wrong.displacement[7] = std::numeric_limits<double>::infinity();
  CHECK_THAT(find_extrema(wrong.time, wrong.displacement).failure, Contains("displacement 8 of"));
  wrong = trace;
  wrong.time[7] = wrong.time[6];
  CHECK_THAT(find_extrema(wrong.time, wrong.displacement).failure, Contains("times must increase"));
  wrong.time.pop_back();
  CHECK_THAT(find_extrema(wrong.time, wrong.displacement).failure, Contains("different lengths"));
  CHECK_THAT(find_extrema(std::vector<double>{0, 1, 2}, std::vector<double>{0, 1, 0}).failure,
             Contains("3 samples"));
  const std::vector<double> still(trace.time.size(), 0.25);
  CHECK_THAT(find_extrema(trace.time, still).failure, Contains("turns 0 times"));
  CHECK_THAT(find_extrema(trace.time, Noise(3).on(still, 0.01)).failure, Contains("turning points"));
  DecayExtrema extrema = exact_extrema({.m = 2.0, .k = 50.0, .zeta = 0.02}, 2);
  CHECK_THAT(free_decay(extrema, {}).failure, Contains("3 extremes"));
  extrema.displacement = {1.0, 0.9, -0.8};
  extrema.time = {0.0, 1.0, 2.0};
  CHECK_THAT(free_decay(extrema, {}).failure, Contains("in turn"));
  extrema.displacement = {1.0, -0.9, 0.8};
  CHECK_THAT(free_decay(extrema, {.known = {.mass = -1.0, .stiffness = {}}}).failure,
             Contains("the mass is -1"));
  CHECK_THAT(free_decay(extrema, {.known = {.mass = 1.0, .stiffness = 1.0}}).failure, Contains("both given"));
}

// A tuned mass of 12.82 kg on 10985.1 N/m that rubs with 15 N, let go at 30 mm, at 500 samples a second with
// noise of 0.02 and 0.005 mm; and a strongly damped one. All of a first displacement of 1.
TEST_CASE(
    "The frequency of a short decay is not biased, and its interval holds the truth as often as it says",
    "[slow]") {
  struct Case {
    FreeOscillator oscillator;
    double periods, samples, noise;
  };
  const double x_f = 15.0109 / 10985.1 / 0.03;
  const FreeOscillator rubs{.m = 12.82, .k = 10985.1, .zeta = 1.3e-5, .x_f = x_f};
  const FreeOscillator damped{.m = 12.82, .k = 10985.1, .zeta = 1.3e-3, .x_f = x_f};
  for (const Case& c : {Case{rubs, 7.0, 107.3, 6.7e-4}, Case{rubs, 7.0, 107.3, 1.7e-4},
                        Case{damped, 7.0, 107.3, 6.7e-4}, Case{{2.0, 50.0, 0.2, 0.003}, 5.0, 100.0, 3e-4}}) {
    const Trace trace = trace_of(c.oscillator, c.periods, c.samples);
    const double omega = std::sqrt(c.oscillator.k / c.oscillator.m);
    constexpr unsigned kSeeds = 200;
    double off = 0.0, errors = 0.0, held = 0.0;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
      const Identification result = free_decay(trace.time, Noise(seed).on(trace.displacement, c.noise), {});
      REQUIRE(result.failure == "");
      off += value_of(result, "natural_frequency") - omega;
      errors += estimate_of(result, "natural_frequency").standard_error;
      held += holds(result, "natural_frequency", omega) ? 1.0 : 0.0;
    }
    INFO("zeta " << c.oscillator.zeta << " noise " << c.noise << " off " << off / errors << " held " << held);
    // Three standard errors of the mean of 200, which is 0.07 of one of each.
    CHECK(std::abs(off / errors) < 3.0 * 0.071);
    // Of 200 with 95 % all but one in a thousand have 180.
    CHECK(held >= 180.0);
  }
}

TEST_CASE("Samples that are missing, wild, clipped or too far apart are refused by their place") {
  const Trace trace = trace_of({.m = 2.0, .k = 50.0, .zeta = 0.02, .x_f = 0.003}, 6.3, 60.0);
  const auto failure = [](const Trace& of) { return find_extrema(of.time, of.displacement).failure; };
  REQUIRE(failure(trace) == "");
  for (const std::ptrdiff_t samples : {30, 60, 120}) {  // half a cycle, one, two
    Trace gap = trace;
    gap.time.erase(gap.time.begin() + 100, gap.time.begin() + 100 + samples);
    gap.displacement.erase(gap.displacement.begin() + 100, gap.displacement.begin() + 100 + samples);
    CHECK_THAT(failure(gap), Contains("samples are missing from 2.07"));
  }
  // A few that dropped out do no harm.
  Trace dropped = trace;
  dropped.time.erase(dropped.time.begin() + 100, dropped.time.begin() + 105);
  dropped.displacement.erase(dropped.displacement.begin() + 100, dropped.displacement.begin() + 105);
  CHECK(failure(dropped) == "");
  Trace wild{trace.time, Noise(1).on(trace.displacement, 1e-3)};
  for (const std::size_t at : {47U, 60U, 133U}) {
    for (const double by : {0.05, -0.4}) {
      Trace one = wild;
      one.displacement[at] += by;
      CHECK_THAT(failure(one), Contains("the sample at " + std::to_string(one.time[at]).substr(0, 4)));
    }
  }
  Trace clipped = trace;
  for (double& x : clipped.displacement) x = std::clamp(x, -0.8, 0.7);
  CHECK_THAT(failure(clipped), Contains("largest value, 0.7 m, at 3"));
  // A coarse resolution is none.
  Trace coarse = trace_of({.m = 2.0, .k = 50.0}, 6.3, 600.0);
  for (double& x : coarse.displacement) x = 0.001 * std::round(1000.0 * x);
  CHECK(failure(coarse) == "");
  CHECK_THAT(failure(trace_of({.m = 2.0, .k = 50.0, .zeta = 0.02}, 8.3, 8.0)), Contains("samples per cycle"));
  const Trace loud{trace.time, Noise(1).on(trace.displacement, 0.15)};
  CHECK_THAT(failure(loud), Contains("the threshold of 20 standard deviations of its noise, 0.1"));
}

TEST_CASE("A table of turning points with a hole is refused by the times, and cannot be without them") {
  DecayExtrema extrema = exact_extrema({.m = 2.0, .k = 50.0, .zeta = 0.03, .x_f = 0.003}, 10);
  extrema.time.erase(extrema.time.begin() + 4, extrema.time.begin() + 6);
  extrema.displacement.erase(extrema.displacement.begin() + 4, extrema.displacement.begin() + 6);
  CHECK_THAT(free_decay(extrema, {}).failure, Contains("extremes 4 and 5, at"));
  CHECK_THAT(log_decrement(extrema, std::nullopt).failure, Contains("half a period apart"));
  extrema.time.clear();
  CHECK(free_decay(extrema, {}).failure == "");
}

}  // namespace
}  // namespace frahm::identification::measured_decay_test
