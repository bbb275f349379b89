#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "solvers/response/periodic_response.hpp"
#include "solvers/tuning/task.hpp"

namespace frahm::tuning {

// What a design meets over places of the band (rows) and levels of one scheduled parameter (columns).
struct ResponseGrid {
  // The largest weighted response of the scenarios; above all of them where a limit is broken, the more so
  // the further it is; infinite where there is no response. Places x levels.
  Eigen::MatrixXd heights;
  // The least that the response takes between neighbouring levels if it rises or falls all the way between
  // them (the lesser of both ends, of the worst scenario; limits left out). Places x (levels - 1).
  Eigen::MatrixXd cells;
};

// Computes such grids, a level's row of frequencies at a time.
class GridResponses {
 public:
  // All must outlive it. orbits: counts the responses. stop_asked: between responses; after it a grid is not
  // whole. Not for networks that may take several orbits, of which a row tells one.
  GridResponses(const Task& task, const std::vector<QuantityLimit>& limits, std::uint64_t& orbits,
                const std::function<bool()>& stop_asked);

  // constants: SI values of all parameters; that of `scheduled` is not read.  places: of the band, ascending.
  // levels: at least two, of the scheduled parameter.
  ResponseGrid grid(std::span<const double> constants, std::size_t scheduled, std::span<const double> places,
                    std::span<const double> levels);

 private:
  void solve_level(std::size_t scenario, std::span<const double> places, std::vector<double>& at);
  double excess(std::size_t place, double band) const;

  const Task& task_;
  const std::vector<QuantityLimit>& limits_;
  std::uint64_t& orbits_;
  std::size_t quantities_;
  periodic::PeriodicResponse response_;  // of the objective's quantity, then the limits'
  std::vector<mechanics::NetworkValues> row_;
  std::vector<periodic::ResponseSummary> found_;
  std::vector<double> out_;  // place x quantity
};

}  // namespace frahm::tuning
