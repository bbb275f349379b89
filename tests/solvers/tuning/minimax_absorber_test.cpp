#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>

#include "tests/known_answers/nishihara_asami.hpp"
#include "tests/solvers/known_optima.hpp"

// The least highest peak of an undamped mass with an absorber, in epigraph form: many constraints, few of
// them active, which is the form of every minimax tuning.
namespace frahm::tuning::minimax_absorber_test {
namespace {

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

constexpr double kPeak = 1e-9;  // of the highest peak, relative
constexpr double kTuning =
    1e-7;  // of f and zeta: along the line of equal peaks the peak is flat to first order

struct Gain {
  double value;                  // |x1| k / P
  std::array<double, 2> slopes;  // by ln f and ln zeta
};

// H = d / ((1 - r^2) d - mu r^2 g),  g = f^2 + 2 i zeta f r,  d = g - r^2; d and g have the same derivatives.
Gain gain(double mu, double f, double zeta, double r) {
  using Complex = std::complex<double>;
  const Complex g(f * f, 2.0 * zeta * f * r), d = g - r * r, D = (1.0 - r * r) * d - mu * r * r * g,
                                              H = d / D;
  const auto slope = [&](Complex dg) {
    const Complex dH = dg / D - d * (1.0 - r * r - mu * r * r) * dg / (D * D);
    return (std::conj(H) * dH).real() / std::abs(H);
  };
  const Complex by_zeta(0.0, 2.0 * zeta * f * r);
  return {std::abs(H), {slope(2.0 * f * f + by_zeta), slope(by_zeta)}};
}

// min t with t >= the gain at fixed frequencies, or at the two highest peaks, wherever they are.
class PeakTuning : public Problem {
 public:
  PeakTuning(double mu, double f, double zeta) : mu_(mu) {
    variables = {
        {.name = "ln_f", .lower = std::log(0.3), .upper = std::log(3.0), .start = std::log(f)},
        {.name = "ln_zeta", .lower = std::log(1e-3), .upper = std::log(2.0), .start = std::log(zeta)},
        {.name = "t", .start = 30.0, .scale = 30.0}};
    objective_scale = 30.0;
    for (int k = 0; k <= 200; ++k) r_.push_back(0.5 + 0.005 * k);
    lay_out();
  }

  // From x on, the peaks themselves are the constraints. By the envelope theorem their slopes are those at
  // fixed frequencies, but their curvature is not, so that the optimum is reached and not only approached.
  void follow_peaks(const std::vector<double>& x) {
    for (std::size_t i = 0; i < 3; ++i) variables[i].start = x[i];
    follows_ = true;
    r_ = peaks(x);
    lay_out();
  }

  double at(std::span<const double> x, double r) const {
    return gain(mu_, std::exp(x[0]), std::exp(x[1]), r).value;
  }

  // Where the gain is highest about each maximum of a grid, by golden sections.
  std::vector<double> peaks(std::span<const double> x) const {
    std::vector<double> found;
    const double step = 0.005, golden = 0.5 * (std::sqrt(5.0) - 1.0);
    for (double r = 0.5; r < 1.5; r += step) {
      if (at(x, r) < at(x, r - step) || at(x, r) < at(x, r + step)) continue;
      double low = r - step, high = r + step;
      while (high - low > 1e-8) {
        const double a = high - golden * (high - low), b = low + golden * (high - low);
        (at(x, a) > at(x, b) ? high : low) = at(x, a) > at(x, b) ? b : a;
      }
      found.push_back(0.5 * (low + high));
    }
    return found;
  }

  double objective(std::span<const double> x, std::span<double> gradient) override {
    if (!gradient.empty()) gradient[0] = 0.0, gradient[1] = 0.0, gradient[2] = 1.0;
    return x[2];
  }

  void constrain(std::span<const double> x, std::span<double> values, std::span<double> entries) override {
    const std::vector<double> r = follows_ ? peaks(x) : r_;
    for (std::size_t j = 0; j < values.size(); ++j) {
      // NaN where there are not as many peaks.
      const Gain g =
          gain(mu_, std::exp(x[0]), std::exp(x[1]), r.size() == values.size() ? r[j] : std::nan(""));
      values[j] = g.value - x[2];
      if (entries.empty()) continue;
      entries[3 * j] = g.slopes[0];
      entries[3 * j + 1] = g.slopes[1];
      entries[3 * j + 2] = -1.0;
    }
  }

 private:
  void lay_out() {
    constraints.assign(r_.size(), {.name = "gain", .upper = 0.0, .scale = 30.0});
    jacobian.clear();
    for (std::size_t j = 0; j < r_.size(); ++j) {
      for (std::size_t i = 0; i < 3; ++i) jacobian.push_back({j, i});
    }
  }

  double mu_;
  std::vector<double> r_;
  bool follows_ = false;
};

TEST_CASE("the least highest peak of an absorber is that of Nishihara and Asami") {
  for (const double mu : {0.02, 0.1}) {
    for (const SolverKind solver : {SolverKind::ipopt, SolverKind::slsqp}) {
      INFO(name(solver) << ", mu " << mu);
      const AbsorberOptimum exact = nishihara_asami(mu);
      PeakTuning problem(mu, 1.3, 0.03);
      const Solution on_grid = solve(problem, solver);
      CHECK(on_grid.ending == Ending::converged);
      CHECK(on_grid.objective < exact.peak);  // a grid misses the peaks
      CHECK_THAT(on_grid.objective, WithinRel(exact.peak, 1e-3));

      problem.follow_peaks(on_grid.x);
      REQUIRE(problem.constraints.size() == 2);
      const Solution solution = solve(problem, solver);
      CHECK(solution.ending <= Ending::acceptable);
      CHECK_THAT(solution.objective, WithinRel(exact.peak, kPeak));
      CHECK_THAT(std::exp(solution.x[0]), WithinAbs(exact.f, kTuning));
      CHECK_THAT(std::exp(solution.x[1]), WithinAbs(exact.zeta, kTuning));
    }
  }
}

}  // namespace
}  // namespace frahm::tuning::minimax_absorber_test
