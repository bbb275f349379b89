#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "solvers/transient/forced_motion.hpp"
#include "solvers/transient/free_decay.hpp"
#include "tests/known_answers/free_oscillator.hpp"

// How far a decay is followed: given durations, stiff systems, sizes at the edge of what a double holds.
namespace frahm::transient::decay_limits_test {
namespace {

using Catch::Matchers::WithinAbs, Catch::Matchers::WithinRel;
constexpr double kExact = 1e-12;  // relative to the first displacement, and of times

FreeDecay decay_of(const FreeOscillator& oscillator, double x_0, const DecayOptions& options = {}) {
  return free_decay(oscillator.network(), oscillator.values(), {{x_0}, {}}, options);
}

// Counts the calls of a watch, one for every 256 steps or less.
struct Calls {
  int count = 0;
  Watch watch() {
    return [this] { ++count; };
  }
};

// x of a release at x_0 with zeta much above 1: the slow root takes over at once,
//   x = (a e^{b t} - b e^{a t}) x_0/(a - b),  a, b = omega_n (-zeta +- sqrt(zeta^2 - 1)).
double overdamped(const FreeOscillator& o, double x_0, double t) {
  const double root = std::sqrt(o.zeta * o.zeta - 1.0), w = o.natural_frequency();
  const double a = -w / (o.zeta + root), b = -w * (o.zeta + root);  // a without cancellation
  return x_0 * (a * std::exp(b * t) - b * std::exp(a * t)) / (a - b);
}

TEST_CASE("A given duration is what is computed, and little more, however long the motion's own end takes") {
  for (const double x_f : {0.0, 0.001}) {
    const FreeOscillator oscillator{.m = 1.0, .k = 100.0, .zeta = 1e4, .x_f = x_f};
    Calls calls;
    const FreeDecay decay =
        decay_of(oscillator, 1.0, {.duration = 0.1, .samples = 11, .watch = calls.watch()});
    INFO("x_f " << x_f << " calls " << calls.count);
    CHECK(decay.end == DecayEnd::cut_off);
    CHECK(decay.duration == 0.1);
    CHECK(256.0 * calls.count < 1.1 * kStepsBeyond + 0.1 * 10.0 * 2e4);
    REQUIRE(decay.history.displacement[0].size() == 11);
    for (std::size_t i = 0; i < 11; ++i) {
      const double expected = x_f + overdamped(oscillator, 1.0 - x_f, decay.history.time[i]);
      CHECK_THAT(decay.history.displacement[0][i], WithinAbs(expected, 1e-10));
    }
    // Without friction all that is damped tends to 0; with it the place is not known yet.
    CHECK((x_f == 0.0 ? decay.masses[0].rest == 0.0 : std::isnan(decay.masses[0].rest)));
    CHECK(std::isnan(decay.stop_time));
    CHECK(decay.remainder > 0.99);
  }
}

TEST_CASE("A stiff decay without a duration is cut off, and what has been computed is kept", "[slow]") {
  const FreeOscillator oscillator{.m = 1.0, .k = 100.0, .zeta = 1e4};
  const FreeDecay decay = decay_of(oscillator, 1.0, {.samples = 5});
  CHECK(decay.end == DecayEnd::cut_off);
  CHECK(decay.reason.empty());
  CHECK(decay.duration > 0.0);
  CHECK(decay.masses[0].extrema.size() == 1);
  CHECK(decay.masses[0].rest == 0.0);
  for (std::size_t i = 0; i < 5; ++i) {
    constexpr double kManySteps = 1e-9;  // roundings of a million steps
    CHECK_THAT(decay.history.displacement[0][i],
               WithinAbs(overdamped(oscillator, 1.0, decay.history.time[i]), kManySteps));
  }
}

TEST_CASE("What is left at the duration is told: exp(-zeta omega_n t) after whole periods") {
  const FreeOscillator oscillator{.m = 2.0, .k = 50.0, .zeta = 0.03};
  const double t = 6.0 * oscillator.half_period();
  const FreeDecay decay = decay_of(oscillator, 0.2, {.duration = t});
  CHECK_THAT(decay.remainder, WithinRel(std::exp(-0.03 * 5.0 * t), kExact));
  CHECK(decay.masses[0].rest == 0.0);
  const FreeDecay whole = decay_of(oscillator, 0.2);
  CHECK(whole.end == DecayEnd::decayed);
  CHECK(whole.remainder <= kDecayed);
  CHECK(whole.remainder > 0.5 * kDecayed);
}

TEST_CASE("What has fallen below 1e-100 of the first has no extrema any more, and is where it tends to") {
  const FreeOscillator oscillator{.m = 1.0, .k = 1600.0, .zeta = 0.1};
  const FreeDecay decay = decay_of(oscillator, 0.01, {.duration = 3600.0, .samples = 61});
  const auto& extrema = decay.masses[0].extrema;
  // beta^n = 1e-100: n = 100 ln 10 s/(pi zeta) = 729.3
  CHECK(extrema.size() >= 729);
  CHECK(extrema.size() <= 733);
  CHECK(std::abs(extrema.back().displacement) > 1e-104);
  CHECK(decay.history.time.back() == 3600.0);
  CHECK(decay.history.displacement[0].back() == 0.0);
  CHECK(decay.history.velocity[0].back() == 0.0);
  CHECK(decay.end == DecayEnd::decayed);
}

TEST_CASE("The end does not depend on the scale, from the smallest to the largest initial values") {
  const FreeOscillator oscillator{.m = 2.0, .k = 50.0, .zeta = 0.05};
  const FreeDecay one = decay_of(oscillator, 1.0);
  for (const double scale : {kSmallestInitial, 1e-30, 1e30, kLargestInitial}) {
    const FreeDecay decay = decay_of(oscillator, scale);
    INFO("scale " << scale);
    CHECK(decay.end == DecayEnd::decayed);
    CHECK(decay.duration == one.duration);
    REQUIRE(decay.masses[0].extrema.size() == one.masses[0].extrema.size());
    CHECK_THAT(decay.masses[0].extrema.back().displacement / scale,
               WithinAbs(one.masses[0].extrema.back().displacement, kExact));
    const FreeDecay hour = decay_of(oscillator, scale, {.duration = 3600.0});
    CHECK(hour.masses[0].extrema.size() ==
          decay_of(oscillator, 1.0, {.duration = 3600.0}).masses[0].extrema.size());
  }
}

TEST_CASE("Initial values beyond that are refused by name") {
  const FreeOscillator oscillator{.zeta = 0.1};
  for (const double size : {1e160, -1e51, 1e-170, -1e-51, std::numeric_limits<double>::infinity()}) {
    CHECK_THROWS_WITH(decay_of(oscillator, size), Catch::Contains("an initial displacement is") &&
                                                      Catch::Contains("from 1e-50 to 1e+50"));
    CHECK_THROWS_WITH(free_decay(oscillator.network(), oscillator.values(), {{}, {size}}, {}),
                      Catch::Contains("an initial velocity is"));
  }
}

TEST_CASE("What is neither displaced nor set in motion is at rest from the start") {
  for (const double x_f : {0.0, 0.1}) {
    for (const double duration : {0.0, 2.5}) {
      const FreeDecay decay = decay_of({.zeta = 0.1, .x_f = x_f}, 0.0, {.duration = duration, .samples = 3});
      CHECK(decay.end == DecayEnd::at_rest);
      CHECK(decay.stop_time == 0.0);
      CHECK(decay.masses[0].rest == 0.0);
      CHECK(decay.duration > 0.0);
      CHECK((duration == 0.0 || decay.duration == duration));
      CHECK(decay.history.displacement[0] == std::vector<double>{0.0, 0.0, 0.0});
    }
  }
}

TEST_CASE("What a watch throws ends a decay and a forced motion") {
  struct Enough {};
  int calls = 0;
  const Watch watch = [&calls] {
    if (++calls > 3) throw Enough{};
  };
  const FreeOscillator oscillator{.m = 1.0, .k = 100.0, .zeta = 1e4};
  CHECK_THROWS_AS(decay_of(oscillator, 1.0, {.watch = watch}), Enough);
  CHECK(calls == 4);
  calls = 0;
  auto network = oscillator.network();
  network.excitations.push_back({.kind = mechanics::ExcitationKind::force});
  auto values = oscillator.values();
  values.excitation.push_back({.amplitude = 1.0});
  CHECK_THROWS_AS(forced_motion(network,
                                [&](double omega) {
                                  values.omega = omega;
                                  return values;
                                },
                                {}, {.from = 10.0, .duration = 1.0, .watch = watch}),
                  Enough);
}

// x = (P/k) (1 - e^{-zeta omega_n t} (cos omega_d t + zeta/s sin omega_d t)), peak (P/k)(1 + beta).
TEST_CASE("A load suddenly applied overshoots its static deflection by beta, with constant force alone") {
  const FreeOscillator oscillator{.m = 2.0, .k = 200.0, .zeta = 0.05};
  auto network = oscillator.network();
  network.excitations.push_back({.kind = mechanics::ExcitationKind::force, .order = 0});
  auto values = oscillator.values();
  values.excitation.push_back({.amplitude = 30.0});
  const ForcedMotion motion = forced_motion(network,
                                            [&](double omega) {
                                              values.omega = omega;
                                              return values;
                                            },
                                            {}, {.from = 7.3, .duration = 3.0, .samples = 31});
  REQUIRE(motion.failure.empty());
  const double x_st = 30.0 / 200.0, w = 10.0, s = oscillator.s();
  CHECK_THAT(motion.peaks[0].displacement, WithinRel(x_st * (1.0 + oscillator.beta()), kExact));
  CHECK_THAT(motion.peaks[0].time, WithinRel(oscillator.half_period(), kExact));
  for (std::size_t i = 0; i < 31; ++i) {
    const double t = motion.history.time[i];
    const double expected =
        x_st * (1.0 - std::exp(-0.05 * w * t) * (std::cos(s * w * t) + 0.05 / s * std::sin(s * w * t)));
    CHECK_THAT(motion.history.displacement[0][i], WithinAbs(expected, kExact));
  }
}

}  // namespace
}  // namespace frahm::transient::decay_limits_test
