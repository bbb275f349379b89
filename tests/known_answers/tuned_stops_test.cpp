// The tuning of an absorber with end stops: the classical optimum where the stops are out of reach, and where
// they are hit no design of a dense grid is better, by an integration that shares nothing with the solvers.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "solvers/laws/elastic_stop.hpp"
#include "solvers/tuning/optimum.hpp"
#include "tests/known_answers/nishihara_asami.hpp"

namespace tuned_stops_test {
namespace {

using namespace frahm;
using tuning::Optimum;
using tuning::Task;

constexpr double kTuned = 1e-6;  // of f, zeta and the peak of the linear optimum, as promised
// For a worst peak by fixed steps, which pass over the places where the stops' force jumps: with 1024 steps a
// period it is right to 2e-4, with 256 to 3e-3.
constexpr double kFine = 1e-3, kCoarse = 5e-3;

constexpr double kMu = 0.05;  // mass ratio

struct Stops {
  double clearance = 10.0, stiffness = 0.03, damping = 0.03;
};

// Machine of mass 1 on a spring of 1 and a damper of c, under cos(r t); the absorber after stops.
struct Machine {
  double damping = 0.0;
  Stops stops;
};

// at: frequency ratio and damping ratio of the absorber, excitation's frequency.
Task absorber_behind_stops(const Machine& machine, const tuning::Band& band) {
  using namespace mechanics;
  Task task;
  const Node ground{}, main{NodeKind::mass, 0}, absorber{NodeKind::mass, 1};
  Element stops{"stops", ElementType::gap, main, absorber};
  stops.bends = {{1.0, &laws::elastic_stop}, {-1.0, &laws::elastic_stop}};
  task.network = {.masses = {"machine", "absorber"},
                  .elements = {{"mount", ElementType::spring, ground, main},
                               {"mount_damper", ElementType::damper, ground, main},
                               {"spring", ElementType::spring, main, absorber},
                               {"damper", ElementType::damper, main, absorber},
                               stops},
                  .excitations = {{ExcitationKind::force, 0, 1}}};
  task.network_at = [=](std::size_t, std::span<const double> at, NetworkValues& values,
                        std::vector<NetworkValues>* derivatives) {
    const double f = at[0], zeta = at[1];
    const auto& [D, k, c] = machine.stops;
    values = {.omega = at[2],
              .mass = {1.0, kMu},
              .element = {1.0, machine.damping, kMu * f * f, 2.0 * zeta * kMu * f, k},
              .excitation = {{1.0, 0.0}},
              .second = {0.0, 0.0, 0.0, 0.0, c},
              .bends = {{}, {}, {}, {}, {{D, k, c}, {D, k, c}}}};
    if (!derivatives) return;
    const NetworkValues none{.omega = 0.0,
                             .mass = {0.0, 0.0},
                             .element = {0.0, 0.0, 0.0, 0.0, 0.0},
                             .excitation = {{0.0, 0.0}},
                             .second = {0.0, 0.0, 0.0, 0.0, 0.0},
                             .bends = {{}, {}, {}, {}, {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}}};
    derivatives->assign(3, none);
    (*derivatives)[0].element[2] = 2.0 * kMu * f;
    (*derivatives)[0].element[3] = 2.0 * zeta * kMu;
    (*derivatives)[1].element[3] = 2.0 * kMu * f;
    (*derivatives)[2].omega = 1.0;
  };
  task.scenarios = {"as it is"};
  task.parameters = {{.name = "f", .lower = 0.6, .upper = 1.1, .nominal = 0.8, .schedule = {}},
                     {.name = "zeta", .lower = 0.03, .upper = 0.3, .nominal = 0.1, .schedule = {}}};
  task.band = band;
  task.quantity = {.measure = periodic::Measure::peak, .index = 0};
  return task;
}

Optimum tuned(const Task& task) {
  return tuning::tune(task, 0, [] { return false; }).at(0);
}

TEST_CASE("an absorber whose stops are never reached has the classical optimum", "[slow]") {
  const AbsorberOptimum form = nishihara_asami(kMu);
  const Optimum optimum =
      tuned(absorber_behind_stops({.damping = 0.0, .stops = {.clearance = 40.0}}, {0.6, 1.4}));
  INFO(optimum.reason << ", gap " << optimum.certificate_gap << ", KKT " << optimum.kkt_residual);
  CHECK(optimum.outcome == tuning::Outcome::converged);
  CHECK(optimum.parameters[0].value[0] == Approx(form.f).epsilon(kTuned));
  CHECK(optimum.parameters[1].value[0] == Approx(form.zeta).epsilon(kTuned));
  CHECK(optimum.objective == Approx(form.peak).epsilon(kTuned));
}

// The machine and its absorber by the classical Runge-Kutta method with fixed steps, without events.
class Integration {
 public:
  Integration(const Machine& machine, double f, double zeta, int steps_a_period)
      : machine_(machine), k_(kMu * f * f), c_(2.0 * zeta * kMu * f), steps_(steps_a_period) {}

  // Largest |x| of the machine over the last of many periods at r, from where the motion is.
  double peak_at(double r) {
    constexpr int kPeriods = 50, kLooked = 10;
    const double h = 2.0 * std::numbers::pi / r / steps_;
    double peak = 0.0;
    for (int period = 0; period < kPeriods; ++period) {
      for (int i = 0; i < steps_; ++i) {
        step(r, h * i, h);
        if (period >= kPeriods - kLooked) peak = std::max(peak, std::abs(z_[0]));
      }
    }
    return peak;
  }

 private:
  using State = std::array<double, 4>;  // x, y, x', y'

  State rate(const State& z, double force) const {
    const double u = z[1] - z[0], v = z[3] - z[2];
    const auto& [D, k, c] = machine_.stops;
    double between = k_ * u + c_ * v;
    if (u > D) between += std::max(0.0, k * (u - D) + c * v);
    if (u < -D) between += std::min(0.0, k * (u + D) + c * v);
    return {z[2], z[3], force + between - z[0] - machine_.damping * z[2], -between / kMu};
  }

  void step(double r, double t, double h) {
    const auto moved = [this](double share, const State& by) {
      State z = z_;
      for (std::size_t i = 0; i < 4; ++i) z[i] += share * by[i];
      return z;
    };
    const double at_start = std::cos(r * t), at_middle = std::cos(r * (t + 0.5 * h)),
                 at_end = std::cos(r * (t + h));
    const State a = rate(z_, at_start), b = rate(moved(0.5 * h, a), at_middle),
                c = rate(moved(0.5 * h, b), at_middle), d = rate(moved(h, c), at_end);
    for (std::size_t i = 0; i < 4; ++i) z_[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
  }

  Machine machine_;
  double k_, c_;
  int steps_;
  State z_{};
};

// The worst peak by sweeping up and down the band.
double swept_worst(const Machine& machine, double f, double zeta, const tuning::Band& band, double spacing,
                   int steps_a_period) {
  Integration motion(machine, f, zeta, steps_a_period);
  const auto places = static_cast<int>(std::round((band.to - band.from) / spacing));
  double worst = 0.0;
  for (int i = -places; i <= places; ++i)
    worst = std::max(worst, motion.peak_at(band.to - std::abs(i) * spacing));
  return worst;
}

TEST_CASE("an absorber that hits its stops: no design of a dense grid has a lower worst peak", "[long]") {
  const Machine machine{.damping = 0.04, .stops = {}};
  const tuning::Band band{0.8, 1.2};
  const Optimum optimum = tuned(absorber_behind_stops(machine, band));
  INFO(optimum.reason << ", gap " << optimum.certificate_gap << ", KKT " << optimum.kkt_residual);
  const double f = optimum.parameters[0].value[0], zeta = optimum.parameters[1].value[0];
  INFO("f = " << f << ", zeta = " << zeta << ", worst " << optimum.objective << ", orbits "
              << optimum.orbits);
  CHECK(optimum.outcome == tuning::Outcome::converged);
  CHECK(swept_worst(machine, f, zeta, band, 0.01, 1024) == Approx(optimum.objective).epsilon(kFine));
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= 8; ++i) {
    for (int j = 0; j <= 7; ++j)
      least = std::min(least, swept_worst(machine, 0.70 + 0.03 * i, 0.03 + 0.025 * j, band, 0.01, 256));
  }
  CHECK(optimum.objective <= least * (1.0 + kCoarse));
}

}  // namespace
}  // namespace tuned_stops_test
