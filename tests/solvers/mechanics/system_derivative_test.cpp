#include "solvers/mechanics/system_derivative.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "solvers/mechanics/crank.hpp"
#include "tests/known_answers/random_network.hpp"
#include "tests/solvers/gradient_parameters.hpp"

namespace frahm::mechanics::system_derivative_test {
namespace {

using periodic::all_parameters;
using periodic::NamedParameter;
using periodic::random_network;

// Of fourth-order differences with steps of 1e-3, relative to the largest entry: their rounding.
constexpr double kDifference = 1e-10;

LinearSystem system_of(const Assembly& assembly, const NetworkValues& values) {
  LinearSystem system;
  assembly.set_values(values, system);
  assembly.set_forcing(values, system);
  return system;
}

// Everything in a LinearSystem that a value can change, in one column.
std::vector<double> numbers_of(const LinearSystem& system) {
  std::vector<double> all = {system.omega};
  const auto add = [&](const auto& matrix) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j)
      for (Eigen::Index i = 0; i < matrix.rows(); ++i) all.push_back(matrix(i, j));
  };
  const auto add_both = [&](const Eigen::MatrixXcd& matrix) {
    add(matrix.real());
    add(matrix.imag());
  };
  for (const auto* matrix : {&system.M, &system.C, &system.K, &system.M_support, &system.C_support,
                             &system.K_support, &system.mass, &system.structural_damping})
    add(*matrix);
  for (const auto* vector : {&system.limit, &system.internal_stiffness, &system.internal_rate,
                             &system.constant_force, &system.constant_applied_force, &system.constant_motion})
    add(*vector);
  for (const auto* matrix : {&system.force, &system.applied_force, &system.motion}) add_both(*matrix);
  for (const ElementCoefficients& law : system.coefficients) {
    for (const double number :
         {law.stiffness, law.damping, law.inertance, law.friction, law.internal_damping})
      all.push_back(number);
  }
  return all;
}

void check_derivatives(const Network& network, const NetworkValues& values) {
  const Assembly assembly(network);
  const LinearSystem system = system_of(assembly, values);
  for (const NamedParameter& named : all_parameters(network, values)) {
    LinearSystem derivative;
    differentiate(assembly, values, named.parameter.direction, system, derivative);
    const std::vector<double> exact = numbers_of(derivative);
    const double at = named.parameter.value, step = 1e-3 * std::abs(at);
    const auto numbers_at = [&](double steps) {
      return numbers_of(system_of(assembly, named.parameter.values_at(at + steps * step)));
    };
    const auto a = numbers_at(-2.0), b = numbers_at(-1.0), c = numbers_at(1.0), d = numbers_at(2.0);
    const auto own = numbers_of(system);
    REQUIRE(exact.size() == a.size());
    double largest = 0.0;
    for (const double number : own) largest = std::max(largest, std::abs(number / at));
    INFO(named.name);
    for (std::size_t i = 0; i < exact.size(); ++i) {
      const double difference = (a[i] - 8.0 * b[i] + 8.0 * c[i] - d[i]) / (12.0 * step);
      CHECK(std::abs(exact[i] - difference) <= kDifference * std::max(std::abs(difference), largest));
    }
  }
}

TEST_CASE("The derivative of an assembled system is that of its differences, for every number of a network") {
  for (unsigned trial = 0; trial < 12; ++trial) {
    std::mt19937 random(300U + trial);
    const auto drawn = random_network({.masses = 1 + static_cast<int>(trial % 3),
                                       .contacts = 2,
                                       .maxwell_elements = static_cast<int>(trial % 2),
                                       .hysteretic = trial % 4 > 1,
                                       .orders = {0, 1, 2},
                                       .shaken = trial % 3 > 0},
                                      random);
    INFO("trial " << trial);
    check_derivatives(drawn.network, drawn.values);
  }
}

TEST_CASE(
    "So is that of a system with damping of its structure, modal or rayleigh, with a moving base or not") {
  for (unsigned trial = 0; trial < 12; ++trial) {
    std::mt19937 random(700U + trial);
    auto drawn = random_network({.masses = 2 + static_cast<int>(trial % 3),
                                 .contacts = 1,
                                 .maxwell_elements = static_cast<int>(trial % 2),
                                 .hysteretic = trial % 4 > 1,
                                 .orders = {0, 1},
                                 .shaken = trial % 3 > 0},
                                random);
    drawn.network.damping = trial % 4 == 0 ? DampingModel::rayleigh : DampingModel::modal;
    drawn.values.damping = {0.03, 0.05};
    if (trial % 4 == 1) drawn.values.damping = {0.04};
    INFO("trial " << trial);
    check_derivatives(drawn.network, drawn.values);
  }
}

TEST_CASE("Modes of one frequency and one ratio have a derivative of their damping") {
  // Two equal oscillators and a spring between them that grows from nothing: dC_d is that of the sum
  // M sqrt(M^-1 K) of both, exact where divided differences would be 0/0.
  const Node ground{}, a{NodeKind::mass, 0}, b{NodeKind::mass, 1};
  const Network network{.masses = {"a", "b"},
                        .elements = {{"ka", ElementType::spring, ground, a},
                                     {"kb", ElementType::spring, ground, b},
                                     {"joint", ElementType::spring, a, b}},
                        .excitations = {{ExcitationKind::force, 0, 1}},
                        .damping = DampingModel::modal};
  const NetworkValues values{.omega = 1.0,
                             .mass = {1.0, 1.0},
                             .element = {4.0, 4.0, 0.0},
                             .excitation = {{1.0, 0.0}},
                             .damping = {0.05}};
  const Assembly assembly(network);
  NetworkValues direction = periodic::zero_direction(values);
  direction.element[2] = 1.0;
  LinearSystem derivative;
  differentiate(assembly, values, direction, system_of(assembly, values), derivative);
  // The modes are (1, 1) at 2 rad/s, and (1, -1) at sqrt(4 + 2 k): 2 zeta omega changes by 2 zeta / omega.
  CHECK(derivative.C(0, 0) == Approx(0.05 / 2.0).epsilon(1e-13));
  CHECK(derivative.C(0, 1) == Approx(-0.05 / 2.0).epsilon(1e-13));
}

TEST_CASE("So is that of a system shaken by a crank, exact or cut") {
  for (const int taylor_order : {0, 1, 2, 4}) {
    Network network{
        .masses = {"m"},
        .prescribed = {"slider"},
        .elements = {{"spring", ElementType::spring, Node{NodeKind::prescribed, 0}, Node{NodeKind::mass, 0}},
                     {"damper", ElementType::damper, Node{NodeKind::prescribed, 0}, Node{NodeKind::mass, 0}}},
        .excitations = {{ExcitationKind::crank, 0, 1, 12, taylor_order}}};
    const NetworkValues values{.omega = 2.0,
                               .mass = {1.0},
                               .element = {3.0, 0.2},
                               .excitation = {{.amplitude = 0.1, .phase = 0.3, .rod = 0.4}}};
    INFO("taylor_order " << taylor_order);
    check_derivatives(network, values);
  }
}

TEST_CASE("A hysteretic element whose frequency is given has a derivative by it, and none by omega") {
  const Network network{.masses = {"m"},
                        .elements = {{"rubber", ElementType::hysteretic, Node{}, Node{NodeKind::mass, 0}}},
                        .excitations = {{ExcitationKind::force, 0, 1}}};
  NetworkValues values{
      .omega = 2.0, .mass = {1.0}, .element = {3.0}, .excitation = {{1.0, 0.0}}, .second = {0.1}};
  values.hysteretic_omega = 5.0;
  const Assembly assembly(network);
  const LinearSystem system = system_of(assembly, values);
  NetworkValues direction = periodic::zero_direction(values);
  direction.omega = 1.0;
  LinearSystem derivative;
  differentiate(assembly, values, direction, system, derivative);
  CHECK(derivative.C(0, 0) == 0.0);
  direction.hysteretic_omega = 1.0;
  differentiate(assembly, values, direction, system, derivative);
  // c = eta k / omega_h:  dc = -eta k / omega_h^2
  CHECK(derivative.C(0, 0) == Approx(-0.1 * 3.0 / 25.0).epsilon(1e-14));
}

}  // namespace
}  // namespace frahm::mechanics::system_derivative_test
