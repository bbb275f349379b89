#include "studies/program/verify_cases.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "solvers/orbits/closed_forms.hpp"
#include "studies/program/verify_system.hpp"

namespace frahm::studies {
namespace {

using namespace periodic;  // the closed forms
using std::numbers::pi;

constexpr double agreement = 1e-9;             // relative to max(value, 1)
constexpr double of_critical_friction = 1e-8;  // by bisection on the regime
constexpr double of_stuck_time = 1e-7;         // its end is a double root of the velocity
constexpr double of_energy = 1e-10;            // relative
constexpr double rounding = 1e-15;

constexpr double zetas[] = {0.0, 0.02, 0.1, 0.5, 1.0, 1.2};
constexpr double ratios[] = {0.2, 0.35, 0.6, 0.9, 1.0, 1.1, 1.7, 3.0};  // r

// The motion without stops has no closed form without damping at r = 1, 1/3, 1/5, ...: H is infinite there.
bool is_pole(double r, double zeta) {
  return zeta == 0.0 && std::abs(std::abs(std::remainder(1.0 / r, 2.0)) - 1.0) < 1e-12;
}

// The maximum and, half a period later, the minimum are equally large.
double phase_difference(double a, double b) {
  return std::remainder(a - b, pi);
}

double radius(const std::array<std::complex<double>, 2>& multipliers) {
  return std::max(std::abs(multipliers[0]), std::abs(multipliers[1]));
}

// Every orbit found must also dissipate the energy put in.
KnownQuantities solve(ClassicalSystem& system, const mechanics::NetworkValues& values, VerifyCase& energy) {
  const KnownQuantities found = system.solve(values);
  if (found.has_orbit && found.regime != Regime::stuck) energy.compare(found.energy_balance, 0.0);
  return found;
}

void add_non_stop(std::vector<VerifyCase>& cases, VerifyCase& energy) {
  VerifyCase amplitude{"Den Hartog, no stop: amplitude", agreement};
  VerifyCase phase{"Den Hartog, no stop: phase of the maximum", agreement};
  VerifyCase multiplier{"Den Hartog, no stop: largest Floquet multiplier", agreement};
  ClassicalSystem system(forced_mass({1}));
  for (const double zeta : zetas) {
    for (const double r : ratios) {
      if (is_pole(r, zeta)) continue;
      for (const double share : {0.05, 0.5, 0.95}) {
        const double f = share * critical_friction(r, zeta);
        const ClosedForm exact = non_stop_response(r, zeta, f);
        if (!exact.valid()) continue;
        const KnownQuantities found = solve(system, mass_values(r, zeta, f), energy);
        amplitude.expect(found.has_orbit && found.regime == Regime::non_stop);
        amplitude.compare(found.amplitude, exact.amplitude);
        phase.compare(phase_difference(found.peak_phase, exact.peak_lag), 0.0);
        multiplier.compare(found.floquet_radius, radius(non_stop_multipliers(r, zeta, f)));
      }
    }
  }
  for (VerifyCase* added : {&amplitude, &phase, &multiplier}) cases.push_back(std::move(*added));
}

void add_critical_friction(std::vector<VerifyCase>& cases) {
  VerifyCase critical{"Largest friction without stops, f_crit, by bisection", of_critical_friction};
  ClassicalSystem system(forced_mass({1}));
  for (const double r : {0.12, 0.2, 0.3, 0.39, 0.55, 0.8, 1.0, 1.4, 2.2, 3.5}) {
    for (const double zeta : {0.02, 0.3}) {
      const double exact = critical_friction(r, zeta);
      double without_stops = 0.5 * exact, with_stops = std::min(1.5 * exact, 0.999);
      while (with_stops - without_stops > 0.01 * of_critical_friction) {
        const double f = 0.5 * (without_stops + with_stops);
        const bool stops = system.solve(mass_values(r, zeta, f)).regime != Regime::non_stop;
        (stops ? with_stops : without_stops) = f;
      }
      critical.compare(without_stops, exact);
    }
  }
  cases.push_back(std::move(critical));
}

void add_one_stop(std::vector<VerifyCase>& cases, VerifyCase& energy) {
  VerifyCase amplitude{"One stop each half cycle: amplitude", agreement};
  VerifyCase stuck{"One stop each half cycle: share of the period at rest", of_stuck_time};
  VerifyCase multiplier{"One stop each half cycle: largest Floquet multiplier", agreement};
  ClassicalSystem system(forced_mass({1}));
  for (const double zeta : zetas) {
    for (const double r : ratios) {
      for (const double f : {0.3, 0.6, 0.8, 0.9, 0.97}) {
        if (f <= critical_friction(r, zeta)) continue;
        const OneStop exact = one_stop_response(r, zeta, f);
        if (!exact.valid()) continue;
        const KnownQuantities found = solve(system, mass_values(r, zeta, f), energy);
        amplitude.expect(found.has_orbit && found.regime == Regime::one_stop);
        amplitude.compare(found.amplitude, exact.amplitude);
        stuck.compare(found.stuck_fraction, 1.0 - exact.sliding_time * r / pi);
        multiplier.compare(found.floquet_radius, radius(one_stop_multipliers(r, zeta, f)));
      }
    }
  }
  for (VerifyCase* added : {&amplitude, &stuck, &multiplier}) cases.push_back(std::move(*added));
}

// Points where formulas have poles or are ill-conditioned: zeta = 0 at r = 1, and zeta about 1.
void add_degenerate(std::vector<VerifyCase>& cases, VerifyCase& energy) {
  VerifyCase unbounded{"Undamped at resonance, f < pi/4: unbounded", 0.0};
  VerifyCase bounded{"Undamped at and 1e-9 from resonance, f > pi/4: amplitude", agreement};
  VerifyCase critical{"Damping ratio 1, 1 +- 1e-9 and 1.2: amplitude", agreement};
  VerifyCase stuck{"Friction as large as the force: no motion", rounding};
  ClassicalSystem system(forced_mass({1}));
  for (const double f : {0.0, 0.5, 0.78}) {
    ++unbounded.points;
    unbounded.expect(system.solve(mass_values(1.0, 0.0, f)).unbounded);
  }
  for (const double f : {0.79, 0.9}) {
    for (const double r : {1.0 - 1e-9, 1.0, 1.0 + 1e-9}) {
      const KnownQuantities found = solve(system, mass_values(r, 0.0, f), energy);
      bounded.compare(found.amplitude, one_stop_response(r, 0.0, f).amplitude);
    }
  }
  for (const double zeta : {1.0 - 1e-9, 1.0, 1.0 + 1e-9, 1.2}) {
    for (const double r : {0.3, 1.0 - 1e-9, 1.0, 1.0 + 1e-9, 2.0}) {
      for (const double f : {0.05, 0.3, 0.7, 0.9}) {
        const KnownQuantities found = solve(system, mass_values(r, zeta, f), energy);
        critical.compare(found.amplitude, classical_amplitude(r, zeta, f));
      }
    }
  }
  for (const double zeta : zetas) {
    for (const double f : {1.0, 1.2, 10.0}) {
      const KnownQuantities found = system.solve(mass_values(1.0, zeta, f));
      stuck.expect(found.regime == Regime::stuck && found.stuck_fraction == 1.0);
      stuck.compare(found.amplitude, 0.0);
    }
  }
  for (VerifyCase* added : {&unbounded, &bounded, &critical, &stuck}) cases.push_back(std::move(*added));
}

void add_moving_base(std::vector<VerifyCase>& cases, VerifyCase& energy) {
  VerifyCase hundal{"Hundal, friction to ground on a moving base: amplitude", agreement};
  VerifyCase levitan{"Levitan, friction to the moving base: stroke", agreement};
  ClassicalSystem to_ground(mass_on_base(false)), to_base(mass_on_base(true));
  for (const double zeta : zetas) {
    for (const double r : ratios) {
      if (r == 1.0 && zeta == 0.0) continue;  // V is infinite
      for (const double f : {0.05, 0.3, 0.6, 0.97, 2.0}) {
        const double hundal_exact = hundal_amplitude(r, zeta, f),
                     levitan_exact = levitan_amplitude(r, zeta, f);
        if (!std::isnan(hundal_exact)) {
          hundal.compare(solve(to_ground, mass_values(r, zeta, f), energy).amplitude, hundal_exact);
        }
        if (!std::isnan(levitan_exact)) {
          levitan.compare(solve(to_base, mass_values(r, zeta, f), energy).stroke, levitan_exact);
        }
      }
    }
  }
  for (VerifyCase* added : {&hundal, &levitan}) cases.push_back(std::move(*added));
}

void add_two_frequencies(std::vector<VerifyCase>& cases, VerifyCase& energy) {
  VerifyCase amplitude{"Cheng and Zu, two frequencies M:N, both odd: amplitude", agreement};
  VerifyCase phase{"Cheng and Zu, two frequencies M:N, both odd: phase", agreement};
  for (const auto& [M, N] : {std::pair{1, 3}, {3, 1}, {1, 5}, {3, 5}, {5, 3}}) {
    ClassicalSystem system(forced_mass({M, N}));
    for (const double r1 : {0.5, 0.9, 1.5, 3.0}) {
      for (const double f : {0.02, 0.1, 0.3}) {
        for (const double p2 : {0.2, 1.0, 5.0}) {
          const TwoFrequencies asked{.r1 = r1, .M = M, .N = N, .zeta = 0.1, .f = f, .p2 = p2, .phase = 0.7};
          const TwoFrequencyResponse exact = two_frequency_response(asked);
          if (!exact.valid()) continue;
          mechanics::NetworkValues values = mass_values(r1 / M, asked.zeta, f);
          values.excitation = {{1.0, 0.0}, {p2, asked.phase}};
          const KnownQuantities found = solve(system, values, energy);
          amplitude.expect(found.regime == Regime::non_stop);
          amplitude.compare(found.amplitude, exact.amplitude);
          phase.compare(phase_difference(found.peak_phase, exact.peak_phase), 0.0);
        }
      }
    }
  }
  for (VerifyCase* added : {&amplitude, &phase}) cases.push_back(std::move(*added));
}

}  // namespace

void VerifyCase::compare(double found, double exact) {
  ++points;
  const double deviation = std::abs(found - exact) / std::max(1.0, std::abs(exact));
  if (std::isnan(deviation))
    ++wrong;
  else
    worst = std::max(worst, deviation);
}

void VerifyCase::expect(bool holds) {
  if (!holds) ++wrong;
}

std::vector<VerifyCase> verify_cases() {
  std::vector<VerifyCase> cases;
  VerifyCase energy{"Work in = energy lost, at every orbit above", of_energy};
  add_non_stop(cases, energy);
  add_critical_friction(cases);
  add_one_stop(cases, energy);
  add_degenerate(cases, energy);
  add_moving_base(cases, energy);
  add_two_frequencies(cases, energy);
  cases.push_back(std::move(energy));
  add_linear_cases(cases);
  return cases;
}

}  // namespace frahm::studies
