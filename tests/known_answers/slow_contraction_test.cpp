#include <catch2/catch.hpp>
#include <cmath>

#include "solvers/orbits/phase.hpp"
#include "tests/known_answers/exponential_integrator.hpp"
#include "tests/known_answers/responses.hpp"

// An absorber with dry friction in place of its damper, where its response is nearly vertical over the
// friction and the period map all but the identity along one direction.
namespace frahm::periodic::slow_contraction_test {
namespace {

using namespace mechanics;
constexpr double kReturns = 1e-10;  // of the state's size; the largest multiplier is 1 - 3e-4 and more

Network absorber() {
  const Node ground{}, main{NodeKind::mass, 0}, tmd{NodeKind::mass, 1};
  return {.masses = {"main", "tmd"},
          .elements = {{"s", ElementType::spring, ground, main},
                       {"t", ElementType::spring, main, tmd},
                       {"c", ElementType::coulomb, main, tmd}},
          .excitations = {{ExcitationKind::force, 0, 1}}};
}

NetworkValues absorber_values(double f, double F, double r) {
  constexpr double mu = 0.05;
  return {.omega = r, .mass = {1.0, mu}, .element = {1.0, mu * f * f, F}, .excitation = {{1.0, 0.0}}};
}

struct Point {
  double f, F, r;
  double least, most;  // main_peak: those of a branch along F at the next F on both sides
};

TEST_CASE("Where the response is nearly vertical over the friction each point has its orbit") {
  // The branches: F = 1.1193157739 and 1.1193261853; 0.4335592320 (before) and 0.4335597995.
  for (const auto& [f, F, r, least, most] : {Point{0.98, 1.1193220339, 0.995, 27.618416, 27.636728},
                                             Point{0.8, 0.43355932, 1.0225, 11.7070, 11.7141}}) {
    INFO("f " << f);
    const NetworkValues values = absorber_values(f, F, r);
    Responses responses(absorber());
    const auto summary = responses.solve(values);
    INFO(summary.reason);
    REQUIRE(has_response(summary.status));
    CHECK(responses["main_peak"] > least);
    CHECK(responses["main_peak"] < most);
    const History history = responses.response().history(phases_of_a_period(2));
    Eigen::VectorXd q(2), v(2);
    for (Eigen::Index i = 0; i < 2; ++i) {
      q[i] = history.columns[static_cast<std::size_t>(2 * i)][0];
      v[i] = history.columns[static_cast<std::size_t>(2 * i + 1)][0];
    }
    ExponentialIntegrator reference(responses.network(), values);
    reference.start(q, v);
    reference.pass_period();
    const double size = std::max(q.cwiseAbs().maxCoeff(), v.cwiseAbs().maxCoeff());
    CHECK((reference.displacements() - q).cwiseAbs().maxCoeff() < kReturns * size);
    CHECK((reference.velocities() - v).cwiseAbs().maxCoeff() < kReturns * size);
  }
}

}  // namespace
}  // namespace frahm::periodic::slow_contraction_test
