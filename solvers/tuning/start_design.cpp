#include "solvers/tuning/start_design.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/tuning/problem.hpp"

namespace frahm::tuning {
namespace {

// The positive root of x^(d+1) = x + 1.
double generalised_golden_ratio(std::size_t d) {
  double x = 2.0;
  for (int i = 0; i < 100; ++i) x = std::pow(1.0 + x, 1.0 / (static_cast<double>(d) + 1.0));
  return x;
}

// The box alone, and a value that needs no derivative.
class BoxProblem final : public Problem {
 public:
  BoxProblem(const DesignSpace& space, const std::function<double(std::span<const double>)>& worst_of,
             const std::function<bool()>& stop_asked)
      : worst_of_(worst_of), stop_asked_(stop_asked) {
    const std::vector<double> start = start_design(space, 0);
    for (std::size_t p = 0; p < space.parameters(); ++p) {
      const DesignParameter& parameter = space.parameter(p);
      const double range = parameter.upper - parameter.lower;
      variables.push_back(
          {parameter.name, parameter.lower, parameter.upper, start[p], range > 0.0 ? range : 1.0});
    }
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
  const std::size_t d = space.parameters();
  const double ratio = generalised_golden_ratio(d);
  std::vector<double> value(d);
  for (std::size_t p = 0; p < d; ++p) {
    const DesignParameter& parameter = space.parameter(p);
    value[p] = parameter.nominal;
    if (start > 0) {
      const double step = std::pow(ratio, -static_cast<double>(p + 1));
      const double share = std::fmod(0.5 + static_cast<double>(start) * step, 1.0);
      value[p] = parameter.lower + share * (parameter.upper - parameter.lower);
    }
    value[p] = std::clamp(value[p], parameter.lower, parameter.upper);
  }
  return value;
}

std::vector<double> global_design(const Task& task, const DesignSpace& space,
                                  const std::function<double(std::span<const double>)>& worst_of,
                                  const std::function<bool()>& stop_asked) {
  BoxProblem problem(space, worst_of, stop_asked);
  constexpr int kIterations = 40;  // of 10 (parameters + 1) designs each
  return solve_with_nlopt(problem, task.global_solver, {.most_iterations = kIterations}).x;
}

}  // namespace frahm::tuning
