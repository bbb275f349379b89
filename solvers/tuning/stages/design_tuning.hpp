#pragma once

#include <functional>
#include <vector>

#include "solvers/algebra/no_value.hpp"
#include "solvers/tuning/exchange/exchange.hpp"
#include "solvers/tuning/stages/design_map.hpp"

namespace frahm::tuning {

// Results of the stages of a tuning.
struct Stages {
  Exchange::Result best;               // the design and its true maxima
  Exchange::Step decisive;             // its multipliers show what holds the objective; set if best.has_step
  double bound = 0.0;                  // of the objective over its active frequencies
  Exchange::Result constant;           // the best constant design, where a parameter is scheduled
  std::vector<double> constant_value;  // of each parameter; empty where none is
  double path_bound = kNone;           // Optimum::path_bound
  std::vector<Round> rounds;           // of all stages
  std::vector<double> polished;  // objective of the best constants from each start, NaN where there are none
};

// Tunes a task under given limits from one design: the constants first, from them the schedules, and last the
// knots that the worst peak leaves free.
class DesignTuning {
 public:
  // task, stop_asked, effort: must outlive the tuning.
  DesignTuning(const Task& task, std::vector<QuantityLimit> limits, Effort& effort,
               const std::function<bool()>& stop_asked);

  // starts: at least one, a value of each parameter; the best constants of all go on. schedules: a design of
  // schedules that is known to be good; empty: none.
  Stages from(const std::vector<std::vector<double>>& starts, const std::vector<double>& schedules = {});

  // The map of all constant designs.
  DesignMap map();

  // The schedules tuned from a design, with no other stage.
  Exchange::Result schedules_from(const std::vector<double>& x);

  // The true objective of constant parameters, raised by broken limits; NaN: no value.
  double worst_of(std::span<const double> value);

  const DesignSpace& space() const { return space_; }
  const DesignSpace& constant_space() const { return constant_space_; }
  const std::vector<CurveKind>& curves() const { return curves_; }
  const std::vector<QuantityLimit>& limits() const { return limits_; }
  // The integral or variance that the task minimises (not of a minimax), at a design; NaN: no value.
  double objective_of(std::span<const double> x);
  // All local maxima of a design, low ones too.
  Scan full_scan(std::span<const double> x);
  // The maxima within a few per cent of the worst.
  Scan scan_of_worst(std::span<const double> x);

 private:
  Exchange::Result tune_constant(const std::vector<double>& value);
  Exchange::Result best_constant(const std::vector<std::vector<double>>& starts, Stages& stages);
  std::vector<CurveKind> schedule_curves(const std::vector<double>& constant) const;
  Exchange::Result tune_schedule(const std::vector<double>& value, const std::vector<double>& known);
  void settle_free_knots(double most, Stages& stages);
  void tell_bound(Stages& stages);
  std::vector<double> place_by_place(const std::vector<double>& value);
  Goal goal() const;

  const Task& task_;
  const std::vector<QuantityLimit> limits_;
  Effort& effort_;
  const std::function<bool()>& stop_asked_;
  const DesignSpace space_, constant_space_;
  std::vector<CurveKind> curves_;
};

}  // namespace frahm::tuning
