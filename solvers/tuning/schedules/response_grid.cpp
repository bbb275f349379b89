#include "solvers/tuning/schedules/response_grid.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/algebra/no_value.hpp"
#include "solvers/orbits/orbit.hpp"

namespace frahm::tuning {
namespace {

using Index = Eigen::Index;

std::vector<periodic::Quantity> quantities_of(const Task& task, const std::vector<QuantityLimit>& limits) {
  std::vector<periodic::Quantity> quantities{task.quantity};
  for (const QuantityLimit& limit : limits) quantities.push_back(limit.quantity);
  return quantities;
}

double largest_finite(const Eigen::MatrixXd& heights) {
  double largest = 0.0;
  for (const double height : heights.reshaped()) {
    if (std::isfinite(height)) largest = std::max(largest, height);
  }
  return largest;
}

}  // namespace

GridResponses::GridResponses(const Task& task, const std::vector<QuantityLimit>& limits,
                             std::uint64_t& orbits, const std::function<bool()>& stop_asked)
    : task_(task),
      limits_(limits),
      orbits_(orbits),
      quantities_(limits.size() + 1),
      response_(task.network, quantities_of(task, limits)) {
  response_.end_rows_when(stop_asked);
}

ResponseGrid GridResponses::grid(std::span<const double> constants, std::size_t scheduled,
                                 std::span<const double> places, std::span<const double> levels) {
  const Index rows = std::ssize(places), columns = std::ssize(levels);
  ResponseGrid grid{Eigen::MatrixXd::Zero(rows, columns), Eigen::MatrixXd::Zero(rows, columns - 1)};
  Eigen::MatrixXd broken = Eigen::MatrixXd::Zero(rows, columns), of_scenario(rows, columns);
  std::vector<double> at(constants.begin(), constants.end());
  at.push_back(kNone);
  for (std::size_t s = 0; s < task_.scenarios.size(); ++s) {
    for (Index j = 0; j < columns; ++j) {
      at[scheduled] = levels[static_cast<std::size_t>(j)];
      solve_level(s, places, at);
      for (Index i = 0; i < rows; ++i) {
        const auto place = static_cast<std::size_t>(i);
        const double band = places[place], weight = task_.weight ? task_.weight(band).value : 1.0;
        of_scenario(i, j) = weight * out_[place * quantities_];
        broken(i, j) = std::max(broken(i, j), excess(place, band));
      }
    }
    // A point without a response is no reason for a height between levels, but no path goes there.
    const auto known = [](double height) { return std::isnan(height) ? 0.0 : height; };
    const auto passable = [](double height) { return std::isnan(height) ? kInfinity : height; };
    const Eigen::MatrixXd least = of_scenario.unaryExpr(known);
    grid.cells = grid.cells.cwiseMax(least.leftCols(columns - 1).cwiseMin(least.rightCols(columns - 1)));
    grid.heights = grid.heights.cwiseMax(of_scenario.unaryExpr(passable));
  }
  const double above = 2.0 * largest_finite(grid.heights);
  grid.heights = (broken.array() > 0.0).select(above * (1.0 + broken.array()), grid.heights.array());
  return grid;
}

// Fills `out_` with the quantities along the band at the parameters `at`; NaN where there is no response.
void GridResponses::solve_level(std::size_t scenario, std::span<const double> places,
                                std::vector<double>& at) {
  row_.resize(places.size());
  found_.resize(places.size());
  out_.assign(places.size() * quantities_, kNone);
  for (std::size_t i = 0; i < places.size(); ++i) {
    at.back() = places[i];
    task_.network_at(scenario, at, row_[i], nullptr);
  }
  response_.solve_row(row_, found_, out_);
  orbits_ += places.size();
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (found_[i].status == periodic::Status::unbounded) out_[i * quantities_] = kInfinity;
  }
}

// By how much the worst limit is broken, relative to it; at most 0 where all are met.
double GridResponses::excess(std::size_t place, double band) const {
  double worst = 0.0;
  for (std::size_t i = 0; i < limits_.size(); ++i) {
    const QuantityLimit& limit = limits_[i];
    const Band range = limit.band.value_or(task_.band);
    if (band < range.from || band > range.to) continue;
    const double value = out_[place * quantities_ + 1 + i];
    const auto relative = [](double by, double bound) { return bound != 0.0 ? by / std::abs(bound) : by; };
    if (std::isfinite(limit.upper)) worst = std::max(worst, relative(value - limit.upper, limit.upper));
    if (std::isfinite(limit.lower)) worst = std::max(worst, relative(limit.lower - value, limit.lower));
  }
  return worst;
}

}  // namespace frahm::tuning
