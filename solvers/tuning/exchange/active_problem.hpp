#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "solvers/tuning/exchange/band_curve.hpp"
#include "solvers/tuning/exchange/band_quadrature.hpp"
#include "solvers/tuning/problem/problem.hpp"
#include "solvers/tuning/variance/variance.hpp"

namespace frahm::tuning {

// What an optimisation minimises.
struct Goal {
  enum class Of {
    worst,          // t, the worst weighted response at the active frequencies (epigraph)
    mean_square,    // of the weighted response over the band
    mean_response,  // over the band, with the worst response held under `held`
    variance,       // under white noise
  };
  Of of = Of::worst;
  double held = 0.0;
};

// A place of the band at which a side of a curve is kept under its bound, or a local maximum that is followed
// as the design changes, between two places that it does not leave.
struct ActivePoint {
  std::size_t curve = 0;  // index among the problem's curves
  double at = 0.0;
  std::size_t side = BandCurve::larger;
  bool followed = false;
  double from = 0.0, to = 0.0;  // of a followed one
};

// The design problem with finitely many frequencies, a constraint for each active point, in their order:
//   minimise t, or an integral, or a variance, over x (and t)
//   curve_i(at_i; x) <= t for the objective's curves (<= held where it is held), <= 1 for the others
//   |x_{k+1} - x_k| <= max_slope (knot_{k+1} - knot_k) of each schedule
class ActiveProblem final : public Problem {
 public:
  // All must outlive the problem. nodes: of an integral.
  ActiveProblem(const Task& task, const DesignSpace& space, const Goal& goal,
                const std::vector<CurveKind>& curves, const std::vector<ActivePoint>& active,
                const std::vector<QuadratureNode>& nodes, Effort& effort,
                const std::function<bool()>& stop_asked);

  // Variables at the design x; t is what they give.
  void start_at(std::span<const double> x);

  double objective(std::span<const double> x, std::span<double> gradient) override;
  void constrain(std::span<const double> x, std::span<double> values, std::span<double> entries) override;
  bool stop_asked() override { return stop_asked_(); }

 private:
  bool has_bound_variable() const { return goal_.of == Goal::Of::worst; }
  bool is_epigraph(std::size_t curve) const {
    return goal_.of == Goal::Of::worst && curves_[curve].of == CurveKind::Of::objective;
  }
  double bound_of(std::size_t curve) const {
    return curves_[curve].of == CurveKind::Of::objective ? goal_.held : curves_[curve].most();
  }
  void name_variables();
  void add_rows();
  void add_slope_rows();
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
};

}  // namespace frahm::tuning
