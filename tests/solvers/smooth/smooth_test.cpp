// Inside the arctan solver: what is left when its search is cut short, and its sensitivities.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "solvers/smooth/shooting.hpp"
#include "tests/known_answers/arctan.hpp"
#include "tests/known_answers/rig.hpp"

namespace frahm::smooth::smooth_test {
namespace {

// The rig under the arctan law with moderate friction.
struct Rig {
  explicit Rig(double slope) {
    const auto values = periodic::with_slope(periodic::rig_values(21.0, 6.36, 0.1), slope);
    assembly.set_values(values, system);
    assembly.set_forcing(values, system);
    equation.set(system, values);
  }
  Eigen::VectorXd scale() const {
    Eigen::VectorXd result(4);
    result << 0.02, 0.02, 0.4, 0.4;
    return result;
  }

  mechanics::Assembly assembly{periodic::under_arctan(periodic::rig())};
  mechanics::LinearSystem system;
  Equation equation{assembly};
};

TEST_CASE("the tangent of a smooth passage is its difference quotient") {
  // Slope v is of order 1 where an element reverses, so that the quotient converges there too.
  Rig rig(1e2);
  Integrator integrator(rig.equation);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  Passage passage, above, below;
  for (int trial = 0; trial < 5; ++trial) {
    Eigen::VectorXd z = rig.scale();
    for (double& component : z) component *= anywhere(random);
    const double duration = 0.5 * rig.equation.period();
    integrator.pass(z, 0.01, duration, rig.scale(), passage);
    REQUIRE(passage.failure == nullptr);
    for (Eigen::Index k = 0; k < 4; ++k) {
      const double h = 1e-5 * rig.scale()[k];
      Eigen::VectorXd moved = z;
      moved[k] = z[k] + h;
      integrator.pass(moved, 0.01, duration, rig.scale(), above);
      moved[k] = z[k] - h;
      integrator.pass(moved, 0.01, duration, rig.scale(), below);
      const Eigen::VectorXd quotient = (above.end - below.end) / (2 * h);
      const Eigen::VectorXd error = (passage.tangent.col(k) - quotient).cwiseQuotient(rig.scale());
      // h^2 and 1e-10/h: both some 1e-5 of a column, which is of order scale_i / scale_k.
      CHECK(error.cwiseAbs().maxCoeff() * rig.scale()[k] < 2e-5);
    }
  }
}

TEST_CASE("the jacobian of the smooth equation is the difference quotient of its rates") {
  Rig rig(30.0);
  Eigen::VectorXd z(4), above(4), below(4);
  z << 0.01, -0.02, 0.01, 0.02;
  Eigen::MatrixXd J(4, 4);
  rig.equation.jacobian(0.1, z, J);
  for (Eigen::Index k = 0; k < 4; ++k) {
    const double h = 1e-6;
    Eigen::VectorXd moved = z;
    moved[k] = z[k] + h;
    rig.equation.rates(0.1, moved, above);
    moved[k] = z[k] - h;
    rig.equation.rates(0.1, moved, below);
    CHECK((J.col(k) - (above - below) / (2 * h)).norm() < 1e-6 * J.col(k).norm());
  }
}

TEST_CASE("a search that is cut short fails with the residual it came to") {
  Rig rig(1e5);
  Integrator integrator(rig.equation);
  Shooting shooting(rig.equation, integrator, {.most_passages = 2});
  Orbit orbit;
  orbit.z = Eigen::VectorXd::Zero(4);
  orbit.half_period = true;
  shooting.find(rig.scale(), orbit);
  CHECK(orbit.status == Status::failed);
  CHECK_THAT(orbit.reason, Catch::Contains("no convergence") && Catch::Contains("residual"));
}

TEST_CASE("a motion that takes too many steps fails with that reason") {
  Rig rig(1e5);
  Integrator integrator(rig.equation, {.most_steps = 20});
  Shooting shooting(rig.equation, integrator);
  Orbit orbit;
  orbit.z = Eigen::VectorXd::Zero(4);
  shooting.find(rig.scale(), orbit);
  CHECK(orbit.status == Status::failed);
  CHECK_THAT(orbit.reason, Catch::Contains("too many steps"));
  CHECK(std::isnan(orbit.residual));
}

TEST_CASE("passages end where the work of their search is over, and begin with the next search") {
  Rig rig(1e5);
  Integrator integrator(rig.equation);
  Shooting shooting(rig.equation, integrator);
  Eigen::VectorXd z = Eigen::VectorXd::Zero(4);
  for (int search = 0; search < 2; ++search) {
    const periodic::LimitedSearch limit(integrator.work(), 1e-3);  // some 150 steps
    Orbit orbit;
    orbit.z = Eigen::VectorXd::Zero(4);
    shooting.find(rig.scale(), orbit);
    CHECK(orbit.status == Status::failed);
    CHECK(orbit.reason == periodic::kSearchIsLong);
    CHECK(orbit.passage.steps > 100);
    CHECK(!integrator.follow(z, 0.0, rig.equation.period(), rig.scale()));
  }
  CHECK(integrator.follow(z, 0.0, rig.equation.period(), rig.scale()));
}

TEST_CASE("a tolerance below rounding fails with a reason") {
  Rig rig(1e5);
  Integrator integrator(rig.equation, {.tolerance = 1e-18});
  Shooting shooting(rig.equation, integrator);
  Orbit orbit;
  orbit.z = rig.scale();
  shooting.find(rig.scale(), orbit);
  CHECK(orbit.status == Status::failed);
  CHECK_FALSE(orbit.reason.empty());
}

}  // namespace
}  // namespace frahm::smooth::smooth_test
