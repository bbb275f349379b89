#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <vector>

#include "solvers/orbits/orbit.hpp"
#include "solvers/response/periodic_response.hpp"
#include "tests/known_answers/single_mass.hpp"

// Rows of points that are solved one after the other end where a stop is asked for.
namespace frahm::periodic::row_end_test {
namespace {

std::vector<ResponseSummary> row_stopped_after(int points, int order) {
  mechanics::Network network = single_mass();
  network.excitations[0].order = network.reference_order = order;
  std::vector<mechanics::NetworkValues> row;
  for (int i = 0; i < 20; ++i) row.push_back(single_mass_values((0.3 + 0.02 * i) / order, 0.05, 0.6));
  PeriodicResponse response(network, {{Measure::peak, 0}, {Measure::regime, 2}}, Path::general);
  const std::function<bool()> stop_asked = [left = points]() mutable { return left-- <= 0; };
  response.end_rows_when(stop_asked);
  std::vector<ResponseSummary> found(row.size());
  std::vector<double> out(2 * row.size(), -1.0);
  response.solve_row(row, found, out);
  for (std::size_t i = 0; i < row.size(); ++i)
    CHECK((out[2 * i] == -1.0) == (found[i].status == Status::not_computed));
  return found;
}

TEST_CASE("A row ends between two of its points once a stop is asked for, the others not computed") {
  for (const int order : {1, 2}) {
    for (const int points : {0, 1, 7, 20}) {
      INFO(points << " points of order " << order);
      const auto found = row_stopped_after(points, order);
      CHECK(std::ranges::count(found, Status::not_computed, &ResponseSummary::status) == 20 - points);
    }
  }
}

}  // namespace
}  // namespace frahm::periodic::row_end_test
