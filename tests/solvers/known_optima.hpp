#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "solvers/tuning/problem/solver.hpp"

// Problems whose optima and multipliers are known.
namespace frahm::tuning {

// x_2 = x_1^2 valley; minimum 0 at (1, 1). H. H. Rosenbrock, Comput. J. 3 (1960) 175. Not defined where |x| >
// reach.
class Rosenbrock : public Problem {
 public:
  explicit Rosenbrock(double reach = kInfinity) : reach_(reach) {
    variables = {{.name = "x1", .start = -1.2}, {.name = "x2", .start = 1.0}};
  }

  double objective(std::span<const double> x, std::span<double> gradient) override {
    const double a = x[1] - x[0] * x[0], b = 1.0 - x[0];
    if (!gradient.empty()) {
      gradient[0] = -400.0 * a * x[0] - 2.0 * b;
      gradient[1] = 200.0 * a;
    }
    return std::hypot(x[0], x[1]) > reach_ ? std::nan("") : 100.0 * a * a + b * b;
  }
  void constrain(std::span<const double>, std::span<double>, std::span<double>) override {}

 private:
  double reach_;
};

// W. Hock, K. Schittkowski, Test Examples for Nonlinear Programming Codes, 1981, problem 71:
// minimise x1 x4 (x1 + x2 + x3) + x3 with x1 x2 x3 x4 >= 25, sum x_i^2 = 40, 1 <= x_i <= 5.
class HockSchittkowski71 : public Problem {
 public:
  HockSchittkowski71() {
    variables = {{.name = "x1", .lower = 1.0, .upper = 5.0, .start = 1.0},
                 {.name = "x2", .lower = 1.0, .upper = 5.0, .start = 5.0},
                 {.name = "x3", .lower = 1.0, .upper = 5.0, .start = 5.0},
                 {.name = "x4", .lower = 1.0, .upper = 5.0, .start = 1.0}};
    constraints = {{.name = "product", .lower = 25.0}, {.name = "squares", .lower = 40.0, .upper = 40.0}};
    for (std::size_t j = 0; j < 2; ++j) {
      for (std::size_t i = 0; i < 4; ++i) jacobian.push_back({j, i});
    }
  }

  double objective(std::span<const double> x, std::span<double> gradient) override {
    const double sum = x[0] + x[1] + x[2];
    if (!gradient.empty()) {
      gradient[0] = x[3] * (sum + x[0]);
      gradient[1] = x[0] * x[3];
      gradient[2] = x[0] * x[3] + 1.0;
      gradient[3] = x[0] * sum;
    }
    return x[0] * x[3] * sum + x[2];
  }

  void constrain(std::span<const double> x, std::span<double> values, std::span<double> entries) override {
    values[0] = x[0] * x[1] * x[2] * x[3];
    values[1] = x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3];
    for (std::size_t i = 0; i < 4 && !entries.empty(); ++i) {
      entries[i] = x[(i + 1) % 4] * x[(i + 2) % 4] * x[(i + 3) % 4];
      entries[4 + i] = 2.0 * x[i];
    }
  }
};

// min over (u, v) of max(u + v, u - 2 v, -u) in epigraph form: variables u, v, t; t - each line >= 0.
// With multipliers a, b, c of the lines: a + b + c = 1, a + b = c, a = 2 b; so (1/3, 1/6, 1/2), and t = u = v
// = 0.
class LinearMinimax : public Problem {
 public:
  explicit LinearMinimax(double scale = 1.0) {
    variables = {{.name = "u", .lower = -10.0, .upper = 10.0, .start = 3.0},
                 {.name = "v", .lower = -10.0, .upper = 10.0, .start = -4.0},
                 {.name = "t", .start = 50.0 * scale, .scale = scale}};
    constraints = {{.name = "rise", .upper = 0.0, .scale = scale},
                   {.name = "fall", .upper = 0.0, .scale = scale},
                   {.name = "back", .upper = 0.0, .scale = scale}};
    jacobian = {{0, 0}, {0, 1}, {0, 2}, {1, 0}, {1, 1}, {1, 2}, {2, 0}, {2, 2}};
    objective_scale = scale;
  }

  double objective(std::span<const double> x, std::span<double> gradient) override {
    if (!gradient.empty()) gradient[0] = 0.0, gradient[1] = 0.0, gradient[2] = 1.0;
    return x[2];
  }

  void constrain(std::span<const double> x, std::span<double> values, std::span<double> entries) override {
    const double size = objective_scale;
    values[0] = size * (x[0] + x[1]) - x[2];
    values[1] = size * (x[0] - 2.0 * x[1]) - x[2];
    values[2] = -size * x[0] - x[2];
    const double derivatives[] = {size, size, -1.0, size, -2.0 * size, -1.0, -size, -1.0};
    for (std::size_t e = 0; e < entries.size(); ++e) entries[e] = derivatives[e];
  }
};

// An objective of functions given, with constraints if `constraining` is set.
class GivenProblem : public Problem {
 public:
  using Objective = std::function<double(std::span<const double>, std::span<double>)>;
  using Constraining = std::function<void(std::span<const double>, std::span<double>, std::span<double>)>;

  Objective given;
  Constraining constraining;
  std::function<bool()> stopping = [] { return false; };

  double objective(std::span<const double> x, std::span<double> gradient) override {
    return given(x, gradient);
  }
  void constrain(std::span<const double> x, std::span<double> values, std::span<double> entries) override {
    constraining(x, values, entries);
  }
  bool stop_asked() override { return stopping(); }
};

}  // namespace frahm::tuning
