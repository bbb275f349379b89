#include "solvers/tuning/stages/optimum_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "solvers/algebra/no_value.hpp"
#include "solvers/tuning/stages/held_without_derivative.hpp"

namespace frahm::tuning {
namespace {

constexpr double kBroken = 1e-9;  // a limit exceeded by less is met
constexpr double kSlip =
    1e-6;  // by which a bound may lie above the worst peak: constraints are met to a tolerance

// What kept the last problem from its solution; "" where it was solved, and the gap stayed open nevertheless.
std::string why_open(const Solution& solution) {
  const bool solved = solution.ending == Ending::converged || solution.ending == Ending::acceptable;
  return solved ? " between the worst peak and its bound" : ": " + solution.reason;
}

std::string sentence(Outcome outcome, const Stages& stages) {
  const auto number = [](double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return std::string(text);
  };
  const Scan& scan = stages.best.scan;
  switch (outcome) {
    case Outcome::converged:
      return "the certificate gap and the KKT residual are below their tolerances";
    case Outcome::not_converged:
      return "the rounds of exchange no longer close the gap" + why_open(stages.best.step.solution);
    case Outcome::infeasible:
      return "no design was found that meets the limits: this one breaks them by " +
             number(100.0 * scan.violation) + " %" +
             (stages.best.breaks_least ? ", the least in its neighbourhood" : "");
    case Outcome::unbounded:
      return "the response has no bound at " + number(scan.at) + " of the band: " + scan.reason;
    case Outcome::failed:
      if (std::isnan(scan.at)) return "the design has no variance: " + scan.reason;
      return "the response could not be computed at " + number(scan.at) + " of the band: " + scan.reason;
    case Outcome::stopped:
      break;
  }
  return "stopped before the end";
}

// The multiplier of an active point's row, in the sense that relaxing its bound lowers the objective.
double multiplier_of(const Exchange::Step& step, std::size_t point) {
  return std::max(0.0, step.solution.constraint_multipliers[step.rows.first + point]);
}

class Report {
 public:
  Report(const Task& task, DesignTuning& tuning, const Stages& stages, Effort& effort)
      : task_(task),
        tuning_(tuning),
        stages_(stages),
        effort_(effort),
        on_constants_(stages.best.x.size() != tuning.space().variables()) {}

  Optimum written() {
    Optimum optimum;
    optimum.outcome = stages_.best.outcome;
    optimum.reason = sentence(optimum.outcome, stages_);
    optimum.rounds = stages_.rounds;
    for (const Round& round : optimum.rounds) optimum.iterations += round.iterations;
    x_ = on_constants_ ? tuning_.space().constant_design(stages_.best.x) : stages_.best.x;
    write_parameters(optimum);
    optimum.constant_objective = constant_objective();
    optimum.path_bound = stages_.path_bound;
    optimum.constant = stages_.constant_value;
    optimum.certificate_gap = optimum.kkt_residual = optimum.objective = kNone;
    if (!stages_.best.has_step) {
      if (optimum.outcome == Outcome::converged) write_nothing_moves(optimum);
      judge_multipliers(optimum);
      return optimum;
    }
    scan_ = tuning_.full_scan(x_);
    optimum.violation = is_broken(scan_.violation) ? scan_.violation : 0.0;
    judge_limits(optimum);
    if (optimum.outcome != Outcome::infeasible) optimum.kkt_residual = stages_.decisive.solution.kkt_residual;
    if (task_.objective == Objective::minimax) {
      optimum.objective = scan_.worst;
      // Where no design meets the limits nothing was pressed towards the bound.
      if (optimum.outcome != Outcome::infeasible && scan_.worst > 0.0)
        optimum.certificate_gap = (scan_.worst - stages_.bound) / scan_.worst;
      judge_certificate(optimum);
      optimum.certificate_gap = clamped(optimum.certificate_gap);
    } else {
      optimum.objective = stages_.decisive.objective_again;
      if (optimum.outcome == Outcome::converged)  // there is no bound to compare it with
        optimum.reason = "the KKT residual is below its tolerance";
    }
    write_peaks(optimum);
    write_limits(optimum);
    judge_multipliers(optimum);
    return optimum;
  }

 private:
  // By its relative excess.
  bool is_broken(double excess) const { return excess > std::max(task_.tolerance, kBroken); }

  static void write_nothing_moves(Optimum& optimum) {
    optimum.objective = optimum.certificate_gap = optimum.kkt_residual = 0.0;
    optimum.reason = "the quantity is zero over the whole band, so nothing can be reduced";
  }

  double constant_objective() const {
    if (!stages_.constant.has_step) return kNone;
    const bool minimax = task_.objective == Objective::minimax;
    return minimax ? stages_.constant.scan.worst : stages_.constant.step.objective_again;
  }

  // The last stage of a schedule may meet limits that the previous stage broke.
  void judge_limits(Optimum& optimum) const {
    if (optimum.outcome != Outcome::infeasible || is_broken(optimum.violation)) return;
    optimum.outcome = Outcome::not_converged;
    optimum.reason =
        "the limits are met, but the rounds of exchange do not show how near the objective is to its least";
  }

  // The last scan includes low peaks and starts from other points: its result is the certificate.
  void judge_certificate(Optimum& optimum) const {
    // The KKT residual is that of the active frequencies: if some are missing it does not judge the design.
    if (std::abs(optimum.certificate_gap) > std::max(task_.tolerance, kSlip)) optimum.kkt_residual = kNone;
    if (optimum.outcome != Outcome::converged) return;
    if (const std::string held = held_without_derivative(scan_, tuning_.curves()); !held.empty()) {
      optimum.outcome = Outcome::not_converged;
      optimum.reason = held;
    } else if (std::isnan(optimum.certificate_gap)) {
      optimum.outcome = Outcome::not_converged;
      optimum.reason = "the quantity is zero over the whole band: there is nothing to reduce";
    } else if (optimum.certificate_gap > task_.tolerance) {
      optimum.outcome = Outcome::not_converged;
      optimum.reason = "a last search found a higher peak than the rounds of exchange";
    } else if (optimum.certificate_gap < -kSlip) {
      optimum.outcome = Outcome::not_converged;
      optimum.reason =
          "the last search missed a peak that the problem held: something changes within a part of the band "
          "narrower than its poles";
    }
  }

  // A bound above the worst peak by more than rounding is none.
  static double clamped(double gap) { return gap < -kSlip ? kNone : gap < 0.0 ? 0.0 : gap; }

  // A multiplier counts only above rounding: a peak's by its share; a bound's or limit's by the relative fall
  // of the objective when the bound moves by a hundredth of the range, the limit by its own size.
  void judge_multipliers(Optimum& optimum) const {
    constexpr double kHolds = 1e-6;
    const bool known = optimum.outcome == Outcome::converged;
    const auto judge = [&](double& multiplier, double move, double of) {
      multiplier = !known ? kNone : multiplier * move > kHolds * of ? multiplier : 0.0;
    };
    for (Peak& peak : optimum.peaks) judge(peak.multiplier, 1.0, 1.0);
    for (std::size_t p = 0; p < optimum.parameters.size(); ++p) {
      const DesignParameter& parameter = tuning_.space().parameter(p);
      const double move = 0.01 * (parameter.upper - parameter.lower);
      for (double& m : optimum.parameters[p].lower_multiplier) judge(m, move, optimum.objective);
      for (double& m : optimum.parameters[p].upper_multiplier) judge(m, move, optimum.objective);
    }
    for (std::size_t i = 0; i < optimum.limits.size(); ++i) {
      const QuantityLimit& limit = tuning_.limits()[i];
      const double size = std::abs(std::isfinite(limit.upper) ? limit.upper : limit.lower);
      judge(optimum.limits[i].multiplier, size, optimum.objective);
    }
  }

  // Multipliers belong to bounds that are met: an interior-point method leaves rounding at the others.
  void write_parameters(Optimum& optimum) const {
    constexpr double kMet = 1e-5;  // of the range
    const DesignSpace& space = tuning_.space();
    const Solution& solution = stages_.decisive.solution;
    const bool has_multipliers = solution.lower_multipliers.size() >= space.variables();
    for (std::size_t p = 0; p < space.parameters(); ++p) {
      const DesignParameter& parameter = space.parameter(p);
      const double near = kMet * (parameter.upper - parameter.lower);
      TunedParameter tuned;
      if (parameter.schedule) tuned.knots = parameter.schedule->knots;
      for (std::size_t i = space.first(p); i < space.first(p) + space.count(p); ++i) {
        tuned.value.push_back(x_[i]);
        const AtBound at_bound = x_[i] - parameter.lower <= near   ? AtBound::lower
                                 : parameter.upper - x_[i] <= near ? AtBound::upper
                                                                   : AtBound::no;
        const bool at_lower = has_multipliers && at_bound == AtBound::lower;
        const bool at_upper = has_multipliers && at_bound == AtBound::upper;
        tuned.at_bound.push_back(at_bound);
        tuned.lower_multiplier.push_back(at_lower ? solution.lower_multipliers[i] : 0.0);
        tuned.upper_multiplier.push_back(at_upper ? solution.upper_multipliers[i] : 0.0);
      }
      optimum.parameters.push_back(std::move(tuned));
    }
  }

  // Each maximum of the objective, with the multipliers of the active points nearest to it.
  void write_peaks(Optimum& optimum) {
    for (const Scan::Maximum& maximum : scan_.maxima) {
      const CurveKind& kind = tuning_.curves()[maximum.curve];
      if (kind.of != CurveKind::Of::objective) continue;
      BandCurve curve(task_, tuning_.space(), kind, effort_);
      Peak peak{.scenario = kind.scenario, .at = maximum.at, .value = maximum.value, .sensitivity = {}};
      if (curve.solve(x_, maximum.at, Derivatives::all) == TunedResponse::State::solved) {
        for (std::size_t p = 0; p < tuning_.space().parameters(); ++p)
          peak.sensitivity.push_back(curve.derivative(BandCurve::larger, p));
      }
      optimum.peaks.push_back(peak);
    }
    const Exchange::Step& step = stages_.decisive;
    for (std::size_t i = 0; i < step.active.size(); ++i) {
      const ActivePoint& point = step.active[i];
      const CurveKind& kind = tuning_.curves()[std::min(point.curve, tuning_.curves().size() - 1)];
      if (point.curve >= tuning_.curves().size() || kind.of != CurveKind::Of::objective) continue;
      Peak* nearest = nullptr;
      for (Peak& peak : optimum.peaks) {
        if (peak.scenario != kind.scenario) continue;
        if (!nearest || std::abs(peak.at - point.at) < std::abs(nearest->at - point.at)) nearest = &peak;
      }
      if (nearest) nearest->multiplier += multiplier_of(step, i);
    }
  }

  void write_limits(Optimum& optimum) {
    optimum.limits.resize(tuning_.limits().size());
    std::vector<double> tightest(optimum.limits.size(), -kInfinity);
    for (std::size_t c = 0; c < tuning_.curves().size(); ++c) {
      const CurveKind& kind = tuning_.curves()[c];
      if (kind.of == CurveKind::Of::objective) continue;
      const Scan::Extreme& nearest = scan_.tightest[c];
      const double excess = nearest.value - kind.most();
      if (is_broken(excess))
        optimum.limits[kind.limit].excess = std::max(optimum.limits[kind.limit].excess, excess);
      if (nearest.value <= tightest[kind.limit]) continue;
      tightest[kind.limit] = nearest.value;
      BandCurve curve(task_, tuning_.space(), kind, effort_);
      LimitState& state = optimum.limits[kind.limit];
      state.at = nearest.at;
      state.scenario = kind.scenario;
      if (curve.solve(x_, nearest.at, Derivatives::none) == TunedResponse::State::solved)
        state.value = curve.quantity(BandCurve::larger);
    }
    const Exchange::Step& step = stages_.decisive;
    for (std::size_t i = 0; i < step.active.size(); ++i) {
      const std::size_t c = step.active[i].curve;
      if (c >= tuning_.curves().size() || tuning_.curves()[c].of == CurveKind::Of::objective) continue;
      // The row's bound 1 is the limit over its size.
      const double size = tuning_.curves()[c].bound != 0.0 ? std::abs(tuning_.curves()[c].bound) : 1.0;
      optimum.limits[tuning_.curves()[c].limit].multiplier += multiplier_of(step, i) / size;
    }
  }

  const Task& task_;
  DesignTuning& tuning_;
  const Stages& stages_;
  Effort& effort_;
  const bool on_constants_;  // the design is one of constants only
  std::vector<double> x_;
  Scan scan_;
};

}  // namespace

Optimum report_optimum(const Task& task, DesignTuning& tuning, const Stages& stages, Effort& effort) {
  return Report(task, tuning, stages, effort).written();
}

}  // namespace frahm::tuning
