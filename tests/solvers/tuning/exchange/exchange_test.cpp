// The exchange on a mass with an absorber, whose optimum is known: what it finds, how it ends where there is
// nothing to find, and who solves its problems.
#include "solvers/tuning/exchange/exchange.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/known_answers/nishihara_asami.hpp"

namespace frahm::tuning::exchange_test {
namespace {

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

constexpr double kMu = 0.05;      // mass ratio
constexpr double kPeak = 1e-8;    // of the highest peak, relative: the exchange ends at a gap of 1e-9
constexpr double kTuning = 1e-5;  // of f and zeta: along the line of equal peaks the peak is flat
constexpr double kNoGapMeets = -1.0;

// 1 kg on 1 N/m, pushed by 1 N; an absorber of kMu kg whose spring and damper are to be tuned.
mechanics::Network network() {
  using mechanics::ElementType, mechanics::NodeKind;
  const mechanics::Node ground, main{NodeKind::mass, 0}, absorber{NodeKind::mass, 1};
  return {.masses = {"main", "absorber"},
          .elements = {{"base", ElementType::spring, ground, main},
                       {"stiffness", ElementType::spring, main, absorber},
                       {"damping", ElementType::damper, main, absorber}},
          .excitations = {{mechanics::ExcitationKind::force, 0, 1}}};
}

// at: stiffness, damping, angular frequency.
void numbers(std::size_t, std::span<const double> at, mechanics::NetworkValues& values,
             std::vector<mechanics::NetworkValues>* derivatives) {
  values = {.omega = at[2], .mass = {1.0, kMu}, .element = {1.0, at[0], at[1]}, .excitation = {{1.0, 0.0}}};
  if (!derivatives) return;
  const mechanics::NetworkValues none{
      .omega = 0.0, .mass = {0.0, 0.0}, .element = {0.0, 0.0, 0.0}, .excitation = {{0.0, 0.0}}};
  derivatives->assign(3, none);
  (*derivatives)[0].element[1] = 1.0;
  (*derivatives)[1].element[2] = 1.0;
  (*derivatives)[2].omega = 1.0;
}

Task absorber_task() {
  Task task;
  task.network = network();
  task.network_at = numbers;
  task.scenarios = {"as it is"};
  task.parameters = {{.name = "stiffness", .lower = 0.02, .upper = 0.08, .schedule = {}},
                     {.name = "damping", .lower = 1e-3, .upper = 0.05, .schedule = {}}};
  task.band = {0.5, 1.5};
  task.quantity = {.measure = periodic::Measure::amplitude, .index = 0};
  return task;
}

const std::vector<double> kStart{0.04, 0.01};

// An exchange with all that has to outlive it.
struct Tuning {
  explicit Tuning(Task given) : task(std::move(given)), space(task.parameters) {
    curves.push_back(
        {.of = CurveKind::Of::objective, .quantity = task.quantity, .band = task.band, .constant = {}});
  }
  // The main mass stays at or below `most` over the band as well.
  void limit(double most) {
    curves.push_back({.of = CurveKind::Of::upper_limit,
                      .quantity = task.quantity,
                      .band = task.band,
                      .bound = most,
                      .constant = {}});
  }
  Exchange::Result run() {
    return Exchange(task, space, curves, effort, stop_asked).run({Goal::Of::worst}, kStart);
  }

  Task task;
  DesignSpace space;
  std::vector<CurveKind> curves;
  Effort effort;
  std::function<bool()> stop_asked = [] { return false; };
};

TEST_CASE("the exchange converges on the classical absorber") {
  const Exchange::Result result = Tuning(absorber_task()).run();
  const AbsorberOptimum exact = nishihara_asami(kMu);
  REQUIRE(result.outcome == Outcome::converged);
  CHECK_THAT(result.scan.worst, WithinRel(exact.peak, kPeak));
  CHECK_THAT(result.step.solution.objective, WithinRel(exact.peak, kPeak));
  const double f = std::sqrt(result.x[0] / kMu), zeta = result.x[1] / (2.0 * kMu * f);
  CHECK_THAT(f, WithinAbs(exact.f, kTuning));
  CHECK_THAT(zeta, WithinAbs(exact.zeta, kTuning));
  for (const Round& round : result.rounds) CHECK(round.solver == SolverKind::ipopt);
}

TEST_CASE("both peaks of the optimum are followed, and share what holds it") {
  const Exchange::Result result = Tuning(absorber_task()).run();
  const Exchange::Step& step = result.step;
  REQUIRE(result.scan.maxima.size() == 2);
  double sum = 0.0;
  for (const Scan::Maximum& peak : result.scan.maxima) {
    const auto follows = [&](const ActivePoint& point) {
      return point.followed && point.from < peak.at && peak.at < point.to;
    };
    const auto point = std::find_if(step.active.begin(), step.active.end(), follows);
    REQUIRE(point != step.active.end());
    const auto place = static_cast<std::size_t>(point - step.active.begin());
    CHECK_THAT(step.responses[place], WithinRel(peak.value, kPeak));
    CHECK(step.solution.constraint_multipliers[step.rows.first + place] > 0.1);
    sum += step.solution.constraint_multipliers[step.rows.first + place];
  }
  CHECK_THAT(sum, WithinAbs(1.0, 1e-6));
}

TEST_CASE("the rounds begin with a grid and the peaks and end with little more than the peaks") {
  const std::vector<Round> rounds = Tuning(absorber_task()).run().rounds;
  CHECK(rounds.front().active >= 33 + 1);
  CHECK(rounds.back().active < 20);
}

TEST_CASE("a limit that no design meets ends as infeasible") {
  Tuning tuning(absorber_task());
  tuning.limit(0.5 * nishihara_asami(kMu).peak);
  const Exchange::Result result = tuning.run();
  CHECK(result.outcome == Outcome::infeasible);
  REQUIRE(result.has_step);
  // Of no design is the response less than that of the optimum, which is twice the limit.
  CHECK(result.scan.violation > 1.0 - kPeak);
}

TEST_CASE("an exchange that is asked to stop says so") {
  for (const int calls : {0, 50, 150}) {
    Tuning tuning(absorber_task());
    int asked = 0;
    tuning.stop_asked = [&] { return asked++ >= calls; };
    INFO(calls);
    CHECK(tuning.run().outcome == Outcome::stopped);
  }
}

TEST_CASE("where one solver does not close the gap the other tries") {
  Task task = absorber_task();
  task.tolerance = kNoGapMeets;
  task.most_rounds = 3;
  for (const auto& [first, other] :
       {std::pair(SolverKind::slsqp, SolverKind::ipopt), std::pair(SolverKind::ipopt, SolverKind::slsqp)}) {
    task.solver = first;
    const std::vector<Round> rounds = Tuning(task).run().rounds;
    const auto handed_over = std::ranges::find(rounds, other, &Round::solver);
    REQUIRE(handed_over != rounds.end());
    CHECK(handed_over != rounds.begin());
    CHECK(std::all_of(rounds.begin(), handed_over,
                      [&, first = first](const Round& round) { return round.solver == first; }));
    CHECK(std::all_of(handed_over, rounds.end(),
                      [&, other = other](const Round& round) { return round.solver == other; }));
  }
}

}  // namespace
}  // namespace frahm::tuning::exchange_test
