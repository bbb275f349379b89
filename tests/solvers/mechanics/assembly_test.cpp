#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <limits>

#include "solvers/mechanics/linear_system.hpp"
#include "tests/known_answers/rig.hpp"

namespace frahm::mechanics::assembly_test {
namespace {

using Catch::Matchers::Contains;

LinearSystem system_of(const Network& network, const NetworkValues& values) {
  const Assembly assembly(network);
  LinearSystem system;
  assembly.set_values(values, system);
  assembly.set_forcing(values, system);
  return system;
}

std::string refusal(const Network& network, const NetworkValues& values) {
  try {
    system_of(network, values);
  } catch (const MechanicsError& error) {
    return error.what();
  }
  return "accepted";
}

TEST_CASE("The rig's matrices are those of its equations of motion") {
  constexpr double kRounding = 1e-12;
  const double I = 6.36, omega = 25.0, k = 10985.1, c = 26.5104 + 0.4811 * I, K = 8181.0, A = 0.02955;
  const LinearSystem system = system_of(periodic::rig(), periodic::rig_values(omega, I, 0.05));
  Eigen::Matrix2d M, C, Kmatrix, W;
  M << 102.66 + I, -I, -I, 12.82 + I;
  C << 1.7688 + c, -c, -c, c;
  Kmatrix << 7.0 * K + k, -k, -k, k;
  W << 1.0, 1.0, 0.0, -1.0;
  CHECK((system.M - M).norm() < kRounding);
  CHECK((system.C - C).norm() < kRounding);
  CHECK((system.K - Kmatrix).norm() < kRounding * K);
  CHECK(system.W == W);
  CHECK(system.limit == Eigen::Vector2d(0.05 * K * A, 15.0109));
  CHECK(system.odd_forcing);
  // K a(t) = K A sin(omega t) = Re(-i K A e^{i omega t}) on the main mass
  CHECK(std::abs(system.force(0, 0) - std::complex<double>(0.0, -K * A)) < kRounding * K);
  CHECK(std::abs(system.force(1, 0)) == 0.0);
  CHECK(system.applied_force.isZero(0.0));
}

TEST_CASE("A support acts through springs, dampers and inerters together") {
  const Node mass{NodeKind::mass, 0}, support{NodeKind::prescribed, 0};
  const Network network{.masses = {"m"},
                        .prescribed = {"s"},
                        .elements = {{"k", ElementType::spring, support, mass},
                                     {"c", ElementType::damper, mass, support},
                                     {"b", ElementType::inerter, support, mass}},
                        .excitations = {{ExcitationKind::motion, 0, 2}, {ExcitationKind::motion, 0, 0}},
                        .reference_order = 2};
  const double omega = 1.5, rate = 2.0 * omega, Y = 0.3;
  const LinearSystem system = system_of(network, {omega, {2.0}, {5.0, 0.7, 1.1}, {{Y, 0.0}, {0.2, 0.0}}});
  CHECK(system.M(0, 0) == 2.0 + 1.1);
  // f = k y + c y' + b y''
  const std::complex<double> expected = Y * std::complex<double>(5.0 - 1.1 * rate * rate, 0.7 * rate);
  CHECK(std::abs(system.force(0, 0) - expected) < 1e-14);
  CHECK(std::abs(system.constant_force[0] - 5.0 * 0.2) < 1e-15);
  CHECK_FALSE(system.odd_forcing);
}

TEST_CASE("Coulomb elements between the same two nodes are one contact, shared with their directions") {
  const Node ground{}, mass{NodeKind::mass, 0};
  const Network network{.masses = {"m"},
                        .elements = {{"k", ElementType::spring, ground, mass},
                                     {"f1", ElementType::coulomb, ground, mass},
                                     {"f2", ElementType::coulomb, mass, ground}}};
  const Assembly assembly(network);
  CHECK(assembly.contacts() == 1);
  CHECK(assembly.shares()[1].orientation == 1.0);
  CHECK(assembly.shares()[2].orientation == -1.0);
  CHECK(system_of(network, {1.0, {1.0}, {1.0, 0.25, 0.5}, {}}).limit[0] == 0.75);
}

TEST_CASE("Values out of range are refused by name, value and rule") {
  const Network network = periodic::rig();
  const NetworkValues good = periodic::rig_values(25.0, 6.36, 0.05);
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(refusal(network, good) == "accepted");

  NetworkValues bad = good;
  bad.mass[1] = -2.0;
  CHECK_THAT(refusal(network, bad),
             Contains("mass of 'tmd' = -2") && Contains("must be finite and not negative"));
  bad = good;
  bad.element[2] = -0.5;
  CHECK_THAT(refusal(network, bad),
             Contains("damping of 'guide_damper' = -0.5") && Contains("must not be negative"));
  bad = good;
  bad.element[6] = infinity;
  CHECK_THAT(refusal(network, bad), Contains("inertance of 'inerter' = inf") && Contains("must be finite"));
  bad = good;
  bad.element[7] = -1.0;
  CHECK_THAT(refusal(network, bad), Contains("force of 'tmd_friction' = -1"));
  bad = good;
  bad.element[0] = bad.element[1] = 0.0;
  CHECK_THAT(refusal(network, bad), Contains("stiffness matrix") && Contains("not positive definite"));
  bad = good;
  bad.mass[1] = bad.element[6] = 0.0;
  CHECK_THAT(refusal(network, bad), Contains("mass matrix") && Contains("not positive definite"));
  bad = good;
  bad.mass[1] = 1e-300;
  bad.element[6] = 0.0;
  CHECK(refusal(network, bad) == "the mass at 'tmd' = 1e-300: is lost in rounding next to 102.66 at 'main'");
  bad = good;
  bad.element[0] = 1e300;
  CHECK(refusal(network, bad) ==
        "the stiffness at 'tmd' = 10985.1: is lost in rounding next to 1e+300 at 'main'");
  for (const double omega : {0.0, -1.0, infinity, std::nan("")}) {
    bad = good;
    bad.omega = omega;
    CHECK_THAT(refusal(network, bad),
               Contains("angular frequency") && Contains("must be finite and positive"));
  }
  bad = good;
  bad.omega = 1e200;  // a number, unlike its square
  CHECK_THAT(refusal(network, bad), Contains("angular frequency = 1e+200: must be lower"));
  bad = good;
  bad.excitation[0].amplitude = std::nan("");
  CHECK_THAT(refusal(network, bad), Contains("amplitude") && Contains("must be finite"));
}

TEST_CASE(
    "A negative stiffness is allowed while the whole stays positive definite, a massless node with an "
    "inerter too") {
  const Network network = periodic::rig();
  NetworkValues values = periodic::rig_values(25.0, 6.36, 0.05);
  values.element[0] = -8000.0;
  CHECK(refusal(network, values) == "accepted");
  values.element[0] = -8181.0;
  CHECK_THAT(refusal(network, values), Contains("not positive definite"));
  values = periodic::rig_values(25.0, 6.36, 0.05);
  values.mass[1] = 0.0;
  CHECK(refusal(network, values) == "accepted");
}

TEST_CASE("An element that joins no moving node is refused") {
  Network network = periodic::rig();
  network.elements.push_back({"idle", ElementType::spring, Node{}, Node{NodeKind::prescribed, 0}});
  NetworkValues values = periodic::rig_values(25.0, 6.36, 0.05);
  values.element.push_back(1.0);
  CHECK_THAT(refusal(network, values), Contains("'idle' joins no moving node"));
}

}  // namespace
}  // namespace frahm::mechanics::assembly_test
