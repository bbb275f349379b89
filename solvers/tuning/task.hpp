#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/network.hpp"
#include "solvers/orbits/orbits_wanted.hpp"
#include "solvers/quantities/quantity.hpp"
#include "solvers/tuning/problem/solver.hpp"
#include "solvers/tuning/variance/noise.hpp"

// The task of a tuning: a network whose numbers depend on design parameters, a band of frequencies, and the
// objective and limits of the response over it.
//
// The subfolders; each uses those above it in this list and none below:
//   problem/    an optimisation problem in plain terms, its KKT conditions, the libraries that solve it
//   variance/   mean squares of a network under white noise
//   task.hpp, optimum.hpp   the task and its result (stages/ has the functions)
//   schedules/  design parameters as variables: constants, or piecewise linear over the band
//   exchange/   the design problem over a band: its curves, their maxima, the active ones
//   stages/     a tuning from its start to its report
//   records/    a tuning of peaks in motions under records
namespace frahm::tuning {

// A range of the band parameter, which sets the excitation's frequency [its SI unit]; from <= to.
struct Band {
  double from = 0.0, to = 0.0;
};

// A design parameter that runs over the band: piecewise linear between knots.
struct Schedule {
  std::vector<double>
      knots;  // of the band parameter, ascending, at least two, from one end of the band to the other
  double max_slope = kInfinity;  // of the parameter over the band parameter, either way
  bool may_leap = false;         // it may leap once, at a place that is tuned too
  // The piece after this knot is a leap: its two knots, kLeapWidth apart, are its sides. No slope limit holds
  // there, and no response inside it counts. Set where the place is decided.
  std::optional<std::size_t> leap = {};
};

// The share of the band's upper end that lies between the two sides of a leap.
inline constexpr double kLeapWidth = 1e-6;

struct DesignParameter {
  std::string name;
  double lower = 0.0, upper = 0.0;   // [SI], finite, lower <= upper
  double nominal = 0.0;              // as the study states it [SI]; may lie outside the bounds
  std::optional<Schedule> schedule;  // absent: one constant
};

// The numbers of the network of a scenario.
// at: SI values of the design parameters (Task::parameters order), then of the band parameter.
// derivatives: if not null, one for each entry of `at`: the derivative of the values by it, others held.
using NetworkAt =
    std::function<void(std::size_t scenario, std::span<const double> at, mechanics::NetworkValues& values,
                       std::vector<mechanics::NetworkValues>* derivatives)>;

// A factor on the response and its derivative by the band parameter.
struct Weight {
  double value = 1.0, slope = 0.0;
};

// A quantity of the response held within limits over a band.
struct QuantityLimit {
  std::string name;  // of the quantity
  periodic::Quantity quantity;
  double lower = -kInfinity;
  double upper = kInfinity;
  std::optional<Band> band;  // absent: the task's
};

enum class Objective {
  minimax,      // least maximum over the band of the weighted quantity, worst scenario
  mean_square,  // least mean over the band of its square, mean over the scenarios
  variance,     // least mean square under white noise (H2), mean over the scenarios
};

enum class Start {
  given,   // the nominal values, clipped to the bounds
  global,  // a global search of the bounds first (NLopt)
  many,    // start 0 as given, start i > 0 at the i-th point of a low-discrepancy sequence over the bounds
  map,     // a map of the whole box of constants, its lowest cells polished
};

// The same problem solved along a list of limits of one quantity, each from the optimum before it.
struct TradeOff {
  std::string name;
  periodic::Quantity quantity;
  std::vector<double> limits;  // upper limits [SI]
};

struct Task {
  mechanics::Network network;
  NetworkAt network_at;
  std::vector<std::string> scenarios;       // names, at least one
  std::vector<DesignParameter> parameters;  // at least one
  Band band;
  Objective objective = Objective::minimax;
  periodic::Quantity quantity;
  std::function<Weight(double band)> weight;  // empty: 1
  std::vector<QuantityLimit> limits;
  std::optional<TradeOff> trade_off;
  Noise noise;  // of Objective::variance
  // For a network that may have several responses, in a minimax: at each frequency the worst one found
  // counts.
  periodic::OrbitsWanted orbits;
  // Scheduled parameters only: at no frequency may the response exceed that of the best constant design.
  bool dominate_constant = false;

  SolverKind solver = SolverKind::ipopt;        // a local one
  SolverKind global_solver = SolverKind::crs2;  // of Start::global
  Start start = Start::given;
  std::size_t starts = 1;  // of Start::many
  double tolerance =
      1e-6;  // of the certificate gap, relative: work goes on until it is below or falls no more
  int most_rounds = 60;
};

// Whether a network may have several responses at a frequency: with static friction or an element that bends
// over its displacement. (Bends over the velocity are taken for rising.)
bool may_take_several_orbits(const mechanics::Network& network);

}  // namespace frahm::tuning
