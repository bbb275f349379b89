#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "solvers/algebra/no_value.hpp"
#include "solvers/tuning/task.hpp"

namespace frahm::tuning {

enum class Outcome {
  converged,      // the certificate gap and the KKT residual are below their tolerances
  not_converged,  // they are not; the design is the best found
  infeasible,     // no design met the limits; the design violates them least
  unbounded,      // the response has no bound at some frequency of the band
  failed,         // the response could not be computed; see reason
  stopped,        // by the caller
};

// A multiplier shows what holds an optimum: it is 0 for a peak, bound or limit that does not, and NaN if the
// tuning did not converge. Rounding counts as 0.

enum class AtBound { no, lower, upper };

// A design parameter at the optimum [SI]. A constant has one entry, a schedule one per knot.
struct TunedParameter {
  std::vector<double> value;
  std::vector<AtBound> at_bound;
  std::vector<double> lower_multiplier,
      upper_multiplier;  // fall of the objective per unit by which the bound is moved outwards, >= 0
  // For a schedule: where its values hold; with a leap both its sides among them.
  std::vector<double> knots = {};
};

// A local maximum of the weighted quantity over the band; in a tuning over records, of a motion over time.
struct Peak {
  std::size_t scenario = 0;
  std::size_t record = 0;   // of a tuning over records
  double at = 0.0;          // band parameter [SI], or time [s]
  double value = 0.0;       // weighted
  double multiplier = 0.0;  // its share in what holds the optimum; shares of a minimax sum to 1
  std::vector<double>
      sensitivity;  // d value / d parameter, of the design parameters and of their schedules as a whole
};

// A limit at the optimum, where it is nearest to being broken.
struct LimitState {
  double value = 0.0;  // of the quantity
  double at = 0.0;     // band parameter [SI]
  std::size_t scenario = 0;
  double excess = 0.0;      // of the value over the limit, relative to the limit; 0 where the limit is met
  double multiplier = 0.0;  // how much the objective falls per unit by which the limit is relaxed, >= 0
};

// One exchange: the problem over the active frequencies solved, then the true maxima found.
struct Round {
  std::size_t active = 0;                 // frequencies
  int iterations = 0;                     // of the optimiser
  double bound = 0.0;                     // objective of the problem over the active frequencies
  double worst = 0.0;                     // true objective of its design
  double violation = 0.0;                 // of the limits, relative
  SolverKind solver = SolverKind::ipopt;  // of the problem; after a fall-back not the task's
};

// What a tuning with Start::map saw of the box of its constants.
struct DesignsSeen {
  std::uint64_t cells = 0;  // of the map, each an equal share of the box; 0: no map
  double share = 0.0;       // of the box: cells whose design has a response
  std::vector<double>
      polished;  // objective of the best constants from each of the map's low cells; NaN: none
};

// The ends of the front of a trade-off; NaN: not found.
struct FrontEnds {
  double least = kNone;               // value of the limited quantity that no design undercuts
  double objective_at_least = kNone;  // objective under a limit one part in ten thousand above it
  double most = kNone;                // value at the optimum without that limit: higher limits gain nothing
  double objective_at_most = kNone;
};

struct Optimum {
  Outcome outcome = Outcome::failed;
  std::string reason;                      // a sentence: why the work ended
  double trade_off = 0.0;                  // the limit of the trade-off this belongs to
  std::vector<TunedParameter> parameters;  // Task::parameters order
  double objective = 0.0;  // true: worst peak found over the whole band; mean square; variance
  double certificate_gap =
      0.0;  // (objective - bound) / objective: what no active frequency has seen; minimax only, otherwise NaN
  double kkt_residual = 0.0;  // relative; of the problem over the active frequencies
  double violation = 0.0;     // largest, of the limits, relative; 0 within the tolerance
  // No schedule with these constants is lower, if the response has no valley between neighbouring levels of
  // the grid that this was found on (schedules/, path_bound); NaN: not known.
  double path_bound = kNone;
  double constant_objective = 0.0;  // of the best constant design; NaN without a schedule
  std::vector<double> constant;     // that design, Task::parameters order; empty where nothing is scheduled
  std::vector<Peak> peaks;          // ascending in scenario, then frequency
  std::vector<LimitState> limits;   // Task::limits order, then the trade-off's
  std::vector<Round> rounds;
  int iterations = 0;
  DesignsSeen seen;
  FrontEnds ends;                           // of the last problem of a trade-off
  std::uint64_t orbits = 0, gradients = 0;  // periodic responses and derivatives that it took
};

// Solves the task from one of its starts: one optimum, or one for each limit of the trade-off. The result
// depends on the task and the start alone, to the last bit. Does not throw for numerical failures; throws
// mechanics::MechanicsError for a task without meaning (NaN or reversed bounds, a quantity without
// derivative).
std::vector<Optimum> tune(const Task& task, std::size_t start, const std::function<bool()>& stop_asked);

// A comparison of a design with others, and its sensitivity to detuning: for the record and the report.
struct Detuning {
  std::vector<double> change;  // relative: -0.1 ... 0.1
  std::vector<std::vector<double>>
      growth;  // [parameter][change]: worst objective over that at the optimum, less 1
};

struct Curve {
  std::string name;                        // "before", "after", "constant", "rule"
  std::vector<std::vector<double>> value;  // [scenario][frequency], weighted quantity; NaN where it has none
  double worst = 0.0;  // the objective of the curve's design: true maximum, mean square, variance
};

// How often the curve "after" was of one of several responses, of a network that may have them.
struct SearchedPoints {
  std::size_t points = 0;        // of all scenarios
  std::size_t several = 0;       // more than one stable response was found
  std::size_t not_periodic = 0;  // none was: the worst over the motions that were followed counts
};

struct Assessment {
  std::vector<double> band;  // SI, where the curves are sampled: the peaks among them
  std::vector<Curve> curves;
  SearchedPoints searched;
  Detuning detuning;
};

// rule: values of the scheduled parameters over the band by another rule (already clipped), one function per
// parameter, empty for parameters without a rule.
// stop_asked: called between responses; once it is true the assessment ends early and is not whole.
using Rule = std::function<double(double band)>;
Assessment assess(const Task& task, const Optimum& optimum, const std::vector<Rule>& rules,
                  const std::function<bool()>& stop_asked);

}  // namespace frahm::tuning
