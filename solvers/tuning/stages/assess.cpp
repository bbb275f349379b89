#include <algorithm>
#include <cmath>

#include "solvers/algebra/no_value.hpp"
#include "solvers/tuning/optimum.hpp"
#include "solvers/tuning/stages/design_tuning.hpp"
#include "solvers/tuning/stages/leap_place.hpp"

namespace frahm::tuning {
namespace {

constexpr double kChanges[] = {-0.10, -0.05, -0.01, 0.01, 0.05, 0.10};
constexpr int kSamples = 400;

// The task without bounds on its design parameters, so that any design can be examined, with the leaps of the
// optimum.
Task without_bounds(const Task& task, const Optimum& optimum) {
  Task open = with_knots_of(task, optimum);
  open.limits.clear();
  open.trade_off.reset();
  return open;
}

std::vector<double> variables_of(const Optimum& optimum) {
  std::vector<double> x;
  for (const TunedParameter& parameter : optimum.parameters)
    x.insert(x.end(), parameter.value.begin(), parameter.value.end());
  return x;
}

// The same values at every knot, wherever the bounds are.
std::vector<double> constants(const DesignSpace& space, std::span<const double> value) {
  std::vector<double> x(space.variables());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = value[space.parameter_of(i)];
  return x;
}

class Assessor {
 public:
  Assessor(const Task& task, const Optimum& optimum, const std::function<bool()>& stop_asked)
      : task_(without_bounds(task, optimum)),
        stop_asked_(stop_asked),
        tuning_(task_, {}, effort_, stop_asked_),
        optimum_(optimum),
        x_(variables_of(optimum)) {}

  Assessment assess(const std::vector<Rule>& rules) {
    Assessment result;
    result.band = places();
    std::vector<double> nominal;
    for (const DesignParameter& parameter : task_.parameters) nominal.push_back(parameter.nominal);
    result.curves.push_back(curve("before", tuning_, constants(tuning_.space(), nominal), result.band));
    searched_ = {};
    result.curves.push_back(curve("after", tuning_, x_, result.band));
    result.searched = searched_;
    if (!optimum_.constant.empty())
      result.curves.push_back(
          curve("constant", tuning_, constants(tuning_.space(), optimum_.constant), result.band));
    const bool has_rule =
        std::any_of(rules.begin(), rules.end(), [](const Rule& rule) { return rule != nullptr; });
    if (has_rule) result.curves.push_back(rule_curve(rules, nominal, result.band));
    result.detuning = detuning();
    return result;
  }

 private:
  // An even grid and the peaks.
  std::vector<double> places() const {
    std::vector<double> band;
    if (tuning_.curves().empty()) return band;  // white noise has none
    const double length = task_.band.to - task_.band.from;
    for (int i = 0; i <= (length > 0.0 ? kSamples : 0); ++i)
      band.push_back(task_.band.from + length * i / kSamples);
    for (const Peak& peak : optimum_.peaks) band.push_back(peak.at);
    std::sort(band.begin(), band.end());
    band.erase(std::unique(band.begin(), band.end()), band.end());
    return band;
  }

  Curve curve(const std::string& name, DesignTuning& tuning, const std::vector<double>& x,
              const std::vector<double>& band) {
    Curve result{.name = name, .value = {}, .worst = kNone};
    for (const CurveKind& kind : tuning.curves()) {
      BandCurve response(task_, tuning.space(), kind, effort_);
      response.end_rows_when(stop_asked_);
      std::vector<double>& value = result.value.emplace_back();
      if (!response.response().may_jump()) {
        response.values(x, band, value);
        searched_.points += band.size();
        continue;
      }
      for (const double at : band) {
        if (stop_asked_()) return result;
        const bool solved = response.solve(x, at, Derivatives::none) == TunedResponse::State::solved;
        value.push_back(solved ? response.value(BandCurve::larger) : kNone);
        ++searched_.points;
        if (!solved) continue;
        if (!response.response().is_periodic()) ++searched_.not_periodic;
        if (response.response().coexisting() > 1) ++searched_.several;
      }
    }
    result.worst = worst(tuning, x);
    return result;
  }

  // A schedule with knots so close that the straight lines between them stay near the rule; the rule's
  // corners, where it meets the bounds, lie within one piece.
  Curve rule_curve(const std::vector<Rule>& rules, const std::vector<double>& nominal,
                   const std::vector<double>& band) {
    constexpr int kPieces = 800;
    Task ruled = task_;
    std::vector<double> x;
    for (std::size_t p = 0; p < ruled.parameters.size(); ++p) {
      DesignParameter& parameter = ruled.parameters[p];
      parameter.schedule.reset();
      if (!rules[p]) {
        x.push_back(nominal[p]);
        continue;
      }
      parameter.schedule.emplace();
      for (int i = 0; i <= kPieces; ++i) {
        const double at = task_.band.from + (task_.band.to - task_.band.from) * i / kPieces;
        parameter.schedule->knots.push_back(at);
        x.push_back(rules[p](at));
      }
    }
    DesignTuning tuning(ruled, {}, effort_, stop_asked_);
    return curve("rule", tuning, x, band);
  }

  // The task's objective at a design.
  double worst(DesignTuning& tuning, std::span<const double> x) {
    if (task_.objective != Objective::minimax) return tuning.objective_of(x);
    const Scan scan = tuning.scan_of_worst(x);
    return scan.unbounded ? kInfinity : scan.failed ? kNone : scan.worst;
  }

  Detuning detuning() {
    Detuning result;
    result.change.assign(std::begin(kChanges), std::end(kChanges));
    const double at_optimum = worst(tuning_, x_);
    const DesignSpace& space = tuning_.space();
    for (std::size_t p = 0; p < space.parameters(); ++p) {
      std::vector<double>& growth = result.growth.emplace_back();
      for (const double change : kChanges) {
        if (stop_asked_()) return result;
        std::vector<double> x = x_;
        for (std::size_t i = space.first(p); i < space.first(p) + space.count(p); ++i) x[i] *= 1.0 + change;
        growth.push_back(worst(tuning_, x) / at_optimum - 1.0);
      }
    }
    return result;
  }

  const Task task_;
  Effort effort_;
  SearchedPoints searched_;
  const std::function<bool()>& stop_asked_;
  DesignTuning tuning_;
  const Optimum& optimum_;
  const std::vector<double> x_;
};

}  // namespace

Assessment assess(const Task& task, const Optimum& optimum, const std::vector<Rule>& rules,
                  const std::function<bool()>& stop_asked) {
  return Assessor(task, optimum, stop_asked).assess(rules);
}

}  // namespace frahm::tuning
