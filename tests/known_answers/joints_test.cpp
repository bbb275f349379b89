// Joints without mass: against Maxwell elements and springs in series, complex impedances, and drawn at
// random against an independent integration.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <random>

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/mechanics/modes.hpp"
#include "solvers/response/gradient_check.hpp"
#include "solvers/transient/forced_motion.hpp"
#include "solvers/transient/free_decay.hpp"
#include "tests/known_answers/exponential_integrator.hpp"
#include "tests/known_answers/responses.hpp"

namespace frahm::periodic::joints_test {
namespace {

using Catch::Matchers::WithinAbs, Catch::Matchers::WithinRel, Catch::Matchers::Contains;
using mechanics::Element, mechanics::ElementType, mechanics::ExcitationKind, mechanics::Network,
    mechanics::NetworkValues, mechanics::Node, mechanics::NodeKind;

constexpr double kExact = 1e-10;  // relative
constexpr Node kGround{}, kX{NodeKind::mass, 0}, kY{NodeKind::mass, 1}, kBase{NodeKind::prescribed, 0},
    kJ{NodeKind::joint, 0}, kI{NodeKind::joint, 1};

// A mass x on a spring and friction, and y on a spring to it, under forces of two orders and a moving base;
// between them and to the base what `branch` adds.
Network two_masses(std::vector<Element> branch) {
  Network network{.masses = {"x", "y"}, .prescribed = {"base"}};
  network.elements = {{"k", ElementType::spring, kGround, kX},
                      {"friction", ElementType::coulomb, kGround, kX},
                      {"ky", ElementType::spring, kX, kY},
                      {"cy", ElementType::damper, kX, kY}};
  network.elements.insert(network.elements.end(), branch.begin(), branch.end());
  network.excitations = {{ExcitationKind::force, 0, 1},
                         {ExcitationKind::force, 1, 2},
                         {ExcitationKind::motion, 0, 1},
                         {ExcitationKind::force, 0, 0}};
  return network;
}

NetworkValues values_of(const std::vector<double>& branch, const std::vector<double>& second,
                        double friction) {
  NetworkValues values{.omega = 1.3, .mass = {1.0, 0.4}, .element = {1.0, friction, 0.5, 0.03}};
  values.second = {0.0, 0.0, 0.0, 0.0};
  values.element.insert(values.element.end(), branch.begin(), branch.end());
  values.second.insert(values.second.end(), second.begin(), second.end());
  values.excitation = {{0.7, 0.2}, {0.3, -0.4}, {0.2, 0.9}, {0.1, 0.0}};
  return values;
}

// What both networks have is the same.
void check_the_same(const Responses& a, const Responses& b, double tolerance = kExact) {
  for (const Quantity& quantity : all_quantities(b.network())) {
    const auto [name, unit, meaning, kind, flags] = describe(quantity, b.network(), false);
    const bool of_computation = name == "residual" || name == "error_bound" || name == "newton_iterations" ||
                                name == "energy_balance" || name == "events";
    if (of_computation || !find_quantity(name, a.network())) continue;
    INFO(name);
    if (std::isnan(b[name])) {
      CHECK(std::isnan(a[name]));
    } else {
      CHECK_THAT(a[name], WithinRel(b[name], tolerance) || WithinAbs(b[name], 1e-12));
    }
  }
}

TEST_CASE("A spring and a damper that meet at a joint are a Maxwell element") {
  for (const double friction : {0.0, 0.25, 0.6}) {
    Network joint = two_masses({{"kj", ElementType::spring, kY, kJ}, {"cj", ElementType::damper, kBase, kJ}});
    joint.joints = {"j"};
    const Network maxwell = two_masses({{"m", ElementType::maxwell, kBase, kY}});
    Responses a(joint), b(maxwell);
    INFO("friction " << friction);
    CHECK(a.solve(values_of({0.8, 0.35}, {0.0, 0.0}, friction)).status == Status::ok);
    CHECK(b.solve(values_of({0.8}, {0.35}, friction)).status == Status::ok);
    check_the_same(a, b);
    CHECK_THAT(a["cj_energy"], WithinRel(b["m_energy"], kExact));
    CHECK_THAT(a["kj_force_peak"], WithinRel(b["m_force_peak"], kExact));
    CHECK_THAT(a["cj_force_peak"], WithinRel(b["m_force_peak"], kExact));
    CHECK_THAT(a["kj_stroke"], WithinRel(b["m_force_peak"] / 0.8, kExact));
    CHECK_THAT(a["error_bound"], WithinAbs(0.0, 1e-11));
    CHECK(a["energy_balance"] < 1e-12);
  }
}

TEST_CASE("Springs that meet at a joint are one of k1 k2/(k1 + k2), and the joint lies between their ends") {
  Network joint = two_masses({{"k1", ElementType::spring, kBase, kJ}, {"k2", ElementType::spring, kJ, kY}});
  joint.joints = {"j"};
  joint.signals = {{"share", {{kBase, -0.4}, {kY, -0.6}, {kJ, 1.0}}}};
  const Network one = two_masses({{"m", ElementType::spring, kBase, kY}});
  Responses a(joint), b(one);
  CHECK(a.solve(values_of({0.6, 0.9}, {0.0, 0.0}, 0.25)).status == Status::ok);
  CHECK(b.solve(values_of({0.36}, {0.0}, 0.25)).status == Status::ok);
  check_the_same(a, b);
  CHECK_THAT(a["k1_force_peak"], WithinRel(b["m_force_peak"], kExact));
  CHECK(a["share_peak"] < 1e-14);
}

// The whole network as one complex matrix over masses and joints.
Eigen::VectorXcd impedances(const Network& network, const NetworkValues& values) {
  const auto n = static_cast<Eigen::Index>(network.masses.size());
  const auto all = n + static_cast<Eigen::Index>(network.joints.size());
  const std::complex<double> i_omega(0.0, values.omega);
  Eigen::MatrixXcd Z = Eigen::MatrixXcd::Zero(all, all);
  Eigen::VectorXcd f = Eigen::VectorXcd::Zero(all);
  for (Eigen::Index i = 0; i < n; ++i) Z(i, i) = i_omega * i_omega * values.mass[static_cast<std::size_t>(i)];
  Eigen::VectorXcd y = Eigen::VectorXcd::Zero(1);
  for (std::size_t k = 0; k < network.excitations.size(); ++k) {
    const auto [amplitude, phase, rod] = values.excitation[k];
    const auto node = static_cast<Eigen::Index>(network.excitations[k].node);
    (network.excitations[k].kind == ExcitationKind::force ? f[node] : y[node]) +=
        std::polar(amplitude, phase);
  }
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    const double value = values.element[e];
    const ElementType type = network.elements[e].type;
    const std::complex<double> z = type == ElementType::spring   ? value
                                   : type == ElementType::damper ? i_omega * value
                                                                 : i_omega * i_omega * value;
    Eigen::VectorXcd w = Eigen::VectorXcd::Zero(all);
    std::complex<double> of_base = 0.0;
    for (const auto& [node, factor] : network.elements[e].along) {
      if (node.kind == NodeKind::mass) w[static_cast<Eigen::Index>(node.index)] += factor;
      if (node.kind == NodeKind::joint) w[n + static_cast<Eigen::Index>(node.index)] += factor;
      if (node.kind == NodeKind::prescribed) of_base += factor * y[0];
    }
    Z += z * w * w.transpose();
    f -= z * of_base * w;
  }
  return Z.partialPivLu().solve(f);
}

void check_impedances(const Network& network, const NetworkValues& values) {
  Responses response(network);
  CHECK(response.solve(values).status == Status::ok);
  const Eigen::VectorXcd X = impedances(network, values);
  for (Eigen::Index i = 0; i < X.size(); ++i) {
    const auto at = static_cast<std::size_t>(i), n = network.masses.size();
    const std::string& name = at < n ? network.masses[at] : network.joints[at - n];
    INFO(name);
    CHECK_THAT(response[name + "_peak"], WithinRel(std::abs(X[i]), kExact));
    CHECK_THAT(response[name + "_harmonic"], WithinRel(std::abs(X[i]), kExact));
    CHECK_THAT(response[name + "_velocity_peak"], WithinRel(values.omega * std::abs(X[i]), kExact));
    CHECK_THAT(response[name + "_acceleration_peak"],
               WithinRel(values.omega * values.omega * std::abs(X[i]), kExact));
    CHECK_THAT(response[name + "_rms"], WithinRel(std::abs(X[i]) / std::sqrt(2.0), kExact));
  }
  CHECK(response["energy_balance"] < 1e-11);
}

// Springs and dampers at every joint that are drawn, joints to joints too; with `loads` forces on joints.
struct Drawn {
  Network network;
  NetworkValues values;
};
Drawn drawn_network(std::mt19937& random, bool every_joint_damped, bool loads) {
  std::uniform_real_distribution<double> uniform(0.2, 1.5);
  Drawn drawn;
  Network& network = drawn.network;
  NetworkValues& values = drawn.values;
  network.masses = {"a", "b", "c"};
  network.prescribed = {"base"};
  network.joints = {"p", "q", "r"};
  values.omega = uniform(random);
  const auto add = [&](const char* name, ElementType type, Node from, Node to) {
    network.elements.push_back({name + std::to_string(network.elements.size()), type, from, to});
    values.element.push_back(type == ElementType::damper ? 0.3 * uniform(random) : uniform(random));
    values.second.push_back(0.0);
  };
  const auto mass = [](std::size_t i) { return Node{NodeKind::mass, i}; };
  const auto joint = [](std::size_t i) { return Node{NodeKind::joint, i}; };
  for (std::size_t i = 0; i < 3; ++i) {
    values.mass.push_back(uniform(random));
    add("k", ElementType::spring, i == 0 ? kGround : mass(i - 1), mass(i));
    add("c", ElementType::damper, i == 0 ? kGround : mass(i - 1), mass(i));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    add("k", ElementType::spring, mass(i), joint(i));
    add("k", ElementType::spring, joint(i), joint((i + 1) % 3));
    if (every_joint_damped || i == 1)
      add("c", ElementType::damper, i == 1 ? kBase : mass((i + 1) % 3), joint(i));
    if (every_joint_damped) add("c", ElementType::damper, joint(i), joint((i + 1) % 3));
  }
  add("k", ElementType::spring, kBase, joint(2));
  network.excitations = {{ExcitationKind::force, 0, 1}, {ExcitationKind::motion, 0, 1}};
  values.excitation = {{uniform(random), uniform(random)}, {0.3 * uniform(random), uniform(random)}};
  for (std::size_t i = 0; loads && i < 3; ++i) {
    network.excitations.push_back({ExcitationKind::force, 3 + i, 1});
    values.excitation.push_back({uniform(random), 3.0 * uniform(random)});
  }
  return drawn;
}

TEST_CASE("Networks of springs, dampers and joints respond as their complex impedances say") {
  std::mt19937 random(20261130);
  for (int trial = 0; trial < 20; ++trial) {
    for (const bool every_joint_damped : {false, true}) {
      for (const bool loads : {false, true}) {
        const Drawn drawn = drawn_network(random, every_joint_damped, loads);
        INFO("trial " << trial << ", damped " << every_joint_damped << ", loads " << loads);
        check_impedances(drawn.network, drawn.values);
      }
    }
  }
}

TEST_CASE("A spring, a damper and an inerter in series respond as their impedances say") {
  Network network{.masses = {"x", "j"}, .joints = {"i"}};
  const Node j{NodeKind::mass, 1}, i{NodeKind::joint, 0};
  network.elements = {{"k", ElementType::spring, kGround, kX},
                      {"k1", ElementType::spring, kX, i},
                      {"c", ElementType::damper, i, j},
                      {"b", ElementType::inerter, j, kGround},
                      {"k0", ElementType::spring, j, kGround}};
  network.excitations = {{ExcitationKind::force, 0, 1}};
  check_impedances(
      network,
      {.omega = 1.1, .mass = {1.0, 0.0}, .element = {1.0, 0.4, 0.2, 0.7, 0.1}, .excitation = {{1.0, 0.3}}});
}

// Each number of the network as a parameter of its own.
std::vector<CheckedParameter> every_parameter(const NetworkValues& values) {
  std::vector<CheckedParameter> parameters;
  NetworkValues none = values;
  none.omega = 0.0;
  std::ranges::fill(none.mass, 0.0);
  std::ranges::fill(none.element, 0.0);
  std::ranges::fill(none.second, 0.0);
  for (auto& each : none.excitation) each = {};
  const auto add = [&](double value, const auto& entry) {
    CheckedParameter parameter{.value = value, .direction = none};
    entry(parameter.direction) = 1.0;
    parameter.values_at = [values, entry](double to) {
      NetworkValues at = values;
      entry(at) = to;
      return at;
    };
    parameters.push_back(std::move(parameter));
  };
  add(values.omega, [](NetworkValues& of) -> double& { return of.omega; });
  for (std::size_t i = 0; i < values.mass.size(); ++i)
    add(values.mass[i], [i](NetworkValues& of) -> double& { return of.mass[i]; });
  for (std::size_t e = 0; e < values.element.size(); ++e)
    if (values.element[e] > 0.0)
      add(values.element[e], [e](NetworkValues& of) -> double& { return of.element[e]; });
  for (std::size_t k = 0; k < values.excitation.size(); ++k) {
    add(values.excitation[k].amplitude,
        [k](NetworkValues& of) -> double& { return of.excitation[k].amplitude; });
    add(values.excitation[k].phase, [k](NetworkValues& of) -> double& { return of.excitation[k].phase; });
  }
  return parameters;
}

TEST_CASE("Derivatives of networks with joints agree with differences") {
  constexpr double kDifference = 1e-6, kSmall = 1e-3;
  std::mt19937 random(7);
  int compared = 0;
  for (int trial = 0; trial < 4; ++trial) {
    Drawn drawn = drawn_network(random, trial % 2 == 0, trial < 2);
    drawn.network.elements.push_back({"friction", ElementType::coulomb, kGround, kX});
    drawn.values.element.push_back(0.2);
    drawn.values.second.push_back(0.0);
    const std::vector<Quantity> quantities = all_quantities(drawn.network);
    Responses response(drawn.network);
    response.solve(drawn.values);
    const GradientCheck check =
        check_gradient(drawn.network, quantities, drawn.values, every_parameter(drawn.values));
    REQUIRE(check.reason.empty());
    const std::vector<CheckedParameter> parameters = every_parameter(drawn.values);
    for (std::size_t d = 0; d < parameters.size(); ++d) {
      for (std::size_t q = 0; q < quantities.size(); ++q) {
        const DerivativeCheck& by = check.columns[d][q];
        if (!by.why_none.empty() || std::isnan(by.difference)) continue;
        const std::string name = describe(quantities[q], drawn.network, false).name;
        const double own = std::abs(response[name]);
        if (own < 1e-12) continue;
        const double size = std::max({std::abs(by.exact), std::abs(by.difference),
                                      kSmall * own / std::max(std::abs(parameters[d].value), 1e-3)});
        INFO("trial " << trial << ": " << name << " by parameter " << d << ": " << by.exact << ", difference "
                      << by.difference << " +- " << by.uncertainty);
        CHECK(std::abs(by.exact - by.difference) < kDifference * size + 10.0 * by.uncertainty);
        ++compared;
      }
    }
  }
  CHECK(compared > 3000);
}

// The independent integration has the joints' displacements as states: C_J x' = the rest of their balance.
TEST_CASE("Random networks with joints and friction are periodic as the independent integration says") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0.05, 0.6);
  for (int trial = 0; trial < 20; ++trial) {
    Drawn drawn = drawn_network(random, true, trial % 2 == 0);
    for (const auto& [name, from, to] : {std::tuple("f1", kGround, kX), std::tuple("f2", kX, kY)}) {
      drawn.network.elements.push_back({name, ElementType::coulomb, from, to});
      drawn.values.element.push_back(uniform(random));
      drawn.values.second.push_back(0.0);
    }
    Responses response(drawn.network);
    INFO("trial " << trial);
    REQUIRE(response.solve(drawn.values).status == Status::ok);
    const std::vector<double> phases{0.0};
    const History history = response.response().history(phases);
    const auto column = [&](const std::string& name) {
      return history.columns[static_cast<std::size_t>(std::ranges::find(history.names, name) -
                                                      history.names.begin())][0];
    };
    Eigen::VectorXd q(3), v(3), x(3);
    for (Eigen::Index i = 0; i < 3; ++i) {
      const auto at = static_cast<std::size_t>(i);
      q[i] = column(drawn.network.masses[at] + "_displacement");
      v[i] = column(drawn.network.masses[at] + "_velocity");
      x[i] = column(drawn.network.joints[at] + "_displacement");
    }
    ExponentialIntegrator integrator(drawn.network, drawn.values);
    integrator.start(q, v, x);
    integrator.pass_period();
    Eigen::VectorXd start(9);
    start << q, v, x;
    CHECK((integrator.state() - start).norm() < 1e-8 * start.norm());
    for (Eigen::Index i = 0; i < 3; ++i)
      CHECK_THAT(integrator.amplitude(i),
                 WithinAbs(response[drawn.network.masses[static_cast<std::size_t>(i)] + "_amplitude"],
                           1e-8 * start.norm()));
  }
}

TEST_CASE("A decay with a joint is that with a Maxwell element, its energies too") {
  for (const double friction : {0.0, 0.02}) {
    Network joint{.masses = {"x"}, .joints = {"j"}};
    joint.elements = {{"k", ElementType::spring, kGround, kX},
                      {"friction", ElementType::coulomb, kGround, kX},
                      {"k1", ElementType::spring, kX, kJ},
                      {"c1", ElementType::damper, kGround, kJ}};
    Network maxwell{.masses = {"x"}};
    maxwell.elements = {joint.elements[0], joint.elements[1], {"m", ElementType::maxwell, kGround, kX}};
    const transient::DecayOptions options{.duration = 20.0, .samples = 41};
    const auto a = transient::free_decay(joint, {.mass = {1.0}, .element = {1.0, friction, 0.7, 0.4}},
                                         {{0.5}, {0.2}}, options);
    const auto b = transient::free_decay(
        maxwell, {.mass = {1.0}, .element = {1.0, friction, 0.7}, .second = {0.0, 0.0, 0.4}}, {{0.5}, {0.2}},
        options);
    REQUIRE(a.reason.empty());
    CHECK(a.end == b.end);
    CHECK(a.energy.balance < 1e-12);
    CHECK_THAT(a.energy.initial, WithinRel(b.energy.initial, kExact));
    CHECK_THAT(a.energy.dissipated[3], WithinRel(b.energy.dissipated[2], kExact));
    CHECK_THAT(a.masses[0].rest, WithinAbs(b.masses[0].rest, 1e-12));
    CHECK_THAT(a.masses[1].rest, WithinAbs(a.masses[0].rest, 1e-12));
    REQUIRE(a.masses[0].extrema.size() == b.masses[0].extrema.size());
    for (std::size_t i = 0; i < a.history.time.size(); ++i) {
      CHECK_THAT(a.history.displacement[0][i], WithinAbs(b.history.displacement[0][i], 1e-12));
      // c x_j' = k1 (x - x_j)
      CHECK_THAT(0.4 * a.history.velocity[1][i],
                 WithinAbs(0.7 * (a.history.displacement[0][i] - a.history.displacement[1][i]), 1e-12));
    }
  }
}

// x - joint - ground with dampers and a spring at the joint; the mass drifts while only the joint is held.
TEST_CASE("A force on a joint and a free mass: a motion from rest in closed form") {
  Network network{.masses = {"x"}, .joints = {"j"}};
  network.elements = {{"k1", ElementType::spring, kX, kJ}};
  network.excitations = {{ExcitationKind::force, 1, 0}};
  const double P = 3.0, m = 2.0, t = 1.7;
  const auto motion = transient::forced_motion(
      network,
      [&](double omega) {
        return NetworkValues{.omega = omega, .mass = {m}, .element = {5.0}, .excitation = {{P, 0.0}}};
      },
      {}, {.from = 1.0, .duration = t, .samples = 2});
  REQUIRE(motion.failure.empty());
  CHECK_THAT(motion.history.displacement[0].back(), WithinRel(0.5 * P / m * t * t, kExact));
  CHECK_THAT(motion.history.displacement[1].back(), WithinRel(0.5 * P / m * t * t + P / 5.0, kExact));
  CHECK(motion.energy.balance < 1e-12);
}

TEST_CASE("A joint adds no mode, and its damper damps the others as a Maxwell element does") {
  Network joint{.masses = {"x"}, .joints = {"j"}};
  joint.elements = {{"k", ElementType::spring, kGround, kX},
                    {"k1", ElementType::spring, kX, kJ},
                    {"c1", ElementType::damper, kGround, kJ}};
  Network maxwell{.masses = {"x"}};
  maxwell.elements = {joint.elements[0], {"m", ElementType::maxwell, kGround, kX}};
  const auto a =
      linear_modes(joint, {.mass = {2.0}, .element = {8.0, 3.0, 0.4}}, false, mechanics::FreeMasses::refused);
  const auto b = linear_modes(maxwell, {.mass = {2.0}, .element = {8.0, 3.0}, .second = {0.0, 0.4}}, false,
                              mechanics::FreeMasses::refused);
  REQUIRE(a.frequency.size() == 1);
  CHECK_THAT(a.frequency[0], WithinRel(2.0, 1e-13));
  CHECK_THAT(a.damping[0], WithinRel(b.damping[0], 1e-13));
}

TEST_CASE("What a joint cannot have is refused by name") {
  const auto refusal = [](const std::vector<Element>& branch, const std::vector<double>& values) {
    Network network = two_masses(branch);
    network.joints = {"j"};
    mechanics::LinearSystem system;
    try {
      mechanics::Assembly(network).set_values(values_of(values, std::vector<double>(values.size(), 0.1), 0.1),
                                              system);
    } catch (const mechanics::MechanicsError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const Element spring{"k1", ElementType::spring, kY, kJ};
  CHECK_THAT(refusal({{"c1", ElementType::damper, kY, kJ}}, {1.0}),
             Contains("joint 'j'") && Contains("no spring holds it"));
  CHECK_THAT(refusal({spring, {"c1", ElementType::damper, kY, kJ}}, {1.0, 0.0}),
             Contains("joint 'j'") && Contains("damping of its dampers is 0"));
  CHECK_THAT(refusal({spring, {"f", ElementType::coulomb, kGround, kJ}}, {1.0, 1.0}),
             Contains("element 'f'") && Contains("jenkins"));
  CHECK_THAT(refusal({spring, {"m", ElementType::maxwell, kGround, kJ}}, {1.0, 1.0}),
             Contains("element 'm'") && Contains("another joint"));
  CHECK_THAT(refusal({spring, {"b", ElementType::inerter, kGround, kJ}}, {1.0, 1.0}),
             Contains("element 'b'") && Contains("mass of zero"));
  CHECK(refusal({spring}, {1.0}).empty());
}

}  // namespace
}  // namespace frahm::periodic::joints_test
