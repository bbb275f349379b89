// Many solves in several threads at once, each compared bit by bit with the same solve alone. Its last line
// is the end marker: MUMPS in two threads can end a process with exit code 0, so the exit code proves
// nothing.
//   concurrent_solves THREADS SOLVES          SOLVES of each solver in each of THREADS threads
//   concurrent_solves --ends-early            ends with exit code 0 and without the marker
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <thread>

#include "tests/solvers/known_optima.hpp"

namespace frahm::tuning {
namespace {

// Rosenbrock valleys in a chain, of another length and start in each solve.
class Chain : public GivenProblem {
 public:
  explicit Chain(int solve) {
    const int length = 2 + solve % 5;
    for (int i = 0; i < length; ++i) {
      variables.push_back(
          {.name = "x", .lower = -2.0, .upper = 2.0, .start = -1.2 + 0.1 * ((solve + i) % 7)});
    }
    given = [](std::span<const double> x, std::span<double> gradient) {
      double sum = 0.0;
      std::fill(gradient.begin(), gradient.end(), 0.0);
      for (std::size_t i = 0; i + 1 < x.size(); ++i) {
        const double a = x[i + 1] - x[i] * x[i], b = 1.0 - x[i];
        sum += 100.0 * a * a + b * b;
        if (gradient.empty()) continue;
        gradient[i] += -400.0 * a * x[i] - 2.0 * b;
        gradient[i + 1] += 200.0 * a;
      }
      return sum;
    };
  }
};

std::vector<double> bits_of(SolverKind solver, int index) {
  Chain chain(index);
  const SolverOptions search{.most_iterations = solver == SolverKind::ipopt ? 500 : 30};
  const Solution solution = solve(chain, solver, search);
  std::vector<double> bits = solution.x;
  bits.insert(bits.end(), {solution.objective, solution.kkt_residual, double(solution.evaluations)});
  return bits;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

struct Task {
  SolverKind solver;
  int index = 0;
};

// Every thread does every task, each from another one on, so that unlike solves meet; compared with those
// alone.
int differences(int threads, const std::vector<Task>& tasks) {
  std::vector<std::vector<double>> alone;
  for (const Task& task : tasks) alone.push_back(bits_of(task.solver, task.index));
  std::atomic<int> different = 0;
  std::vector<std::thread> team;
  for (int t = 0; t < threads; ++t) {
    team.emplace_back(
        [&, first = tasks.size() * static_cast<std::size_t>(t) / static_cast<std::size_t>(threads)] {
          for (std::size_t k = 0; k < tasks.size(); ++k) {
            const std::size_t place = (first + k) % tasks.size();
            if (!same_bits(bits_of(tasks[place].solver, tasks[place].index), alone[place])) ++different;
          }
        });
  }
  for (std::thread& thread : team) thread.join();
  return different;
}

}  // namespace
}  // namespace frahm::tuning

int main(int count, char** arguments) {
  if (count == 2 && std::string(arguments[1]) == "--ends-early") std::_Exit(0);
  if (count != 3) return 2;
  const int threads = std::atoi(arguments[1]), solves = std::atoi(arguments[2]);
  std::vector<frahm::tuning::Task> every_solver, ipopt;
  for (int k = 0; k < solves; ++k) {
    for (const frahm::tuning::SolverKind solver : frahm::tuning::kSolvers)
      every_solver.push_back({solver, k});
    for (int repeat = 0; repeat < 5; ++repeat) ipopt.push_back({frahm::tuning::SolverKind::ipopt, k});
  }
  const int different =
      frahm::tuning::differences(threads, every_solver) + frahm::tuning::differences(threads, ipopt);
  std::cout << "solves that differ: " << different << std::endl;
}
