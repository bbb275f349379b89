#include "solvers/tuning/problem/nlopt.hpp"

#include <nlopt.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "solvers/tuning/problem/scaled_problem.hpp"

namespace frahm::tuning {
namespace {

// Seed of the random numbers of global searches, the same in every solve.
constexpr unsigned long kSeed = 1909;
// Relative steps at which a local search ends without reaching the tolerance, and a local search within a
// global one.
constexpr double kSteps = 1e-15;
constexpr double kSettled = 1e-8;
// Limit for MMA's inner problem, which otherwise does not end because of its last digits.
constexpr double kDualEvaluations = 1000;
// Restarts of a local search from the best point; each must halve the KKT residual.
constexpr int kRestarts = 20;
// Evaluations of a global search per iteration and (variables + 1).
constexpr int kPopulation = 10;

nlopt_algorithm code_of(SolverKind kind) {
  switch (kind) {
    case SolverKind::ipopt:
      break;
    case SolverKind::slsqp:
      return NLOPT_LD_SLSQP;
    case SolverKind::mma:
      return NLOPT_LD_MMA;
    case SolverKind::mlsl:
      return NLOPT_G_MLSL_LDS;
    case SolverKind::isres:
      return NLOPT_GN_ISRES;
    case SolverKind::direct:
      return NLOPT_GN_DIRECT_L;
    case SolverKind::crs2:
      return NLOPT_GN_CRS2_LM;
  }
  throw std::invalid_argument("NLopt has no solver '" + std::string(name(kind)) + "'");
}

// One side of a constraint as NLopt takes it: sign (g - bound) <= 0, or = 0.
struct Side {
  std::size_t constraint = 0;
  double sign = 1.0, bound = 0.0;
};

// NLopt's view of a ScaledProblem.
class Program {
 public:
  Program(ScaledProblem& problem, SolverKind kind, const SolverOptions& options)
      : problem_(problem),
        code_(code_of(kind)),
        is_global_(abilities(kind).global),
        tolerance_(options.tolerance),
        feasibility_(options.feasibility) {
    for (std::size_t j = 0; j < problem.constraints(); ++j) {
      const double lower = problem.constraint_lower(j), upper = problem.constraint_upper(j);
      if (lower == upper) {
        equal_.push_back({j, 1.0, upper});
        continue;
      }
      if (upper < kInfinity) unequal_.push_back({j, 1.0, upper});
      if (lower > -kInfinity) unequal_.push_back({j, -1.0, lower});
    }
  }

  // From x, to where NLopt ends.
  nlopt_result run(std::vector<double>& x, int most_evaluations);

 private:
  using Solver = std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)>;

  // The value of a point where the problem is not defined: higher than any other; for DIRECT, which computes
  // with the values, as high as the highest.
  double undefined() const {
    return code_ == NLOPT_GN_DIRECT_L ? std::max(problem_.worst_objective(), -1e300) : kInfinity;
  }

  bool go_to(unsigned n, const double* x) {
    const bool defined = problem_.go_to({x, n});
    record_improvement();
    if (defined) return true;
    if (problem_.ends()) nlopt_force_stop(solver_);
    return false;
  }

  // A local search ends at an optimum; NLopt itself does not recognise it.
  void record_improvement() {
    int& recorded = problem_.record().iterations;
    if (problem_.improvements() == recorded) return;
    recorded = problem_.improvements();
    const double residual = problem_.best_residual();
    problem_.note_iteration(recorded, problem_.best_infeasibility(), residual, problem_.objective());
    if (is_global_) return;
    if (residual <= tolerance_ && problem_.best_infeasibility() <= feasibility_) nlopt_force_stop(solver_);
  }

  static double objective(unsigned n, const double* x, double* gradient, void* self) {
    auto& program = *static_cast<Program*>(self);
    if (!program.go_to(n, x)) return program.undefined();
    for (unsigned i = 0; gradient != nullptr && i < n; ++i) gradient[i] = program.problem_.slope(i);
    return program.problem_.objective();
  }

  void constrain(const std::vector<Side>& sides, double* values, unsigned n, const double* x,
                 double* gradients) {
    const bool defined = go_to(n, x);
    std::fill_n(gradients, gradients == nullptr ? 0 : sides.size() * n, 0.0);
    for (std::size_t k = 0; k < sides.size(); ++k) {
      const Side& side = sides[k];
      values[k] = defined ? side.sign * (problem_.value(side.constraint) - side.bound) : kInfinity;
    }
    if (gradients == nullptr || !defined) return;
    for (std::size_t e = 0; e < problem_.jacobian().size(); ++e) {
      const auto [j, i] = problem_.jacobian()[e];
      for (std::size_t k = 0; k < sides.size(); ++k) {
        if (sides[k].constraint == j) gradients[k * n + i] = sides[k].sign * problem_.derivative(e);
      }
    }
  }

  static void constrain_unequal(unsigned, double* values, unsigned n, const double* x, double* gradients,
                                void* self) {
    auto& program = *static_cast<Program*>(self);
    program.constrain(program.unequal_, values, n, x, gradients);
  }

  static void constrain_equal(unsigned, double* values, unsigned n, const double* x, double* gradients,
                              void* self) {
    auto& program = *static_cast<Program*>(self);
    program.constrain(program.equal_, values, n, x, gradients);
  }

  void add_constraints();

  ScaledProblem& problem_;
  const nlopt_algorithm code_;
  const bool is_global_;
  double tolerance_, feasibility_;
  std::vector<Side> unequal_, equal_;
  nlopt_opt solver_ = nullptr;
};

void Program::add_constraints() {
  const auto add = [&](auto function, auto constraint, const std::vector<Side>& sides) {
    if (sides.empty()) return;
    const std::vector<double> tolerances(sides.size(), feasibility_);
    function(solver_, static_cast<unsigned>(sides.size()), constraint, this, tolerances.data());
  };
  add(nlopt_add_inequality_mconstraint, &Program::constrain_unequal, unequal_);
  add(nlopt_add_equality_mconstraint, &Program::constrain_equal, equal_);
}

nlopt_result Program::run(std::vector<double>& x, int most_evaluations) {
  const auto n = static_cast<unsigned>(problem_.size());
  const Solver solver(nlopt_create(code_, n), &nlopt_destroy);
  if (!solver) throw std::bad_alloc();
  solver_ = solver.get();
  std::vector<double> lower(n), upper(n);
  for (unsigned i = 0; i < n; ++i) lower[i] = problem_.lower(i), upper[i] = problem_.upper(i);
  for (unsigned i = 0; i < n; ++i) x[i] = std::clamp(x[i], lower[i], upper[i]);
  nlopt_set_min_objective(solver_, &Program::objective, this);
  nlopt_set_lower_bounds(solver_, lower.data());
  nlopt_set_upper_bounds(solver_, upper.data());
  add_constraints();
  if (!is_global_) nlopt_set_xtol_rel(solver_, kSteps);
  nlopt_set_maxeval(solver_, most_evaluations);
  if (code_ == NLOPT_G_MLSL_LDS) {
    const Solver local(nlopt_create(NLOPT_LD_SLSQP, n), &nlopt_destroy);
    nlopt_set_xtol_rel(local.get(), kSettled);
    nlopt_set_ftol_rel(local.get(), kSettled);
    nlopt_set_local_optimizer(solver_, local.get());
  }
  nlopt_set_param(solver_, "dual_maxeval", kDualEvaluations);
  nlopt_srand(kSeed);  // its generator belongs to the thread
  double value = 0.0;
  return nlopt_optimize(solver_, x.data(), &value);
}

const char* reason_of(nlopt_result result) {
  switch (result) {
    case NLOPT_MAXEVAL_REACHED:
      return "the allowed evaluations were used up";
    case NLOPT_FTOL_REACHED:
    case NLOPT_XTOL_REACHED:
    case NLOPT_SUCCESS:
      return "the steps became too small";
    case NLOPT_ROUNDOFF_LIMITED:
      return "rounding leaves no step that improves the objective";
    case NLOPT_OUT_OF_MEMORY:
      return "NLopt does not have enough memory";
    default:
      return "NLopt found no step";
  }
}

// A local search may end because rounding hides the remaining gain or its Hessian has become bad: it restarts
// at the best point as long as that helps.
Solution descend(Program& program, ScaledProblem& scaled, const SolverOptions& options) {
  std::vector<double> x = scaled.start();
  double residual = kInfinity;
  for (int restart = 0;; ++restart) {
    const nlopt_result result = program.run(x, std::max(1, options.most_iterations - scaled.evaluations()));
    scaled.record().reason = reason_of(result);
    const bool used_up = result == NLOPT_MAXEVAL_REACHED || scaled.evaluations() >= options.most_iterations;
    const Solution solution = scaled.finish(used_up ? Ending::iteration_limit : Ending::failed);
    const bool gains = solution.kkt_residual < 0.5 * residual;
    if (solution.ending == Ending::converged || used_up || scaled.ends() || !gains || restart == kRestarts) {
      return solution;
    }
    residual = solution.kkt_residual;
    x = scaled.best();
  }
}

Solution search(Program& program, ScaledProblem& scaled, const SolverOptions& options) {
  const int population = kPopulation * (static_cast<int>(scaled.size()) + 1);
  std::vector<double> x = scaled.start();
  scaled.record().reason = reason_of(program.run(x, population * options.most_iterations));
  return scaled.finish(Ending::iteration_limit);
}

}  // namespace

Solution solve_with_nlopt(Problem& problem, SolverKind kind, const SolverOptions& options) {
  using Judging = ScaledProblem::Judging;
  ScaledProblem scaled(problem, options, abilities(kind).gradients ? Judging::residuals : Judging::values);
  const bool defined = scaled.can_start();
  if (scaled.size() == 0 || scaled.ends()) return scaled.finish(Ending::failed);
  Program program(scaled, kind, options);
  if (abilities(kind).global) return search(program, scaled, options);
  return defined ? descend(program, scaled, options) : scaled.finish(Ending::failed);
}

}  // namespace frahm::tuning
