#include "solvers/tuning/stages/start_design.hpp"

#include <algorithm>

#include "solvers/tuning/problem/problem.hpp"
#include "solvers/tuning/stages/starts.hpp"

namespace frahm::tuning {
namespace {

// The parameters as variables of a box.
std::vector<Variable> box(const DesignSpace& space) {
  std::vector<Variable> variables;
  for (std::size_t p = 0; p < space.parameters(); ++p) {
    const DesignParameter& parameter = space.parameter(p);
    const double range = parameter.upper - parameter.lower;
    variables.push_back({.name = parameter.name,
                         .lower = parameter.lower,
                         .upper = parameter.upper,
                         .start = std::clamp(parameter.nominal, parameter.lower, parameter.upper),
                         .scale = range > 0.0 ? range : 1.0});
  }
  return variables;
}

// A box as the only constraint, and an objective without derivative.
class BoxProblem final : public Problem {
 public:
  BoxProblem(const DesignSpace& space, const std::function<double(std::span<const double>)>& worst_of,
             const std::function<bool()>& stop_asked)
      : worst_of_(worst_of), stop_asked_(stop_asked) {
    variables = box(space);
  }
  double objective(std::span<const double> x, std::span<double> gradient) override {
    std::fill(gradient.begin(), gradient.end(), 0.0);
    return worst_of_(x);
  }
  void constrain(std::span<const double>, std::span<double>, std::span<double>) override {}
  bool stop_asked() override { return stop_asked_(); }

 private:
  const std::function<double(std::span<const double>)>& worst_of_;
  const std::function<bool()>& stop_asked_;
};

}  // namespace

std::vector<double> start_design(const DesignSpace& space, std::size_t start) {
  return start_point(box(space), start);
}

std::vector<double> global_design(const Task& task, const DesignSpace& space,
                                  const std::function<double(std::span<const double>)>& worst_of,
                                  const std::function<bool()>& stop_asked) {
  BoxProblem problem(space, worst_of, stop_asked);
  constexpr int kIterations = 40;  // of 10 (parameters + 1) designs each
  return solve(problem, task.global_solver, {.most_iterations = kIterations}).x;
}

}  // namespace frahm::tuning
