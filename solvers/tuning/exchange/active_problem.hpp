#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "solvers/tuning/exchange/active_points.hpp"
#include "solvers/tuning/exchange/band_quadrature.hpp"
#include "solvers/tuning/problem/problem.hpp"
#include "solvers/tuning/variance/variance.hpp"

namespace frahm::tuning {

// Constraints of one origin, which follow each other.
struct RowBlock {
  std::size_t first = 0, count = 0;
};

// The design problem with finitely many frequencies:
//   minimise t, or an integral, or a variance, over x (and t)
//   of Goal::Of::violation:      curve_i(at_i; x) <= t for the limits' curves alone
//   responses:                   curve_i(at_i; x) <= t for the objective's curves (<= held where it is held),
//                                <= 1 for the others; row i of the block is active point i
//   slopes, one block for each   |x_{k+1} - x_k| <= max_slope (knot_{k+1} - knot_k); row k of the block is
//   schedule that has a limit:   the piece from knot k on
class ActiveProblem final : public Problem {
 public:
  // All must outlive the problem. nodes: of an integral.
  ActiveProblem(const Task& task, const DesignSpace& space, const Goal& goal,
                const std::vector<CurveKind>& curves, const std::vector<ActivePoint>& active,
                const std::vector<QuadratureNode>& nodes, Effort& effort,
                const std::function<bool()>& stop_asked);

  const RowBlock& responses() const { return response_rows_; }
  // The curves at the active points, from the values of all constraints at x.
  std::vector<double> responses_of(std::span<const double> x, std::span<const double> values) const;

  // Starts the variables at the design x; the curves there give the start of t.
  void start_at(std::span<const double> x);

  double objective(std::span<const double> x, std::span<double> gradient) override;
  void constrain(std::span<const double> x, std::span<double> values, std::span<double> entries) override;
  bool stop_asked() override { return stop_asked_(); }
  // For a variance: why it had no value, the last time that it had none.
  const std::string& why_undefined() const { return why_undefined_; }

 private:
  bool has_bound_variable() const { return goal_.is_epigraph(); }
  bool is_epigraph(std::size_t curve) const {
    const bool of_objective = curves_[curve].of == CurveKind::Of::objective;
    return goal_.is_epigraph() && of_objective == (goal_.of == Goal::Of::worst);
  }
  double bound_of(std::size_t curve) const {
    return curves_[curve].of == CurveKind::Of::objective ? goal_.held : curves_[curve].most();
  }
  void name_variables();
  // The slopes of one schedule.
  struct SlopeRows {
    RowBlock rows;
    std::size_t first_knot = 0;  // variable
  };
  void add_response_rows();
  void add_slope_rows();
  std::size_t constrain_responses(std::span<const double> x, std::span<double> values,
                                  std::span<double> entries);
  double integral(std::span<const double> x, std::span<double> gradient);
  double variance(std::span<const double> x, std::span<double> gradient);

  const Task& task_;
  const DesignSpace& space_;
  const Goal goal_;
  const std::vector<CurveKind>& curves_;
  const std::vector<ActivePoint>& active_;
  const std::vector<QuadratureNode>& nodes_;
  const std::function<bool()>& stop_asked_;
  std::vector<std::unique_ptr<BandCurve>> responses_;  // of each active point
  std::vector<CurveKind> node_curves_;
  std::vector<std::unique_ptr<BandCurve>> node_responses_;
  std::optional<Variance> variance_;
  std::string why_undefined_ = "it is not a finite number";
  RowBlock response_rows_;
  std::vector<SlopeRows> slope_rows_;
};

}  // namespace frahm::tuning
