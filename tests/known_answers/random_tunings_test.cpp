// Tunings drawn at random against searches that know nothing of them: a map of the box with a search about
// its best cells, and NLopt's global searches, given many times the responses of the tuning.
#include <catch2/catch.hpp>
#include <cmath>

#include "solvers/tuning/optimum.hpp"
#include "solvers/tuning/stages/design_tuning.hpp"
#include "solvers/tuning/stages/start_design.hpp"
#include "tests/known_answers/random_tuning.hpp"

namespace random_tunings_test {
namespace {

using namespace frahm;
using namespace frahm::tuning;

constexpr double kWorse = 1e-4;  // by which a search may at most be better, relative
constexpr double kMet = 1e-7;    // a limit broken by less is met

// Least violation first, then the least objective.
using Score = std::pair<double, double>;

class Searches {
 public:
  explicit Searches(const Task& task)
      : task_(task),
        tuning_(task, task.limits, effort_, never_stop_),
        scan_(task, tuning_.space(), tuning_.curves(), effort_, never_stop_) {}

  // For searches that take more than so many responses together.
  Score best(std::uint64_t responses) {
    std::vector<Trial> trials = map();
    const auto by_score = [](const Trial& a, const Trial& b) { return a.score < b.score; };
    std::ranges::sort(trials, by_score);
    Score best = trials.front().score;
    Task task = task_;
    for (const SolverKind solver : {SolverKind::crs2, SolverKind::direct}) {
      task.global_solver = solver;
      const auto worst_of = [&](std::span<const double> x) { return tuning_.worst_of(x); };
      best = std::min(best, score(global_design(task, tuning_.constant_space(), worst_of, never_stop_)));
    }
    for (unsigned search = 0; search < 4 || effort_.orbits <= responses; ++search)
      best = std::min(best, searched_about(trials[search * 5 % trials.size()], search));
    return best;
  }
  std::uint64_t responses() const { return effort_.orbits; }

 private:
  struct Trial {
    std::vector<double> shares;  // of each parameter's range, by ratios
    Score score;
  };

  std::vector<double> design(const std::vector<double>& shares) const {
    std::vector<double> x;
    for (std::size_t p = 0; p < shares.size(); ++p) {
      const DesignParameter& parameter = task_.parameters[p];
      const double value = parameter.lower * std::pow(parameter.upper / parameter.lower, shares[p]);
      x.push_back(std::clamp(value, parameter.lower, parameter.upper));
    }
    return x;
  }

  Score score(const std::vector<double>& x) {
    const Scan scan = scan_.of(x, 0.9, 1e-6);
    if (scan.failed || scan.unbounded) return {kInfinity, kInfinity};
    return {std::max(0.0, scan.violation - kMet), scan.worst};
  }

  std::vector<Trial> map() {
    const std::size_t n = task_.parameters.size(), along = n == 2 ? 25 : 9;
    const auto cells = static_cast<std::size_t>(std::lround(std::pow(along, n)));
    std::vector<Trial> trials;
    for (std::size_t cell = 0; cell < cells; ++cell) {
      std::vector<double> shares;
      for (std::size_t p = 0, rest = cell; p < n; ++p, rest /= along)
        shares.push_back(static_cast<double>(rest % along) / static_cast<double>(along - 1));
      const Score found = score(design(shares));
      trials.push_back({std::move(shares), found});
    }
    return trials;
  }

  // Steps in random directions, longer after a gain and shorter after several without.
  Score searched_about(Trial trial, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    int fails = 0;
    for (double step = 0.05; step > 1e-5;) {
      std::vector<double> direction(trial.shares.size()), shares = trial.shares;
      double square = 0.0;
      for (double& each : direction) square += std::pow(each = normal(random), 2);
      for (std::size_t p = 0; p < shares.size(); ++p)
        shares[p] = std::clamp(shares[p] + step * direction[p] / std::sqrt(square), 0.0, 1.0);
      const Score found = score(design(shares));
      if (found < trial.score) {
        trial = {std::move(shares), found};
        fails = 0;
        step *= 1.3;
      } else if (++fails > 8) {
        step *= 0.5;
        fails = 0;
      }
    }
    return trial.score;
  }

  const Task& task_;
  Effort effort_;
  const std::function<bool()> never_stop_ = [] { return false; };
  DesignTuning tuning_;
  BandScan scan_;
};

Task drawn(unsigned number) {
  std::mt19937 random(1000 + number);
  Task task = random_tuning(random);
  task.start = Start::map;
  task.solver = SolverKind::slsqp;
  return task;
}

// The searches take so many times the responses of the tuning.
void check_against_searches(unsigned number, std::uint64_t times) {
  const Task task = drawn(number);
  const Optimum optimum = tune(task, 0, [] { return false; }).at(0);
  Searches searches(task);
  const auto [violation, objective] = searches.best(times * optimum.orbits);
  INFO("tuning " << number << ": objective " << optimum.objective << ", violation " << optimum.violation
                 << "; searched: " << objective << ", violation " << violation << "; " << optimum.reason);
  CHECK(searches.responses() > times * optimum.orbits);
  if (violation > 0.0) {
    CHECK(optimum.outcome == Outcome::infeasible);
    CHECK(optimum.violation <= violation + kMet + kWorse * (1.0 + violation));
    return;
  }
  CHECK(optimum.outcome == Outcome::converged);
  CHECK(optimum.certificate_gap >= 0.0);
  CHECK(optimum.objective <= objective * (1.0 + kWorse));
}

// One of which the given start leads to a local optimum 71 % higher; one with limits that no design meets, in
// two valleys.
TEST_CASE("no search of the whole box finds a better design than a tuning from its map", "[long]") {
  for (const unsigned number : {1u, 60u}) check_against_searches(number, 10);
}

// More than an hour: test_known_answers "[thorough]".
TEST_CASE("None does of 100 drawn tunings", "[.thorough]") {
  for (unsigned number = 0; number < 100; ++number) check_against_searches(number, 100);
}

TEST_CASE("a solver that gets stuck is followed by another, which converges") {
  Task task = drawn(4);
  task.start = Start::given;
  task.solver = SolverKind::slsqp;
  const Optimum optimum = tune(task, 0, [] { return false; }).at(0);
  CHECK(optimum.outcome == Outcome::converged);
  CHECK(optimum.rounds.front().solver == SolverKind::slsqp);
  CHECK(optimum.rounds.back().solver == SolverKind::ipopt);
}

// It ended too early here, with a bound above the peak.
TEST_CASE("by MMA the rounds go on until the bound is not above the peak") {
  Task task = drawn(14);
  task.start = Start::given;
  task.solver = SolverKind::mma;
  const Optimum optimum = tune(task, 0, [] { return false; }).at(0);
  CHECK(optimum.outcome == Outcome::converged);
  CHECK(std::abs(optimum.certificate_gap) <= task.tolerance);
}

TEST_CASE("a tuning from a map is the same from any given start, and tells what it saw") {
  Task task = drawn(1);
  const Optimum one = tune(task, 0, [] { return false; }).at(0);
  for (DesignParameter& parameter : task.parameters) parameter.nominal = parameter.lower;
  const Optimum other = tune(task, 0, [] { return false; }).at(0);
  CHECK(one.objective == other.objective);
  CHECK(one.seen.cells == 121);
  CHECK(one.seen.share == 1.0);
  REQUIRE(one.seen.polished.size() > 1);
  CHECK(*std::ranges::min_element(one.seen.polished) == Approx(one.objective).epsilon(1e-6));
}

TEST_CASE("where no design meets the limits the answer is the one that breaks them least", "[slow]") {
  // The least stroke, tuned for itself, shows by how much a limit of half as much must be broken.
  Task least = drawn(1);
  least.quantity = {periodic::Measure::stroke, 2};
  const Optimum lowest = tune(least, 0, [] { return false; }).at(0);
  REQUIRE(lowest.outcome == Outcome::converged);
  Task task = drawn(1);
  task.limits = {{"stroke", least.quantity, -kInfinity, 0.5 * lowest.objective, {}}};
  for (const Start start : {Start::map, Start::given}) {
    task.start = start;
    const Optimum optimum = tune(task, 0, [] { return false; }).at(0);
    CHECK(optimum.outcome == Outcome::infeasible);
    CHECK_THAT(optimum.reason, Catch::Contains("the least in its neighbourhood"));
    CHECK(std::isnan(optimum.certificate_gap));
    if (start == Start::map) CHECK(optimum.violation == Approx(1.0).epsilon(1e-6));
  }
}

}  // namespace
}  // namespace random_tunings_test
