#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "solvers/mechanics/element_table.hpp"
#include "solvers/orbits/orbit.hpp"
#include "solvers/response/periodic_response.hpp"
#include "tests/benchmarks/works.hpp"
#include "tests/solvers/nonstop/two_ways.hpp"

// Buildings whose contacts all slide: many reversals, of which some follow others at once.
namespace frahm::periodic::structures_test {
namespace {

constexpr double kSame = 1e-10;  // of values, as difference() takes it

benchmarks::Work sliding_building(int storeys, double friction) {
  benchmarks::Work work = benchmarks::shear_building(storeys, 3);
  for (mechanics::NetworkValues& values : work.rows[0]) {
    for (std::size_t e = 0; e < work.network.elements.size(); ++e) {
      if (mechanics::has_contact(work.network.elements[e])) values.element[e] *= friction;
    }
  }
  return work;
}

struct Row {
  std::vector<ResponseSummary> found;
  std::vector<double> values;
};

Row solved(const mechanics::Network& network, const std::vector<Quantity>& quantities, Path path,
           const std::vector<mechanics::NetworkValues>& points) {
  Row row{std::vector<ResponseSummary>(points.size()),
          std::vector<double>(points.size() * quantities.size())};
  PeriodicResponse response(network, quantities, path);
  response.solve_row(points, row.found, row.values);
  return row;
}

// Near the first mode nearly all steps of the half period lie between two of its twenty reversals; at the
// others two reversals are 3e-8 to 9e-7 radians apart.
TEST_CASE("A building of sixty storeys that slides has its orbits from the phases of its reversals") {
  const benchmarks::Work work = sliding_building(60, 1e-4);
  std::vector<mechanics::NetworkValues> row;
  for (const std::size_t i : {18, 20, 23, 29, 44, 54, 73, 126}) row.push_back(work.rows[0][i]);
  std::vector<Quantity> quantities{{Measure::error_bound, 0}};
  for (std::size_t i = 0; i < 60; ++i) quantities.push_back({Measure::peak, i});
  for (std::size_t e = 0; e < work.network.elements.size(); ++e) {
    if (mechanics::has_contact(work.network.elements[e])) quantities.push_back({Measure::stops, e});
  }
  const Row fastest = solved(work.network, quantities, Path::fastest, row);
  const Row general = solved(work.network, quantities, Path::general, row);
  int with_bound = 0;
  for (std::size_t i = 0; i < row.size(); ++i) {
    INFO("omega " << row[i].omega);
    CHECK(fastest.found[i].way == Way::event_phases);
    CHECK(fastest.found[i].status == general.found[i].status);
    const auto own = [&](const Row& of) {
      const auto first = of.values.begin() + static_cast<std::ptrdiff_t>(i * quantities.size());
      return std::vector<double>(first, first + static_cast<std::ptrdiff_t>(quantities.size()));
    };
    const std::vector<double> a = own(general), b = own(fastest);
    const bool has_bound = std::isfinite(b[0]);  // none where it is wider than two reversals are apart
    with_bound += has_bound;
    for (std::size_t q = 1; q < quantities.size(); ++q) {
      const bool is_peak = quantities[q].measure == Measure::peak;
      INFO(describe(quantities[q], work.network, false).name << " " << a[q] << " and " << b[q]);
      if (is_peak && has_bound) CHECK(std::abs(a[q] - b[q]) <= a[0] + b[0]);
      CHECK(difference(q, quantities, a, b) <= kSame);
    }
  }
  CHECK(with_bound >= 6);
}

// At a tenth of the frequency orbits take nearly as many steps as may be, or more; and the largest numbers of
// steps of a group's segments add up to more than any of its lanes takes.
TEST_CASE("A building's point has the same values alone and in any company") {
  const benchmarks::Work work = sliding_building(20, 1e-6);
  const std::vector<Quantity> quantities = standard_quantities(work.network);
  std::vector<mechanics::NetworkValues> mixed;  // neighbours are far apart
  for (std::size_t i = 0; i < 48; ++i) {
    mixed.push_back(work.rows[0][i * 61 % 200]);
    if (i % 3 == 0) mixed.back().omega *= 0.1;
  }
  const Row together = solved(work.network, quantities, Path::fastest, mixed);
  int from_phases = 0;
  for (std::size_t i = 0; i < mixed.size(); ++i) {
    INFO("omega " << mixed[i].omega);
    const Row alone = solved(work.network, quantities, Path::fastest, {mixed[i]});
    REQUIRE(alone.found[0].way == together.found[i].way);
    if (alone.found[0].way != Way::event_phases) continue;
    ++from_phases;
    for (std::size_t q = 0; q < quantities.size(); ++q) {
      const double other = together.values[i * quantities.size() + q], own = alone.values[q];
      const bool same = own == other || (std::isnan(own) && std::isnan(other));
      CHECK(same);
    }
  }
  CHECK(from_phases > 40);
  CHECK(from_phases < 48);
}

}  // namespace
}  // namespace frahm::periodic::structures_test
