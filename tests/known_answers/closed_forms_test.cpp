#include "solvers/orbits/closed_forms.hpp"

#include <array>
#include <boost/numeric/odeint/integrate/integrate_const.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

// The references themselves are tested first: each closed-form orbit is integrated through its equation of
// motion.
namespace frahm::periodic::closed_forms_test {
namespace {

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using std::numbers::pi;
using State = std::array<double, 2>;

constexpr double kClosure = 1e-11;  // of an orbit integrated with 400 steps of eighth order a half cycle

// x'' + 2 zeta x' + x + friction = force(tau), over `duration`; the largest velocity met on the way.
struct Slid {
  State end;
  double fastest = -1e9;
};
template <class Force>
Slid slide(State state, double zeta, double friction, const Force& force, double duration, int steps = 400) {
  boost::numeric::odeint::runge_kutta_fehlberg78<State> stepper;
  const auto rate = [&](const State& x, State& dx, double tau) {
    dx = {x[1], force(tau) - friction - 2.0 * zeta * x[1] - x[0]};
  };
  Slid result;
  for (int i = 0; i < steps; ++i) {
    stepper.do_step(rate, state, i * duration / steps, duration / steps);
    if (i + 1 < steps) result.fastest = std::max(result.fastest, state[1]);
  }
  result.end = state;
  return result;
}

TEST_CASE("Den Hartog's orbit without stops satisfies its equation of motion") {
  int checked = 0;
  for (const double r : {0.25, 0.5, 0.9, 1.0, 1.1, 2.0, 4.0}) {
    for (const double zeta : {0.0, 0.02, 0.3, 0.9999999, 1.0, 1.0000001, 1.2, 3.0}) {
      if (zeta == 0.0 && r == 1.0) continue;
      for (const double share : {0.0, 0.3, 0.999}) {
        const double f = share * critical_friction(r, zeta);
        const ClosedForm response = non_stop_response(r, zeta, f);
        INFO("r " << r << " zeta " << zeta << " f " << f);
        const auto force = [&](double tau) { return std::cos(r * tau + response.peak_lag); };
        const Slid slid = slide({response.amplitude, 0.0}, zeta, -f, force, pi / r);
        CHECK_THAT(slid.end[0], WithinAbs(-response.amplitude, kClosure * (1.0 + response.amplitude)));
        CHECK_THAT(slid.end[1], WithinAbs(0.0, kClosure * (1.0 + response.amplitude)));
        CHECK(slid.fastest < 0.0);
        ++checked;
      }
    }
  }
  CHECK(checked == (7 * 8 - 1) * 3);
}

TEST_CASE("Above the critical friction Den Hartog's orbit would move against its own friction") {
  for (const double r : {0.15, 0.22, 0.3, 0.37, 0.45, 0.8, 1.0, 1.5}) {
    for (const double zeta : {0.01, 0.05, 0.2, 1.0}) {
      // Just beyond the border the wrong velocity is short and small: many samples are needed to meet it.
      constexpr int kSamples = 20000;
      const double f = critical_friction(r, zeta), beyond = 1.0 + 1e-3;
      CHECK(non_stop_response(r, zeta, f).valid());
      CHECK_FALSE(non_stop_response(r, zeta, f * beyond).valid());
      const DenHartogFunctions d = den_hartog_functions(r, zeta);
      const double over = f * beyond, root = std::sqrt(d.V * d.V - d.H * d.H * over * over);
      const double lag = std::atan2(2.0 * zeta * r, 1.0 - r * r) - std::atan2(d.H * over, root);
      const auto force = [&](double tau) { return std::cos(r * tau + lag); };
      const State start{root - d.G * over, 0.0};
      const Slid whole = slide(start, zeta, -over, force, pi / r, kSamples);
      const double acceleration_at_start = force(0.0) + over - start[0];
      INFO("r " << r << " zeta " << zeta);
      CHECK((whole.fastest > 0.0 || acceleration_at_start > 0.0));
    }
  }
}

TEST_CASE(
    "The orbit with one stop satisfies its equation of motion, and rests within the limit of friction") {
  int valid = 0;
  for (const double r : {0.4, 0.6, 0.9, 1.0, 1.3, 2.0}) {
    for (const double zeta : {0.0, 0.02, 0.2, 1.0, 1.5}) {
      for (const double f : {0.5, 0.7, 0.8, 0.9, 0.97}) {
        const OneStop response = one_stop_response(r, zeta, f);
        if (!response.valid()) continue;
        INFO("r " << r << " zeta " << zeta << " f " << f);
        const double X = response.amplitude, psi = std::acos(X - f);
        const auto force = [&](double tau) { return std::cos(r * tau + psi); };
        const Slid slid = slide({X, 0.0}, zeta, -f, force, response.sliding_time);
        CHECK_THAT(slid.end[0], WithinAbs(-X, kClosure));
        CHECK_THAT(slid.end[1], WithinAbs(0.0, kClosure));
        CHECK(slid.fastest < 0.0);
        for (double phase = psi + r * response.sliding_time; phase < psi + pi; phase += 1e-3) {
          CHECK(std::abs(std::cos(phase) + X) <= f + kClosure);
        }
        ++valid;
      }
    }
  }
  CHECK(valid > 60);
}

TEST_CASE(
    "Responses with and without a stop meet at the critical friction where the supremum is at the ends") {
  constexpr double kAcross = 1e-8, kContinuity = 1e-6;
  for (const double r : {0.6, 0.9, 1.1, 1.8}) {
    for (const double zeta : {0.01, 0.1, 1.0}) {
      const double f = critical_friction(r, zeta);
      const double below = non_stop_response(r, zeta, f * (1.0 - kAcross)).amplitude;
      const double above = one_stop_response(r, zeta, f * (1.0 + kAcross)).amplitude;
      INFO("r " << r << " zeta " << zeta << " f " << f);
      CHECK_THAT(above, WithinAbs(below, kContinuity * (1.0 + below)));
    }
  }
}

TEST_CASE("Den Hartog's functions are continuous through critical damping and known at a few points") {
  constexpr double kExact = 1e-14;
  for (const double r : {0.3, 1.0, 2.5}) {
    const double th = pi / r;
    const auto [V, G, H] = den_hartog_functions(r, 1.0);
    // s -> 0: Dn = cosh th + 1, G = (sinh th - th) / Dn, H = th / (r Dn)
    CHECK_THAT(G, WithinRel((std::sinh(th) - th) / (std::cosh(th) + 1.0), kExact * 100));
    CHECK_THAT(H, WithinRel(th / (r * (std::cosh(th) + 1.0)), kExact * 100));
    CHECK_THAT(V, WithinRel(1.0 / (1.0 + r * r), kExact * 100));
    for (const double zeta : {1.0 - 1e-9, 1.0 + 1e-9}) {
      const DenHartogFunctions near = den_hartog_functions(r, zeta);
      CHECK_THAT(near.G, WithinAbs(G, 2e-9 * th));
      CHECK_THAT(near.H, WithinAbs(H, 2e-9 * th));
    }
  }
  // r = 1: s th = s pi. zeta = 0: G = 0, H = tan(th/2) / r.
  CHECK(den_hartog_functions(1.0 / 3.0, 0.0).G == 0.0);
  CHECK_THAT(den_hartog_functions(2.0, 0.0).H, WithinRel(0.5 * std::tan(pi / 4.0), kExact));
  CHECK(std::isfinite(den_hartog_functions(1e-3, 5.0).G));
}

TEST_CASE("The two-frequency orbit satisfies its equation of motion") {
  int valid = 0;
  for (const auto& [M, N] : {std::pair{1, 3}, {3, 1}, {1, 5}, {5, 3}, {3, 5}}) {
    for (const double r1 : {0.5, 0.9, 1.5, 3.0}) {
      for (const double f : {0.05, 0.2}) {
        for (const double p2 : {0.3, 1.0, 5.0}) {
          const TwoFrequencies system{.r1 = r1, .M = M, .N = N, .zeta = 0.1, .f = f, .p2 = p2, .phase = 0.7};
          const TwoFrequencyResponse response = two_frequency_response(system);
          if (!response.valid()) continue;
          ++valid;
          const double base = r1 / M, start = response.peak_phase / base;
          const auto force = [&, M = M, N = N](double tau) {
            const double t = base * (tau + start);
            return std::cos(M * t) + p2 * std::cos(N * t + 0.7);
          };
          INFO("M " << M << " N " << N << " r1 " << r1 << " f " << f << " p2 " << p2);
          const Slid slid = slide({response.amplitude, 0.0}, 0.1, -f, force, pi / base);
          CHECK_THAT(slid.end[0], WithinAbs(-response.amplitude, kClosure * (1 + response.amplitude)));
          CHECK_THAT(slid.end[1], WithinAbs(0.0, kClosure * (1 + response.amplitude)));
          CHECK(slid.fastest < 1e-12);
        }
      }
    }
  }
  CHECK(valid > 30);
}

TEST_CASE("Closed forms refuse what lies outside their region") {
  // The formula alone would say 0.505 here; the true amplitude is 0.918.
  CHECK_FALSE(non_stop_response(0.2, 0.05, 0.2).valid());
  CHECK_THAT(classical_amplitude(0.2, 0.05, 0.2), WithinAbs(0.918, 5e-4));
  CHECK(std::isnan(classical_amplitude(0.1, 0.0, 0.3)));  // several stops
  CHECK(classical_amplitude(0.7, 0.1, 1.0) == 0.0);
  CHECK(levitan_amplitude(0.5, 0.1, 0.25) == 0.0);  // the mass rides with the base if f >= r^2
}

}  // namespace
}  // namespace frahm::periodic::closed_forms_test
