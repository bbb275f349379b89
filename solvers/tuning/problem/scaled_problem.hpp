#pragma once

#include <exception>
#include <optional>
#include <span>
#include <vector>

#include "solvers/algebra/no_value.hpp"
#include "solvers/tuning/problem/kkt.hpp"
#include "solvers/tuning/problem/problem.hpp"

namespace frahm::tuning {

// A Problem as a library sees it: the free variables, objective and constraints, all in units of their
// scales. It remembers the best point met, however the solve ends, and keeps exceptions out of the library.
class ScaledProblem {
 public:
  // What is computed at each point. With derivatives, the problem counts as undefined at a point without a
  // gradient; with residuals, the KKT residual ranks points of equal objective.
  enum class Judging { values, derivatives, residuals };

  // Throws std::invalid_argument where the problem makes no sense.
  ScaledProblem(Problem& problem, const SolverOptions& options, Judging judging);

  std::size_t size() const { return free_.size(); }
  std::size_t constraints() const { return problem_.constraints.size(); }
  double lower(std::size_t i) const { return variable(i).lower / variable(i).scale; }
  double upper(std::size_t i) const { return variable(i).upper / variable(i).scale; }
  double constraint_lower(std::size_t j) const;
  double constraint_upper(std::size_t j) const;
  std::vector<double> start() const;
  const std::vector<JacobianEntry>& jacobian() const { return jacobian_; }  // `variable` counts free ones

  // Moves to the start. False, with the reason, where there is nothing to solve.
  bool can_start();

  // Moves to x. False where the problem is not defined there, and where the solve is to end.
  bool go_to(std::span<const double> x);
  bool ends() const { return failure_ || stopped_ || diverging_; }

  // At the point gone to last.
  double objective() const { return at_.objective / problem_.objective_scale; }
  double slope(std::size_t i) const;       // of the objective
  double value(std::size_t j) const;       // of constraint j
  double derivative(std::size_t e) const;  // of jacobian()[e]

  int evaluations() const { return solution_.evaluations; }
  double worst_objective() const { return worst_; }   // largest met
  int improvements() const { return improvements_; }  // of the best point
  double best_infeasibility() const { return best_ ? best_->infeasibility : kInfinity; }
  double best_residual() const { return best_ ? best_->residual : kInfinity; }
  std::vector<double> best() const;         // feasible, and of these least in the objective
  Solution& record() { return solution_; }  // where an adapter writes history, iterations, reason
  void note_iteration(int iteration, double infeasibility, double optimality, double objective);

  // The solution at the best point, with multipliers by least squares. `ending`: used if that point is not an
  // optimum. Rethrows what the problem's functions threw.
  Solution finish(Ending ending);

  // The same at x with the library's multipliers, both scaled; the best point instead if that is better.
  Solution finish_at(std::span<const double> x, std::span<const double> lower, std::span<const double> upper,
                     std::span<const double> constraint, Ending ending);

 private:
  struct Best {
    std::vector<double> x;  // in the problem's units, as the objective
    double objective = 0.0, infeasibility = 0.0;
    // For the KKT conditions; NaN where it was not looked at.
    double residual = kNone;
  };
  double residual() const;
  bool may_be_optimal(const Best& here) const;
  bool is_better(const Best& one, const Best& other) const;
  const Variable& variable(std::size_t i) const { return problem_.variables[free_[i]]; }
  std::vector<double> unscaled(std::span<const double> x) const;
  bool evaluate(const std::vector<double>& x);
  bool is_defined() const;
  void note_point();
  void linearize(const std::vector<double>& x);
  void hold_fixed(Multipliers& multipliers) const;
  Solution conclude(Multipliers multipliers, Ending ending) const;

  Problem& problem_;
  SolverOptions options_;
  bool with_derivatives_, with_residuals_;
  std::vector<std::size_t> free_, entry_;  // index in Problem::variables, in Problem::jacobian
  std::vector<JacobianEntry> jacobian_;
  Linearization at_;
  bool defined_ = false;  // the problem at at_.x
  double worst_ = -kInfinity;
  std::optional<Best> best_;
  int improvements_ = 0;
  Solution solution_;
  std::exception_ptr failure_;
  bool stopped_ = false, diverging_ = false;
};

// Throws std::invalid_argument where the problem makes no sense: an empty interval, a scale that is not
// positive, a start that is not finite, a Jacobian position that does not exist.
void check(const Problem& problem);

}  // namespace frahm::tuning
