#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "solvers/tuning/problem/kkt.hpp"
#include "solvers/tuning/stages/starts.hpp"
#include "tests/solvers/known_optima.hpp"

// Both adapters, on optima that are known.
namespace frahm::tuning::optimisers_test {
namespace {

using Catch::Matchers::Contains;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

constexpr double kPoint = 1e-8;       // of x
constexpr double kMultiplier = 1e-7;  // relative: a multiplier is of first order in the error of x
constexpr double kGlobal = 1e-3;      // of x: a search without gradients, cut off by its evaluations

struct Solver {
  SolverKind kind;
  SolverOptions options = {};
  double point = kPoint;

  const char* name() const { return tuning::name(kind); }
  Solution solve(Problem& problem) const { return tuning::solve(problem, kind, options); }
};

// MMA takes many small steps, and by the objective alone, whose rounding hides the last digits of x.
const std::vector<Solver> local_solvers{
    {SolverKind::ipopt},
    {SolverKind::slsqp},
    {SolverKind::mma, {.tolerance = 1e-8, .most_iterations = 20000}, 1e-6}};

void check_converged(const Solution& solution, const Solver& solver) {
  INFO(name(solution.ending) << ": " << solution.reason);
  CHECK(solution.ending == Ending::converged);
  CHECK_FALSE(solution.reason.empty());
  CHECK(solution.kkt_residual <= solver.options.tolerance);
  CHECK(solution.infeasibility <= solver.options.feasibility);
  CHECK(solution.iterations > 0);
  CHECK(solution.evaluations > 0);
  CHECK_FALSE(solution.history.empty());
}

void check_point(const Solution& solution, const Solver& solver, const std::vector<double>& x) {
  REQUIRE(solution.x.size() == x.size());
  for (std::size_t i = 0; i < x.size(); ++i) CHECK_THAT(solution.x[i], WithinAbs(x[i], solver.point));
}

TEST_CASE("every local solver finds the bottom of Rosenbrock's valley") {
  for (const Solver& solver : local_solvers) {
    INFO(solver.name());
    Rosenbrock problem;
    const Solution solution = solver.solve(problem);
    check_converged(solution, solver);
    check_point(solution, solver, {1.0, 1.0});
  }
}

TEST_CASE("a region where the problem is not defined is stepped over") {
  for (const Solver& solver : local_solvers) {
    INFO(solver.name());
    Rosenbrock problem(1.6);  // the start is at a radius of 1.56, the minimum at 1.41
    const Solution solution = solver.solve(problem);
    check_converged(solution, solver);
    check_point(solution, solver, {1.0, 1.0});
  }
}

TEST_CASE("an active bound has the multiplier of what relaxing it gains") {
  for (const Solver& solver : local_solvers) {
    INFO(solver.name());
    Rosenbrock problem;
    problem.variables[0].upper = 0.5;  // min over x2 is (1 - x1)^2, its slope -1 at 0.5
    const Solution solution = solver.solve(problem);
    check_converged(solution, solver);
    check_point(solution, solver, {0.5, 0.25});
    CHECK_THAT(solution.upper_multipliers[0], WithinRel(1.0, kMultiplier));
    CHECK_THAT(solution.lower_multipliers[0], WithinAbs(0.0, kMultiplier));
  }
}

// SLSQP's line search compares values: with equality constraints their rounding can end it above 1e-9, which
// depends on the compiler's options.
TEST_CASE("Hock and Schittkowski's problem 71 has its published optimum and multipliers") {
  for (const Solver& solver : {Solver{SolverKind::ipopt}, Solver{SolverKind::slsqp, {.tolerance = 1e-8}}}) {
    INFO(solver.name());
    HockSchittkowski71 problem;
    const Solution solution = solver.solve(problem);
    check_converged(solution, solver);
    // The optimum to more figures than published: x1 = 1 leaves two equations and one stationarity, solved
    // apart.
    check_point(solution, solver, {1.0, 4.742999637, 3.821149984, 1.379408293});
    CHECK_THAT(solution.objective, WithinRel(17.0140172892, 1e-10));
    CHECK_THAT(solution.lower_multipliers[0], WithinRel(1.08787121, kMultiplier));
    CHECK_THAT(solution.constraint_multipliers[0], WithinRel(-0.55229366, kMultiplier));
    CHECK_THAT(solution.constraint_multipliers[1], WithinRel(0.16146857, kMultiplier));
  }
}

TEST_CASE("a multiplier is what relaxing its bound gains") {
  const double step = 1e-4;
  HockSchittkowski71 problem, looser, tighter;
  looser.constraints[0].lower -= step;
  tighter.constraints[0].lower += step;
  const double slope =
      (solve(tighter, SolverKind::ipopt).objective - solve(looser, SolverKind::ipopt).objective) /
      (2.0 * step);
  // Differences of second order in the step, with objectives to 1e-9.
  CHECK_THAT(-solve(problem, SolverKind::ipopt).constraint_multipliers[0], WithinAbs(slope, 2e-5));
}

TEST_CASE("a linear minimax in epigraph form has its vertex and multipliers, whatever its unit") {
  for (const double scale : {1.0, 1e-3, 1e5}) {
    for (const Solver& solver : local_solvers) {
      INFO(solver.name() << ", scale " << scale);
      LinearMinimax problem(scale);
      const Solution solution = solver.solve(problem);
      check_converged(solution, solver);
      CHECK_THAT(solution.x[0], WithinAbs(0.0, solver.point));
      CHECK_THAT(solution.x[1], WithinAbs(0.0, solver.point));
      CHECK_THAT(solution.x[2], WithinAbs(0.0, solver.point * scale));
      CHECK_THAT(solution.constraint_multipliers[0], WithinRel(1.0 / 3.0, kMultiplier));
      CHECK_THAT(solution.constraint_multipliers[1], WithinRel(1.0 / 6.0, kMultiplier));
      CHECK_THAT(solution.constraint_multipliers[2], WithinRel(1.0 / 2.0, kMultiplier));
    }
  }
}

TEST_CASE("a fixed variable stays where it is, with the multiplier of its bound") {
  for (const Solver& solver : local_solvers) {
    INFO(solver.name());
    Rosenbrock problem;
    problem.variables[0].lower = problem.variables[0].upper = 0.5;
    const Solution solution = solver.solve(problem);
    check_converged(solution, solver);
    check_point(solution, solver, {0.5, 0.25});
    CHECK_THAT(solution.upper_multipliers[0], WithinRel(1.0, kMultiplier));
    problem.variables[1].lower = problem.variables[1].upper = 0.25;
    const Solution nothing_to_do = solver.solve(problem);
    CHECK(nothing_to_do.ending == Ending::converged);
    CHECK(nothing_to_do.x == std::vector<double>{0.5, 0.25});
  }
}

// In the scale of its range, as tunings scale it, such a variable was taken to grow without limit.
TEST_CASE("a variable whose bounds are a rounding apart is fixed") {
  for (const Solver& solver : local_solvers) {
    for (const int roundings : {1, 5, 40}) {
      INFO(solver.name() << ", " << roundings);
      Rosenbrock problem;
      Variable& x = problem.variables[0];
      x.start = x.lower = x.upper = 0.5;
      for (int i = 0; i < roundings; ++i) x.upper = std::nextafter(x.upper, 1.0);
      x.scale = x.upper - x.lower;
      const Solution solution = solver.solve(problem);
      check_converged(solution, solver);
      check_point(solution, solver, {0.5, 0.25});
    }
  }
}

// x^2 <= -1.
GivenProblem infeasible_problem() {
  GivenProblem problem;
  problem.variables = {{.name = "x", .lower = -5.0, .upper = 5.0, .start = 1.0}};
  problem.constraints = {{.name = "square", .upper = -1.0}};
  problem.jacobian = {{0, 0}};
  problem.given = [](auto x, auto gradient) {
    if (!gradient.empty()) gradient[0] = 1.0;
    return x[0];
  };
  problem.constraining = [](auto x, auto values, auto entries) {
    values[0] = x[0] * x[0];
    if (!entries.empty()) entries[0] = 2.0 * x[0];
  };
  return problem;
}

TEST_CASE("constraints that cannot be met end as infeasible, where they are violated least") {
  for (const Solver& solver : local_solvers) {
    INFO(solver.name());
    GivenProblem problem = infeasible_problem();
    const Solution solution = solver.solve(problem);
    CHECK(solution.ending == Ending::infeasible);
    CHECK_THAT(solution.infeasibility, WithinAbs(1.0, 1e-6));
  }
}

TEST_CASE("an objective without limit ends as diverging or at the limit of iterations") {
  for (const Solver& solver : local_solvers) {
    INFO(solver.name());
    GivenProblem problem = infeasible_problem();
    problem.constraints.clear();
    problem.jacobian.clear();
    problem.variables[0].lower = -kInfinity;
    const Ending ending = solver.solve(problem).ending;
    CHECK((ending == Ending::diverging || ending == Ending::iteration_limit));
  }
}

TEST_CASE("a start where the problem is not defined is a failure that says so") {
  for (const Solver& solver : local_solvers) {
    INFO(solver.name());
    Rosenbrock problem(0.5);
    const Solution solution = solver.solve(problem);
    CHECK(solution.ending == Ending::failed);
    CHECK_THAT(solution.reason, Contains("not defined at the start"));
  }
}

TEST_CASE("a stop asked for ends the solve with the best point so far") {
  for (const Solver& solver : local_solvers) {
    INFO(solver.name());
    Rosenbrock valley;
    GivenProblem problem;
    int asked = 0;
    double least = kInfinity;
    problem.variables = valley.variables;
    problem.given = [&](auto x, auto gradient) {
      const double value = valley.objective(x, gradient);
      least = std::min(least, value);
      return value;
    };
    problem.stopping = [&] { return ++asked > 20; };
    const Solution solution = solver.solve(problem);
    CHECK(solution.ending == Ending::stopped);
    CHECK(solution.objective == least);
    CHECK(solution.evaluations == 21);
  }
}

TEST_CASE("the iterations allowed are kept to") {
  for (const Solver& solver : local_solvers) {
    INFO(solver.name());
    Rosenbrock problem;
    const Solution solution = Solver{solver.kind, {.most_iterations = 5}}.solve(problem);
    CHECK(solution.ending == Ending::iteration_limit);
    CHECK(solution.iterations <= 5);
    CHECK(solution.objective < 24.2);  // that of the start
  }
}

TEST_CASE("an exception of the problem comes through the solver as it was thrown") {
  for (const SolverKind kind : kSolvers) {
    INFO(name(kind));
    Rosenbrock valley;
    GivenProblem problem;
    int calls = 0;
    problem.variables = valley.variables;
    for (Variable& v : problem.variables) v.lower = -3.0, v.upper = 3.0;
    problem.given = [&](auto x, auto gradient) {
      if (++calls > 10) throw std::out_of_range("beyond the table");
      return valley.objective(x, gradient);
    };
    CHECK_THROWS_AS(Solver{kind}.solve(problem), std::out_of_range);
    CHECK(calls == 11);  // it was not asked again
  }
}

TEST_CASE("every global search comes near the bottom of the valley, the same in every run", "[slow]") {
  for (const SolverKind kind : kSolvers) {
    if (!abilities(kind).global) continue;
    INFO(name(kind));
    Rosenbrock problem(2.5);
    for (Variable& v : problem.variables) v.lower = -3.0, v.upper = 3.0;
    const Solution solution = solve(problem, kind);
    CHECK((solution.ending == Ending::iteration_limit || solution.ending == Ending::converged));
    for (const double x : solution.x) CHECK_THAT(x, WithinAbs(1.0, kGlobal));
    CHECK(solve(problem, kind).x == solution.x);
  }
}

TEST_CASE("a global search with constraints comes near the optimum") {
  LinearMinimax problem;
  problem.variables[2].lower = -50.0;
  problem.variables[2].upper = 50.0;
  const Solution solution = solve(problem, SolverKind::isres, {.most_iterations = 2000});
  CHECK(solution.infeasibility <= SolverOptions().feasibility);
  CHECK_THAT(solution.objective, WithinAbs(0.0, 0.1));  // of a range of 100, by random numbers alone
}

TEST_CASE("an algorithm refuses what it does not take, naming those that do") {
  HockSchittkowski71 equality;
  LinearMinimax inequality;
  Rosenbrock unbounded;
  CHECK_THROWS_WITH(solve(equality, SolverKind::mma), Contains("'squares'") && Contains("slsqp, isres"));
  CHECK_THROWS_WITH(solve(inequality, SolverKind::crs2), Contains("'rise'") && Contains("slsqp, mma, isres"));
  CHECK_THROWS_WITH(solve(unbounded, SolverKind::direct), Contains("'x1'") && Contains("infinite"));
  CHECK_THROWS_WITH(solver_named("simplex"), Contains("ipopt, slsqp, mma, mlsl, isres, direct, crs2"));
}

TEST_CASE("a problem that makes no sense is refused by name") {
  Rosenbrock problem;
  problem.variables[1].scale = 0.0;
  CHECK_THROWS_WITH(solve(problem, SolverKind::ipopt), Contains("scale of variable 'x2' = 0"));
  problem.variables[1] = {.name = "x2", .lower = 2.0, .upper = 1.0};
  CHECK_THROWS_WITH(solve(problem, SolverKind::slsqp), Contains("'x2' = 2") && Contains("upper bound"));
  problem.variables[1] = {.name = "x2", .start = std::nan("")};
  CHECK_THROWS_AS(solve(problem, SolverKind::ipopt), std::invalid_argument);
}

TEST_CASE("the KKT residual tells an optimum from what is none") {
  HockSchittkowski71 problem;
  const Solution solution = solve(problem, SolverKind::ipopt);
  Linearization at{.x = solution.x,
                   .objective = solution.objective,
                   .gradient = std::vector<double>(4),
                   .values = std::vector<double>(2),
                   .entries = std::vector<double>(8)};
  const auto linearize = [&] {
    problem.objective(at.x, at.gradient);
    problem.constrain(at.x, at.values, at.entries);
  };
  linearize();
  const Multipliers known{solution.lower_multipliers, solution.upper_multipliers,
                          solution.constraint_multipliers};
  CHECK(kkt_residual(problem, at, known) == solution.kkt_residual);
  // Those of least squares are the same, as the active gradients are independent.
  const Multipliers found = least_squares_multipliers(problem, at);
  CHECK_THAT(found.constraint[0], WithinRel(known.constraint[0], kMultiplier));
  CHECK_THAT(found.constraint[1], WithinRel(known.constraint[1], kMultiplier));
  CHECK_THAT(found.lower[0], WithinRel(known.lower[0], kMultiplier));

  Multipliers wrong = known;
  wrong.constraint[0] = -wrong.constraint[0];  // of an upper bound that does not exist
  CHECK(kkt_residual(problem, at, wrong) > 0.5);
  wrong = known;
  wrong.lower[1] = wrong.upper[1] = 0.1;  // of bounds that are not active
  CHECK(kkt_residual(problem, at, wrong) > 0.02);
  at.x[2] += 1e-3;
  linearize();
  CHECK(kkt_residual(problem, at, known) > 1e-4);
}

// Three valleys; the lowest is near -2.
double three_valleys(std::span<const double> x, std::span<double> gradient) {
  if (!gradient.empty()) gradient[0] = 3.0 * std::cos(3.0 * x[0]) + 0.1 * x[0] + 0.05;
  return std::sin(3.0 * x[0]) + 0.05 * x[0] * x[0] + 0.05 * x[0];
}

TEST_CASE("several starts find the lowest of several minima") {
  GivenProblem problem;
  problem.variables = {{.name = "x", .lower = -4.0, .upper = 4.0, .start = 3.0}};
  problem.given = three_valleys;
  // The reference: the lowest of a fine grid.
  double lowest = kInfinity;
  for (int k = 0; k <= 80000; ++k) {
    const double x[] = {-4.0 + 1e-4 * k};
    lowest = std::min(lowest, three_valleys(x, {}));
  }
  for (const Solver& solver : {Solver{SolverKind::ipopt}, Solver{SolverKind::slsqp}}) {
    double best = kInfinity, first = 0.0;
    for (std::size_t start = 0; start < 8; ++start) {
      problem.variables[0].start = 3.0;
      problem.variables[0].start = start_point(problem.variables, start)[0];
      const double found = solver.solve(problem).objective;
      if (start == 0) first = found;
      best = std::min(best, found);
    }
    INFO(solver.name());
    CHECK(first > lowest + 0.1);
    CHECK_THAT(best, WithinAbs(lowest, 1e-7));  // the grid is that fine
  }
}

TEST_CASE("starts fill the box evenly, and the first is the one given") {
  const std::vector<Variable> variables{{.name = "a", .lower = -2.0, .upper = 6.0, .start = 9.0},
                                        {.name = "b", .lower = 0.0, .upper = 1.0, .start = 0.25}};
  CHECK(start_point(variables, 0) == std::vector<double>{6.0, 0.25});
  std::vector<int> cells(16);
  for (std::size_t k = 1; k <= 64; ++k) {
    const std::vector<double> x = start_point(variables, k);
    CHECK((x[0] >= -2.0 && x[0] <= 6.0 && x[1] >= 0.0 && x[1] <= 1.0));
    ++cells[static_cast<std::size_t>(std::min(3.0, (x[0] + 2.0) / 2.0)) * 4 +
            static_cast<std::size_t>(std::min(3.0, x[1] * 4.0))];
  }
  CHECK(*std::min_element(cells.begin(), cells.end()) >= 3);  // of 64 points in 16 cells
  CHECK_THROWS_AS(start_point({{.name = "c"}}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace frahm::tuning::optimisers_test
