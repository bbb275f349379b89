// A band in which several orbits are stable: at each frequency the worst one counts, its branch is followed
// to its end, and where no motion is periodic the motion itself counts.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "solvers/laws/elastic_stop.hpp"
#include "solvers/tuning/exchange/band_scan.hpp"
#include "solvers/tuning/optimum.hpp"
#include "solvers/tuning/stages/held_without_derivative.hpp"
#include "tests/known_answers/single_mass.hpp"

namespace frahm::tuning::several_orbits_test {
namespace {

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using namespace mechanics;

constexpr double kPrinted = 1e-7;  // of the two orbits at r = 1.6, and of the fold
constexpr double kSlope = 1e-6;    // of a derivative against differences
const std::function<bool()> kGoOn = [] { return false; };

// One mass on a spring of 1 and a damper under cos(r t) between stops of stiffness 4 at a clearance of 1
// (two stable orbits at r = 1.6, the upper fold at r = 2.0018066685, X = 4.9326330).
// at: damping, r.
Task mass_between_stops() {
  Task task;
  task.network = periodic::driven_mass({periodic::elastic_stops({1.0, -1.0})});
  task.network_at = [](std::size_t, std::span<const double> at, NetworkValues& values,
                       std::vector<NetworkValues>* derivatives) {
    values = {.omega = at[1],
              .mass = {1.0},
              .element = {1.0, at[0], 4.0},
              .excitation = {{1.0, 0.0}},
              .second = {0.0, 0.0, 0.0},
              .bends = {{}, {}, {{1.0, 4.0, 0.0}, {1.0, 4.0, 0.0}}}};
    if (!derivatives) return;
    const NetworkValues none{.omega = 0.0,
                             .mass = {0.0},
                             .element = {0.0, 0.0, 0.0},
                             .excitation = {{0.0, 0.0}},
                             .second = {0.0, 0.0, 0.0},
                             .bends = {{}, {}, {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}}};
    derivatives->assign(2, none);
    (*derivatives)[0].element[1] = 1.0;
    (*derivatives)[1].omega = 1.0;
  };
  task.scenarios = {"as it is"};
  task.parameters = {{.name = "damping", .lower = 0.05, .upper = 0.4, .nominal = 0.1, .schedule = {}}};
  task.band = {1.2, 2.4};
  task.quantity = {.measure = periodic::Measure::peak, .index = 0};
  return task;
}

CurveKind kind_of(const Task& task, CurveKind::Of of, double bound = 0.0) {
  return {of, 0, 0, task.quantity, task.band, bound, {}};
}

TEST_CASE("of two stable orbits the larger counts for an upper limit, the smaller for a lower one") {
  const Task task = mass_between_stops();
  const DesignSpace space(task.parameters);
  const std::vector<double> x{0.1};
  Effort effort;
  const CurveKind most = kind_of(task, CurveKind::Of::objective),
                  least = kind_of(task, CurveKind::Of::lower_limit, 1.0);
  BandCurve larger(task, space, most, effort), smaller(task, space, least, effort);
  REQUIRE(larger.solve(x, 1.6, Derivatives::all) == TunedResponse::State::solved);
  REQUIRE(smaller.solve(x, 1.6, Derivatives::none) == TunedResponse::State::solved);
  CHECK(larger.response().coexisting() == 2);
  CHECK_THAT(larger.value(BandCurve::larger), WithinAbs(2.4531427, kPrinted));
  CHECK_THAT(smaller.quantity(BandCurve::larger), WithinAbs(0.6376804, kPrinted));

  const double slope = larger.derivative(BandCurve::larger, 0), along = larger.slope_left(BandCurve::larger);
  const auto value_at = [&](double damping, double r) {
    larger.solve(std::vector<double>{damping}, r, Derivatives::none);
    return larger.value(BandCurve::larger);
  };
  constexpr double h = 1e-5;
  CHECK_THAT(slope, WithinRel((value_at(0.1 + h, 1.6) - value_at(0.1 - h, 1.6)) / (2.0 * h), kSlope));
  CHECK_THAT(along, WithinRel((value_at(0.1, 1.6 + h) - value_at(0.1, 1.6 - h)) / (2.0 * h), kSlope));
}

TEST_CASE("a scan follows the branch of large responses to its fold, which few starts reach") {
  Task task = mass_between_stops();
  task.orbits.starts = 2;  // the linear response and rest: near the fold neither leads to the large orbit
  const DesignSpace space(task.parameters);
  const std::vector<CurveKind> curves{kind_of(task, CurveKind::Of::objective)};
  Effort effort;
  BandScan scan(task, space, curves, effort, kGoOn);
  const Scan found = scan.of(std::vector<double>{0.1}, 0.5, 1e-7);
  CHECK_FALSE(found.failed);
  // Followed by arclength the branch is highest just before its fold, with 5.0474009 at the point r
  // = 1.995959.
  CHECK(found.worst >= 5.0474009 - kPrinted);
  CHECK(found.worst < 5.0475);
  REQUIRE_FALSE(found.maxima.empty());
  const auto top = std::ranges::max_element(found.maxima, {}, &Scan::Maximum::value);
  CHECK_THAT(top->at, WithinAbs(1.996, 1e-3));
  CHECK_FALSE(top->is_end);
}

TEST_CASE("the worst peak between stops falls with the damping, to its upper bound") {
  const Optimum optimum = tune(mass_between_stops(), 0, kGoOn).at(0);
  INFO(optimum.reason);
  CHECK(optimum.outcome == Outcome::converged);
  CHECK(optimum.parameters[0].at_bound[0] == AtBound::upper);
  CHECK(optimum.objective < 2.0);
}

// The absorber behind stiff stops, which wake it up and lose it again. at: damping ratio, r.
Task restless_absorber() {
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
  task.network_at = [](std::size_t, std::span<const double> at, NetworkValues& values,
                       std::vector<NetworkValues>* derivatives) {
    constexpr double mu = 0.05, nu = 0.95;
    values = {.omega = at[1],
              .mass = {1.0, mu},
              .element = {1.0, 0.01, mu * nu * nu, 2.0 * at[0] * mu * nu, 1.0},
              .excitation = {{1.0, 0.0}},
              .second = {0.0, 0.0, 0.0, 0.0, 0.05},
              .bends = {{}, {}, {}, {}, {{10.0, 1.0, 0.05}, {10.0, 1.0, 0.05}}}};
    if (!derivatives) return;
    const NetworkValues none{.omega = 0.0,
                             .mass = {0.0, 0.0},
                             .element = {0.0, 0.0, 0.0, 0.0, 0.0},
                             .excitation = {{0.0, 0.0}},
                             .second = {0.0, 0.0, 0.0, 0.0, 0.0},
                             .bends = {{}, {}, {}, {}, {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}}};
    derivatives->assign(2, none);
    (*derivatives)[0].element[3] = 2.0 * mu * nu;
    (*derivatives)[1].omega = 1.0;
  };
  task.scenarios = {"as it is"};
  task.parameters = {{.name = "damping", .lower = 0.05, .upper = 0.06, .nominal = 0.05, .schedule = {}}};
  task.band = {1.13, 1.13};
  task.quantity = {.measure = periodic::Measure::peak, .index = 0};
  return task;
}

TEST_CASE("where no motion is periodic its worst counts, and nothing is said to have converged") {
  const Task task = restless_absorber();
  const DesignSpace space(task.parameters);
  Effort effort;
  const CurveKind kind = kind_of(task, CurveKind::Of::objective);
  BandCurve curve(task, space, kind, effort);
  REQUIRE(curve.solve(std::vector<double>{0.05}, 1.13, Derivatives::all) == TunedResponse::State::solved);
  CHECK_FALSE(curve.response().is_periodic());
  CHECK(curve.derivative(BandCurve::larger, 0) == 0.0);
  CHECK(std::isnan(curve.slope_left(BandCurve::larger)));
  const Optimum optimum = tune(task, 0, kGoOn).at(0);
  INFO(optimum.reason);
  CHECK(optimum.outcome == Outcome::not_converged);
  CHECK(optimum.objective >= 1.0);
}

TEST_CASE(
    "a design is held without derivative by the end of the highest branch or the highest motion alone") {
  const std::vector<CurveKind> curves{kind_of(restless_absorber(), CurveKind::Of::objective)};
  Scan scan;
  scan.worst = 2.0;
  scan.tightest = {{.at = 1.1, .value = 2.0}};
  scan.maxima = {{.curve = 0, .at = 1.1, .value = 2.0},
                 {.curve = 0, .at = 1.2, .value = 1.9, .is_end = true}};
  CHECK(held_without_derivative(scan, curves).empty());
  scan.maxima[1].value = 2.0;
  CHECK(held_without_derivative(scan, curves).find("ends at 1.2 of the band") != std::string::npos);
  scan.tightest[0].periodic = false;
  CHECK(held_without_derivative(scan, curves).find("at 1.1 of the band no stable") != std::string::npos);
}

}  // namespace
}  // namespace frahm::tuning::several_orbits_test
