#pragma once

#include <functional>
#include <vector>

#include "solvers/tuning/exchange/active_problem.hpp"
#include "solvers/tuning/exchange/band_scan.hpp"
#include "solvers/tuning/optimum.hpp"

namespace frahm::tuning {

// The design problem over the whole band by exchange: solved over finitely many active frequencies, then the
// true local maxima of its design are found and join them, until the two agree (Remez 1934; R. Hettich,
// K. O. Kortanek, SIAM Review 35 (1993) 380, sec. 7).
class Exchange {
 public:
  // All must outlive the exchange.
  Exchange(const Task& task, const DesignSpace& space, const std::vector<CurveKind>& curves, Effort& effort,
           const std::function<bool()>& stop_asked);

  // The problem over the active frequencies, solved.
  struct Step {
    Solution solution;
    std::vector<double> x;            // the design alone
    std::vector<ActivePoint> active;  // whose problem it was
    std::vector<double> responses;    // of the active points at x
    RowBlock rows;                    // of the active points, among the solution's multipliers
    double objective_again = 0.0;     // the integral, with the nodes of the new design
  };

  struct Result {
    Outcome outcome = Outcome::failed;
    std::vector<double> x;  // the best design
    Scan scan;              // of it
    bool has_step = false;
    Step step;  // whose solution it is
    std::vector<Round> rounds;
    bool breaks_least = false;  // of an infeasible one: to first order no design near breaks the limits less

    void take(const Step& from, const Scan& found) {
      x = from.x;
      scan = found;
      has_step = true;
      step = from;
    }
  };
  Result run(const Goal& goal, const std::vector<double>& x);

  // The goal's integral or variance at a design; NaN: no value there.
  double integral(const Goal& goal, std::span<const double> x);

 private:
  Result best_of_least(const Goal& goal, Result least);
  Result run_with_either(const Goal& goal, const std::vector<double>& x);
  Result run_with(SolverKind solver, const Goal& goal, std::vector<double> x);
  Step solve(const Goal& goal, std::span<const double> x, const std::vector<ActivePoint>& active,
             SolverKind solver, const SolverOptions& options);
  std::vector<QuadratureNode> quadrature(std::span<const double> x, const Goal& goal) const;
  bool follows(bool near_end) const;
  static double gap_of(const Goal& goal, const Step& step, const Scan& scan);
  static Result stopped(Result result);
  bool is_broken(double violation) const;
  std::string why_no_variance(const Goal& goal, std::span<const double> x);
  void conclude(const Goal& goal, bool gap_closed, Result& result) const;

  const Task& task_;
  const DesignSpace& space_;
  const std::vector<CurveKind>& curves_;
  Effort& effort_;
  const std::function<bool()>& stop_asked_;
  BandScan scan_;
};

}  // namespace frahm::tuning
