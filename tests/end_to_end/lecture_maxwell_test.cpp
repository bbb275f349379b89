// The lecture's materials with a Maxwell element: Zener's solid, and the element by itself.
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "tests/end_to_end/runs.hpp"

namespace lecture_maxwell_test {
namespace {

using Complex = std::complex<double>;
using runs::Map;

constexpr double pi = std::numbers::pi;
constexpr double tolerance = 1e-9;  // relative, where the slowest relaxation takes hundreds of periods

// Complex stiffness of a spring k and a damper k tau in series.
Complex maxwell_stiffness(double k, double tau, double omega) {
  const Complex s(0.0, omega * tau);
  return k * s / (1.0 + s);
}

TEST_CASE("lecture_zener.toml: the response is that of the complex stiffness of Zener's solid") {
  const Map map = runs::run_study(runs::reduced("lecture_zener", {}));
  std::size_t point = 0;
  for (const double k_m : map.coordinate("k_m")) {
    const double most_lossy = 0.5 * k_m / std::sqrt(1.0 + k_m);  // at omega tau = 1/sqrt(1 + k_m)
    for (const double tau : map.coordinate("tau")) {
      for (const double r : map.coordinate("r")) {
        const Complex stiffness = 1.0 + maxwell_stiffness(k_m, tau, r), x = 1.0 / (stiffness - r * r);
        const double loss = map["branch_energy"][point] / (pi * std::norm(x) * stiffness.real());
        INFO("k_m " << k_m << ", tau " << tau << ", r " << r);
        CHECK_THAT(map["main_amplitude"][point], Catch::WithinRel(std::abs(x), tolerance));
        CHECK_THAT(map["main_phase"][point], Catch::WithinAbs(-std::arg(x), tolerance));
        CHECK_THAT(loss, Catch::WithinRel(stiffness.imag() / stiffness.real(), tolerance));
        CHECK(loss < most_lossy * (1.0 + tolerance));
        CHECK_THAT(map["transmitted_force"][point], Catch::WithinRel(std::abs(stiffness * x), tolerance));
        ++point;
      }
    }
  }
}

TEST_CASE("lecture_maxwell.toml: a Maxwell element is a damper to slow motion and a spring to fast") {
  const Map map = runs::run_study(runs::reduced("lecture_maxwell", {}));
  std::size_t point = 0;
  for (const double tau : map.coordinate("tau")) {
    for (const double r : map.coordinate("r")) {
      const Complex link = maxwell_stiffness(1.0, tau, r), x = link / (link + 0.01 - r * r);
      const double force = map["link_force_peak"][point], stroke = map["link_stroke"][point];
      INFO("tau " << tau << ", r " << r);
      CHECK_THAT(map["main_amplitude"][point], Catch::WithinRel(std::abs(x), tolerance));
      CHECK_THAT(stroke, Catch::WithinAbs(std::abs(x - 1.0), tolerance));
      CHECK(map["energy_balance"][point] < tolerance);
      // At r = 0.1 the soft spring alone carries the mass along with the base: nothing strains the element.
      const bool unstrained = std::abs(0.01 - r * r) < 1e-12;
      ++point;
      if (unstrained) continue;
      CHECK_THAT(force / stroke, Catch::WithinRel(std::abs(link), tolerance));
      if (r * tau < 0.01) CHECK_THAT(force / stroke, Catch::WithinRel(r * tau, 1e-4));  // (r tau)^2/2
      if (r * tau > 100) CHECK_THAT(force / stroke, Catch::WithinRel(1.0, 1e-4));
    }
  }
}

}  // namespace
}  // namespace lecture_maxwell_test
