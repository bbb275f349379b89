#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "solvers/tuning/schedules/bottleneck_path.hpp"
#include "solvers/tuning/schedules/design_space.hpp"
#include "solvers/tuning/schedules/response_grid.hpp"

namespace frahm::tuning {

// A schedule found as a path, with the constants next to it.
struct PathDesign {
  std::vector<double> x;       // of the task's design space
  double worst = 0.0;          // highest response on the grid
  std::optional<double> leap;  // place of a leap whose place was free [SI of the band]
};

// The best schedule of one parameter, as a path of least worst height over (frequency, parameter): for given
// constants globally the best of the schedules through the levels of the grid. Constants that are tuned too
// are searched over their box, each with its best path.
class PathSearch {
 public:
  // Whether a task is of this kind: a minimax with one schedule and one response at each point, that is not
  // held below another design.
  static bool serves(const Task& task);

  // All must outlive the search. orbits: counts the responses.
  PathSearch(const Task& task, const std::vector<QuantityLimit>& limits, std::uint64_t& orbits,
             const std::function<bool()>& stop_asked);

  // value: one for each parameter, constants to begin with. Nothing where every path meets a point without a
  // response, or after a stop.
  std::optional<PathDesign> best(const std::vector<double>& value);

  // A bound that no schedule with the constants of x falls below, whatever its knots, if the response rises
  // or falls all the way between neighbouring levels: the schedule passes a cell at each of the grid's
  // places, and from one to the next no more cells than its slope allows; the best such path over the least
  // responses of the cells is no higher than the schedule. Without limits of other quantities, which only
  // raise it.
  double bound(const std::vector<double>& x);

 private:
  struct Fineness {
    double pieces;       // of the band
    std::size_t levels;  // of the parameter
  };
  std::vector<double> places(double pieces, std::vector<std::size_t>& bends) const;
  std::vector<double> levels(std::size_t count) const;
  BottleneckPath path(const std::vector<double>& value, const Fineness& fineness);
  std::vector<double> best_constants(const std::vector<double>& value);
  const DesignParameter& parameter() const { return task_.parameters[scheduled_]; }

  const Task& task_;
  const DesignSpace space_;
  const std::function<bool()>& stop_asked_;
  std::size_t scheduled_ = 0;
  GridResponses responses_;
};

}  // namespace frahm::tuning
