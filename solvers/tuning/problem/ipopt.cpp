#include "solvers/tuning/problem/ipopt.hpp"

#include <IpIpoptApplication.hpp>
#include <IpIpoptCalculatedQuantities.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <mutex>

#include "solvers/tuning/problem/scaled_problem.hpp"

namespace frahm::tuning {
namespace {

using Ipopt::Index;
using Ipopt::Number;

// Debian's Ipopt solves its linear systems with a sequential MUMPS, which keeps global state: two solves at
// once end in a segmentation fault, or end the process with exit code 0. One thread at a time may be inside
// Ipopt.
std::mutex inside_ipopt;

// Outside Ipopt for a while: other threads may solve.
class Outside {
 public:
  Outside() { inside_ipopt.unlock(); }
  ~Outside() { inside_ipopt.lock(); }
  Outside(const Outside&) = delete;
  Outside& operator=(const Outside&) = delete;
};

std::span<const double> view(const Number* values, Index count) {
  return {values, static_cast<std::size_t>(count)};
}

// Ipopt's last point, with its multipliers.
struct Optimum {
  std::vector<double> x, lower, upper, constraint;
};

// Ipopt's view of a ScaledProblem. The virtual functions and their names are Ipopt's.
class Program final : public Ipopt::TNLP {
 public:
  explicit Program(ScaledProblem& problem) : problem_(problem) {}

  Optimum optimum;

 private:
  bool get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian, IndexStyleEnum& style) override {
    n = static_cast<Index>(problem_.size());
    m = static_cast<Index>(problem_.constraints());
    jacobian = static_cast<Index>(problem_.jacobian().size());
    hessian = 0;
    style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index n, Number* x_lower, Number* x_upper, Index m, Number* g_lower,
                       Number* g_upper) override {
    for (Index i = 0; i < n; ++i) {
      x_lower[i] = problem_.lower(static_cast<std::size_t>(i));
      x_upper[i] = problem_.upper(static_cast<std::size_t>(i));
    }
    for (Index j = 0; j < m; ++j) {
      g_lower[j] = problem_.constraint_lower(static_cast<std::size_t>(j));
      g_upper[j] = problem_.constraint_upper(static_cast<std::size_t>(j));
    }
    return true;
  }

  bool get_starting_point(Index, bool, Number* start, bool, Number*, Number*, Index, bool, Number*) override {
    std::ranges::copy(problem_.start(), start);
    return true;
  }

  bool go_to(Index n, const Number* at) {
    const Outside outside;
    return problem_.go_to(view(at, n));
  }

  bool eval_f(Index n, const Number* at, bool, Number& value) override {
    if (!go_to(n, at)) return false;
    value = problem_.objective();
    return true;
  }

  bool eval_grad_f(Index n, const Number* at, bool, Number* gradient) override {
    if (!go_to(n, at)) return false;
    for (Index i = 0; i < n; ++i) gradient[i] = problem_.slope(static_cast<std::size_t>(i));
    return true;
  }

  bool eval_g(Index n, const Number* at, bool, Index m, Number* values) override {
    if (!go_to(n, at)) return false;
    for (Index j = 0; j < m; ++j) values[j] = problem_.value(static_cast<std::size_t>(j));
    return true;
  }

  bool eval_jac_g(Index n, const Number* at, bool, Index, Index entries, Index* rows, Index* columns,
                  Number* values) override {
    if (values != nullptr && !go_to(n, at)) return false;
    for (Index e = 0; e < entries; ++e) {
      const auto place = static_cast<std::size_t>(e);
      if (values != nullptr) {
        values[e] = problem_.derivative(place);
      } else {
        rows[e] = static_cast<Index>(problem_.jacobian()[place].constraint);
        columns[e] = static_cast<Index>(problem_.jacobian()[place].variable);
      }
    }
    return true;
  }

  bool intermediate_callback(Ipopt::AlgorithmMode mode, Index iteration, Number value, Number infeasibility,
                             Number optimality, Number, Number, Number, Number, Number, Index,
                             const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
    problem_.record().iterations = iteration;
    if (mode == Ipopt::RegularMode) problem_.note_iteration(iteration, infeasibility, optimality, value);
    return !problem_.ends();
  }

  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* at, const Number* z_lower,
                         const Number* z_upper, Index m, const Number*, const Number* lambda, Number,
                         const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
    optimum = {{at, at + n}, {z_lower, z_lower + n}, {z_upper, z_upper + n}, {lambda, lambda + m}};
  }

  ScaledProblem& problem_;
};

void set_options(Ipopt::OptionsList& list, const SolverOptions& options) {
  list.SetIntegerValue("print_level", 0);
  list.SetStringValue("sb", "yes");  // no banner
  list.SetStringValue("hessian_approximation", "limited-memory");
  list.SetStringValue("mu_strategy", "adaptive");
  list.SetStringValue("nlp_scaling_method", "none");  // the problem is scaled already
  list.SetNumericValue("bound_relax_factor", 0.0);    // bounds hold exactly
  list.SetIntegerValue("max_iter", options.most_iterations);
  list.SetNumericValue("tol", options.tolerance);
  list.SetNumericValue("dual_inf_tol", options.tolerance);
  list.SetNumericValue("compl_inf_tol", options.tolerance);
  list.SetNumericValue("constr_viol_tol", options.feasibility);
  list.SetNumericValue("acceptable_tol", kAcceptable * options.tolerance);
  list.SetNumericValue("acceptable_constr_viol_tol", options.feasibility);
}

// Ipopt's ending in our terms.
struct End {
  Ending ending = Ending::failed;
  const char* reason = "";
};

End end_of(Ipopt::ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
    case Ipopt::Solved_To_Acceptable_Level:
    case Ipopt::Feasible_Point_Found:
      return {Ending::failed, "Ipopt accepted a point whose KKT residual is above the tolerance"};
    case Ipopt::Infeasible_Problem_Detected:
      return {Ending::infeasible, "the constraints cannot be met near this point"};
    case Ipopt::Search_Direction_Becomes_Too_Small:
      return {Ending::failed, "Ipopt's steps became too small"};
    case Ipopt::Diverging_Iterates:
      return {Ending::diverging, "the variables grow without limit"};
    case Ipopt::Maximum_Iterations_Exceeded:
      return {Ending::iteration_limit, "the allowed iterations were used up"};
    case Ipopt::Restoration_Failed:
      return {Ending::failed, "Ipopt found no way back to the constraints"};
    case Ipopt::Error_In_Step_Computation:
      return {Ending::failed, "Ipopt could not compute a step"};
    case Ipopt::Not_Enough_Degrees_Of_Freedom:
      return {Ending::failed, "there are more equality constraints than free variables"};
    case Ipopt::Invalid_Number_Detected:
      return {Ending::failed, "the problem is not defined where Ipopt had to go"};
    case Ipopt::Insufficient_Memory:
      return {Ending::failed, "Ipopt does not have enough memory"};
    default:
      return {Ending::failed, "Ipopt failed"};
  }
}

struct Run {
  End end;
  Optimum optimum;
};

// Every object of Ipopt lives and dies in here, under the lock.
Run run(ScaledProblem& problem, const SolverOptions& options) {
  const std::lock_guard lock(inside_ipopt);
  const Ipopt::SmartPtr<Program> program = new Program(problem);
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(false);
  set_options(*application->Options(), options);
  if (application->Initialize("") != Ipopt::Solve_Succeeded) {  // "": no file of options
    return {{Ending::failed, "Ipopt does not accept its options"}, {}};
  }
  const Ipopt::SmartPtr<Ipopt::TNLP> program_of_ipopt = GetRawPtr(program);
  const End end = end_of(application->OptimizeTNLP(program_of_ipopt));
  return {end, program->optimum};
}

}  // namespace

Solution solve_with_ipopt(Problem& problem, const SolverOptions& options) {
  ScaledProblem scaled(problem, options, ScaledProblem::Judging::derivatives);
  if (!scaled.can_start()) return scaled.finish(Ending::failed);
  const auto [end, optimum] = run(scaled, options);
  scaled.record().reason = end.reason;
  if (optimum.x.empty()) return scaled.finish(end.ending);
  return scaled.finish_at(optimum.x, optimum.lower, optimum.upper, optimum.constraint, end.ending);
}

}  // namespace frahm::tuning
