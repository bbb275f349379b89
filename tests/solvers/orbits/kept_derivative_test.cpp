#include <catch2/catch.hpp>
#include <cmath>

#include "solvers/mechanics/element_table.hpp"
#include "solvers/orbits/certificate.hpp"
#include "solvers/orbits/continuation.hpp"
#include "solvers/orbits/orbit.hpp"
#include "solvers/response/periodic_response.hpp"
#include "tests/benchmarks/works.hpp"

// The search for an orbit of a large system keeps the derivative of the period map from orbit to orbit. What
// it finds does not depend on that.
namespace frahm::periodic::kept_derivative_test {
namespace {

constexpr double kSame = 1e-9;  // of a peak: residuals of 1e-12 over 1 - contraction

// Newton's method with the exact tangent and a dense solve, from a state near the orbit; false if it fails.
bool newton(Flow<Eigen::Dynamic, Eigen::Dynamic>& flow, const Orbit<Eigen::Dynamic, Eigen::Dynamic>& orbit,
            Eigen::VectorXd& z) {
  const auto& eq = flow.equations();
  Passage<Eigen::Dynamic, Eigen::Dynamic> passage;
  for (int step = 0; step < 30; ++step) {
    Walk(flow).pass(z, orbit.section, (orbit.half_period ? 0.5 : 1.0) * eq.period, passage);
    const Eigen::VectorXd residual = orbit.sign() * passage.end - z;
    if (eq.energy_norm(residual) < 1e-13 * eq.energy_norm(z)) return true;
    Eigen::MatrixXd B = -orbit.sign() * passage.tangent;
    B.diagonal().array() += 1.0;
    z += B.partialPivLu().solve(residual);
  }
  return false;
}

TEST_CASE("An orbit found with a kept derivative is that of Newton's method within its error bound") {
  constexpr double kAway = 1e-4;  // of the state from which Newton's method starts
  benchmarks::Work work = benchmarks::shear_building(12, 3);
  const mechanics::Assembly assembly(work.network);
  mechanics::LinearSystem system;
  Flow<Eigen::Dynamic, Eigen::Dynamic> flow;
  Continuation<Eigen::Dynamic, Eigen::Dynamic> continuation(flow);
  Orbit<Eigen::Dynamic, Eigen::Dynamic> orbit;
  int compared = 0;
  for (std::size_t i = 60; i < 90; ++i) {
    mechanics::NetworkValues& values = work.rows[0][i];
    for (std::size_t e = 0; e < work.network.elements.size(); ++e) {
      if (mechanics::has_contact(work.network.elements[e])) values.element[e] *= 5.0;
    }
    assembly.set_values(values, system);
    assembly.set_forcing(values, system);
    flow.set_system(system);
    flow.set_forcing(system);
    continuation.find(system, orbit);
    REQUIRE(orbit.status == Status::ok);
    judge_stability(flow, orbit);
    Eigen::VectorXd z = (1.0 + kAway) * orbit.z;
    if (std::isnan(orbit.error_bound) || !newton(flow, orbit, z)) continue;
    INFO("omega " << values.omega);
    CHECK((z - orbit.z).head(flow.equations().masses()).cwiseAbs().maxCoeff() <= 2.0 * orbit.error_bound);
    ++compared;
  }
  CHECK(compared > 20);
}

TEST_CASE("A row of a building with stops has the orbits that its points have alone") {
  benchmarks::Work work = benchmarks::shear_building(10, 3);
  std::vector<mechanics::NetworkValues> row;
  for (std::size_t i = 60; i < 90; ++i) row.push_back(work.rows[0][i]);
  for (mechanics::NetworkValues& values : row) {
    for (std::size_t e = 0; e < work.network.elements.size(); ++e) {
      if (mechanics::has_contact(work.network.elements[e])) values.element[e] *= 5.0;
    }
  }
  const std::vector<Quantity> quantities = standard_quantities(work.network);
  const auto solve = [&](std::span<const mechanics::NetworkValues> points,
                         std::vector<ResponseSummary>& found) {
    PeriodicResponse response(work.network, quantities, Path::general);
    std::vector<double> out(points.size() * quantities.size());
    found.resize(points.size());
    response.solve_row(points, found, out);
    return out;
  };
  std::vector<ResponseSummary> along, alone;
  const std::vector<double> out = solve(row, along);
  int with_stops = 0;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::vector<double> own = solve({&row[i], 1}, alone);
    INFO("omega " << row[i].omega);
    REQUIRE(along[i].status == Status::ok);
    REQUIRE(alone[0].status == Status::ok);
    for (std::size_t q = 0; q < quantities.size(); ++q) {
      const double value = out[i * quantities.size() + q];
      if (quantities[q].measure == Measure::stops) {
        CHECK(value == own[q]);
        with_stops += value > 0.0;
      }
      if (quantities[q].measure == Measure::peak || quantities[q].measure == Measure::floquet_radius)
        CHECK(std::abs(value - own[q]) < kSame * std::abs(own[q]));
    }
  }
  CHECK(with_stops > 20);
}

}  // namespace
}  // namespace frahm::periodic::kept_derivative_test
