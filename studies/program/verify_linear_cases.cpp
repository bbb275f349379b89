#include <cmath>
#include <complex>
#include <numbers>

#include "solvers/response/periodic_response.hpp"
#include "solvers/transient/free_decay.hpp"
#include "studies/program/verify_cases.hpp"
#include "studies/program/verify_system.hpp"

namespace frahm::studies {
namespace {

using mechanics::ElementType, mechanics::ExcitationKind;
using std::numbers::pi;

constexpr double of_linear_response = 1e-10;
constexpr double of_turning_points = 1e-12;  // relative to the first

const mechanics::Node ground{};

// Amplitude and phase lag of a unit mass on one spring and one more element, under a force cos(r t).
struct Response {
  double amplitude = 0.0, phase = 0.0;
};
Response respond(ElementType beside, double r, double value, double second) {
  const mechanics::Network network{.masses = {"x"},
                                   .elements = {{"spring", ElementType::spring, ground, moving_mass},
                                                {"beside", beside, ground, moving_mass}},
                                   .excitations = {{ExcitationKind::force, 0, 1}}};
  const double spring = beside == ElementType::hysteretic ? 1e-300 : 1.0;  // its own stiffness instead
  periodic::PeriodicResponse response(network,
                                      {{periodic::Measure::harmonic, 0}, {periodic::Measure::phase, 0}});
  response.set_values({.omega = r,
                       .mass = {1.0},
                       .element = {spring, value},
                       .excitation = {{1.0, 0.0}},
                       .second = {0.0, second}});
  response.solve();
  double found[2] = {};
  response.quantities(found);
  return {found[0], found[1]};
}

void add_material(std::vector<VerifyCase>& cases, const char* name, ElementType type, double value,
                  double second, const auto& complex_stiffness) {
  VerifyCase material{name, of_linear_response};
  for (const double r : {0.05, 0.5, 0.9, 1.0, 1.1, 1.5, 3.0}) {
    const std::complex<double> x = 1.0 / (complex_stiffness(r) - r * r);
    const Response found = respond(type, r, value, second);
    material.compare(found.amplitude / std::abs(x), 1.0);
    material.compare(found.phase, -std::arg(x));
  }
  cases.push_back(std::move(material));
}

// |x_{i+1}| = beta |x_i| - x_f (1 + beta), beta = exp(-pi zeta/s), until the first |x_i| <= x_f.
void add_free_decay(std::vector<VerifyCase>& cases) {
  VerifyCase turning{"Free decay with friction: turning points", of_turning_points};
  VerifyCase stop{"Free decay with friction: time of the stop", of_turning_points};
  const mechanics::Network network{.masses = {"x"},
                                   .elements = {{"spring", ElementType::spring, ground, moving_mass},
                                                {"damper", ElementType::damper, ground, moving_mass},
                                                {"friction", ElementType::coulomb, ground, moving_mass}}};
  for (const double zeta : {0.0, 0.01, 0.1, 0.5}) {
    for (const double x_f : {0.013, 0.07, 0.21}) {
      const auto decay = transient::free_decay(network, {.mass = {1.0}, .element = {1.0, 2.0 * zeta, x_f}},
                                               {.displacement = {1.0}, .velocity = {0.0}}, {});
      const auto& extrema = decay.masses[0].extrema;
      const double s = std::sqrt(1.0 - zeta * zeta), beta = std::exp(-pi * zeta / s);
      double size = 1.0, side = 1.0;
      std::size_t i = 0;
      for (; size > x_f; ++i) {
        turning.expect(i < extrema.size());
        if (i >= extrema.size()) break;
        turning.compare(extrema[i].displacement, side * size);
        size = beta * size - x_f * (1.0 + beta);
        side = -side;
      }
      stop.compare(decay.stop_time / (static_cast<double>(i) * pi / s), 1.0);
    }
  }
  for (VerifyCase* added : {&turning, &stop}) cases.push_back(std::move(*added));
}

}  // namespace

void add_linear_cases(std::vector<VerifyCase>& cases) {
  using Complex = std::complex<double>;
  add_material(cases, "Viscous damping: amplitude and phase", ElementType::damper, 0.1, 0.0,
               [](double r) { return Complex(1.0, 0.1 * r); });
  add_material(cases, "Hysteretic damping: amplitude and phase", ElementType::hysteretic, 1.0, 0.07,
               [](double) { return Complex(1.0, 0.07); });
  add_material(cases, "Standard linear solid: amplitude and phase", ElementType::maxwell, 0.8, 0.6,
               [](double r) { return 1.0 + 0.8 * Complex(0.0, r) / Complex(0.8 / 0.6, r); });
  add_free_decay(cases);
}

}  // namespace frahm::studies
