#include <Eigen/Cholesky>
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <string>
#include <vector>

#include "solvers/events/box_minimum.hpp"
#include "tests/known_answers/responses.hpp"

// Contacts that form a loop: two masses held to the ground and to each other. What each carries is a
// convention, the least sum of (lambda / F)^2 within the limits, of which the answers here follow by hand.
namespace frahm::periodic::loops_test {
namespace {

using namespace mechanics;
using Catch::Matchers::WithinAbs;
constexpr double kRounding = 1e-12;  // of forces of order 1

constexpr Node kGround{NodeKind::ground, 0}, kDriven{NodeKind::mass, 0}, kBeside{NodeKind::mass, 1};
constexpr double kLower = 2.0, kJoint = 0.3, kUpper = 0.4;

// The driven mass is held to the ground by one contact, and by two in series through the mass next to it.
Network clamp() {
  return {.masses = {"driven", "beside"},
          .elements = {{"spring", ElementType::spring, kGround, kDriven},
                       {"link", ElementType::spring, kDriven, kBeside},
                       {"damper", ElementType::damper, kGround, kDriven},
                       {"lower", ElementType::coulomb, kGround, kDriven},
                       {"joint", ElementType::coulomb, kDriven, kBeside},
                       {"upper", ElementType::coulomb, kGround, kBeside}},
          .excitations = {{ExcitationKind::force, 0, 1}}};
}

NetworkValues values(double force, double phase) {
  return {.omega = 0.8,
          .mass = {1.0, 0.7},
          .element = {1.0, 2.0, 0.1, kLower, kJoint, kUpper},
          .excitation = {{force, phase}}};
}

TEST_CASE("Contacts in a loop share a force by the least sum, and within their limits, at any phase origin") {
  // For a force N the two in series take the part that makes their sum and the other's least.
  const double in_series = 1.0 / (1.0 / (kJoint * kJoint) + 1.0 / (kUpper * kUpper));
  const double part = in_series / (in_series + kLower * kLower);
  Responses responses(clamp());
  for (const double force : {1.5, 2.2}) {
    for (int i = 0; i < 24; ++i) {
      const double phase = i * 0.27;
      INFO("force " << force << " at phase " << phase);
      responses.solve(values(force, phase));
      CHECK(responses["status"] == 1.0);
      const double through_joint = force * (1.0 - part) < kLower ? force * part : force - kLower;
      CHECK_THAT(responses["joint_force_peak"], WithinAbs(through_joint, kRounding));
      CHECK_THAT(responses["upper_force_peak"], WithinAbs(through_joint, kRounding));
      CHECK_THAT(responses["lower_force_peak"], WithinAbs(force - through_joint, kRounding));
      for (const char* contact : {"lower", "joint", "upper"}) {
        CHECK(responses[std::string(contact) + "_stuck_fraction"] == 1.0);
        CHECK(responses[std::string(contact) + "_stops"] == 0.0);
      }
    }
  }
}

TEST_CASE("The peak of a share has the derivative of its closed form") {
  Responses responses(clamp());
  responses.solve(values(2.2, 0.4));
  const auto quantities = all_quantities(clamp());
  NetworkValues by_force{
      .mass = {0.0, 0.0}, .element = std::vector<double>(6, 0.0), .excitation = {{1.0, 0.0}}};
  NetworkValues by_limit = by_force;
  by_limit.excitation[0].amplitude = 0.0;
  by_limit.element[3] = 1.0;
  std::vector<double> out(2 * quantities.size());
  REQUIRE(responses.response().gradient(std::vector{by_force, by_limit}, out) == "");
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    if (quantities[i] != *find_quantity("joint_force_peak", clamp())) continue;
    CHECK_THAT(out[i], WithinAbs(1.0, kRounding));
    CHECK_THAT(out[quantities.size() + i], WithinAbs(-1.0, kRounding));
  }
}

// Both masses stick in a loop under a force of mean F_0 and amplitude F_1. With x the place of the driven
// mass, d its distance from the other, springs k and k_l, and limits F of the three contacts,
//   |F_0 + F_1 cos(w t) - k x - k_l d| <= F_lower + F_joint
// is all that bounds them; the least energy is where d = x = (F_0 + F_1 - F_lower - F_joint) / (k + k_l).
TEST_CASE("Masses held in a loop under a constant load rest where the springs are strained least") {
  constexpr double mean = 1.0, swing = 1.9, lower = 1.6, joint = 0.52, upper = 1.5, k = 1.0, link = 7.8;
  Network network = clamp();
  network.elements.erase(network.elements.begin() + 2);
  network.excitations.push_back({ExcitationKind::force, 0, 0});
  Responses responses(network);
  for (const double omega : {0.056, 0.8}) {
    for (double phase = 0.0; phase < 6.3; phase += 0.27) {
      INFO("omega " << omega << " phase " << phase);
      responses.solve({.omega = omega,
                       .mass = {1.0, 1.0},
                       .element = {k, link, lower, joint, upper},
                       .excitation = {{swing, phase}, {mean, 0.0}}});
      CHECK(responses["status"] == 2.0);
      constexpr double kInside = 2e-10;  // a rest position at a limit is reported inside it by 5e-10 of it
      CHECK_THAT(responses["driven_mean"], WithinAbs((mean + swing - lower - joint) / (k + link), kInside));
      CHECK_THAT(responses["beside_mean"], WithinAbs(0.0, kInside));
      CHECK(responses["driven_amplitude"] == 0.0);
      CHECK(responses["lower_force_peak"] <= lower + kRounding);
      CHECK(responses["joint_force_peak"] <= joint + kRounding);
      CHECK(responses["upper_force_peak"] <= upper + kRounding);
    }
  }
}

// Three masses, each tied to the ground and to the others by a spring and friction. The force on the first
// drags it through the limits of its three contacts, which are reached at one instant; the others stay. So it
// moves as a mass alone on its springs and frictions together, loaded by the others' springs too.
TEST_CASE("Contacts of a loop whose limits are reached together let go together") {
  struct Joint {
    Node from, to;
    double stiffness, friction;
  };
  const auto mass = [](std::size_t i) { return Node{NodeKind::mass, i}; };
  const Joint joints[] = {{kGround, mass(0), 0.215, 0.460}, {kGround, mass(1), 0.574, 0.954},
                          {mass(0), mass(1), 0.752, 0.339}, {kGround, mass(2), 0.416, 0.999},
                          {mass(0), mass(2), 0.589, 0.521}, {mass(1), mass(2), 0.915, 0.864}};
  constexpr double mean = 1.620, swing = 1.478, omega = 0.3, phase = 4.53;
  Network network;
  network.masses = {"driven", "second", "third"};
  network.excitations = {{ExcitationKind::force, 0, 1}, {ExcitationKind::force, 0, 0}};
  NetworkValues values{
      .omega = omega, .mass = {1.0, 1.0, 1.0}, .element = {}, .excitation = {{swing, phase}, {mean, 0.0}}};
  double stiffness = 0.0, friction = 0.0;
  for (const Joint& joint : joints) {
    const std::string name = "joint" + std::to_string(values.element.size() / 2);
    network.elements.push_back({name + "_spring", ElementType::spring, joint.from, joint.to});
    network.elements.push_back({name, ElementType::coulomb, joint.from, joint.to});
    values.element.insert(values.element.end(), {joint.stiffness, joint.friction});
    if (joint.to.index != 0 && (joint.from.kind != NodeKind::mass || joint.from.index != 0)) continue;
    stiffness += joint.stiffness;
    friction += joint.friction;
  }
  Responses responses(network);
  const auto summary = responses.solve(values);
  INFO(summary.reason);
  REQUIRE(has_response(summary.status));
  CHECK(responses["second_amplitude"] == 0.0);
  CHECK(responses["third_amplitude"] == 0.0);
  const double pull =
      joints[2].stiffness * responses["second_mean"] + joints[4].stiffness * responses["third_mean"];

  Network alone;
  alone.masses = {"driven"};
  alone.elements = {{"spring", ElementType::spring, kGround, mass(0)},
                    {"guide", ElementType::coulomb, kGround, mass(0)}};
  alone.excitations = network.excitations;
  Responses of_one(alone);
  of_one.solve({.omega = omega,
                .mass = {1.0},
                .element = {stiffness, friction},
                .excitation = {{swing, phase}, {mean + pull, 0.0}}});
  CHECK(of_one["guide_stops"] > 0.0);
  CHECK_THAT(responses["driven_amplitude"], WithinAbs(of_one["driven_amplitude"], kRounding));
  CHECK_THAT(responses["driven_peak"], WithinAbs(of_one["driven_peak"], kRounding));
}

// Three masses, each tied to the ground and to the others by a spring and friction; four of the six contacts
// hold more at rest. All that one choice sets sliding is held by the rest, and so rests: the choice was made
// again for ever. The six carry the largest load, 3.307, all within what they hold.
TEST_CASE("Contacts of a loop that are to slide, and are held by the others, rest") {
  struct Joint {
    Node from, to;
    double stiffness, friction, at_rest;
  };
  const auto mass = [](std::size_t i) { return Node{NodeKind::mass, i}; };
  const Joint joints[] = {{kGround, mass(0), 0.6167587256175271, 0.5370001608091786, 0.6069911958318489},
                          {kGround, mass(1), 0.5871662147462637, 0.7008711730441279, 0.7008711730441279},
                          {mass(0), mass(1), 0.7658220767727153, 0.5483167201883866, 0.6719537548730745},
                          {kGround, mass(2), 0.8308384361287993, 0.5368711234800521, 0.5368711234800521},
                          {mass(0), mass(2), 0.7411234088516734, 0.8054660653056613, 1.1809979713928633},
                          {mass(1), mass(2), 0.7221268640879392, 0.9478658834055762, 1.8013975138935119}};
  Network network;
  network.masses = {"first", "second", "third"};
  network.excitations = {{ExcitationKind::force, 0, 1}, {ExcitationKind::force, 0, 0}};
  NetworkValues values{.omega = 0.3,
                       .mass = {1.0, 1.0, 1.0},
                       .element = {},
                       .excitation = {{1.3186075135078057, 3.7175268151048755}, {1.9887514052594406, 0.0}}};
  std::vector<std::string> names;
  for (const Joint& joint : joints) {
    names.push_back("joint" + std::to_string(names.size()));
    network.elements.push_back({names.back() + "_spring", ElementType::spring, joint.from, joint.to});
    network.elements.push_back({names.back(), ElementType::coulomb, joint.from, joint.to});
    network.elements.back().has_static_force = joint.at_rest > joint.friction;
    values.element.insert(values.element.end(), {joint.stiffness, joint.friction});
    values.second.insert(values.second.end(), {0.0, joint.at_rest > joint.friction ? joint.at_rest : 0.0});
  }
  Responses responses(network);
  const auto summary = responses.solve(values);
  INFO(summary.reason);
  REQUIRE(has_response(summary.status));
  for (const char* each : {"first_amplitude", "second_amplitude", "third_amplitude"})
    CHECK(responses[each] == 0.0);
  for (std::size_t i = 0; i < names.size(); ++i)
    CHECK(responses[names[i] + "_force_peak"] <= joints[i].at_rest * (1.0 + kRounding));
}

// How far a load is from all that contacts with directions W carry within their limits.
double out_of_reach(const Eigen::MatrixXd& W, const Eigen::VectorXd& load, const Eigen::VectorXd& limit) {
  const BoxMinimum nearest = box_minimum(W.transpose() * W, W.transpose() * load, -limit, limit, limit);
  REQUIRE(nearest.found);
  return (W * nearest.lambda - load).norm();
}

// The force swings between two loads of the first mass. A place x is possible where the contacts carry both
// less K x; of all such places, a convex set, x* has least energy if (K x*)^T (x - x*) >= 0.
TEST_CASE("No place where contacts in loops hold three masses has less energy than the one that is told") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.2, 1.0);
  constexpr std::size_t kMasses = 3;
  int held = 0, compared = 0;
  for (int trial = 0; trial < 60; ++trial) {
    INFO("trial " << trial);
    const double mean = 3.0 * uniform(random), swing = 1.5 * uniform(random);
    Network network;
    network.excitations = {{ExcitationKind::force, 0, 1}, {ExcitationKind::force, 0, 0}};
    NetworkValues values;
    values.omega = 0.3;
    values.excitation = {{swing, 6.0 * uniform(random)}, {mean, 0.0}};
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(3, 3), W = Eigen::MatrixXd::Zero(3, 6);
    Eigen::VectorXd limit(6);
    const auto add = [&](ElementType type, Node from, Node to, double value) {
      network.elements.push_back({"e" + std::to_string(network.elements.size()), type, from, to});
      values.element.push_back(value);
    };
    Eigen::Index contact = 0;
    const auto join = [&](Node from, Node to) {
      Eigen::Vector3d w = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(to.index));
      if (from.kind == NodeKind::mass) w[static_cast<Eigen::Index>(from.index)] = -1.0;
      const double stiffness = uniform(random);
      add(ElementType::spring, from, to, stiffness);
      K += stiffness * w * w.transpose();
      limit[contact] = uniform(random);
      add(ElementType::coulomb, from, to, limit[contact]);
      W.col(contact++) = w;
    };
    for (std::size_t i = 0; i < kMasses; ++i) {
      network.masses.push_back("m" + std::to_string(i));
      values.mass.push_back(1.0);
      join(kGround, {NodeKind::mass, i});
      for (std::size_t before = 0; before < i; ++before) join({NodeKind::mass, before}, {NodeKind::mass, i});
    }
    Responses responses(network);
    const auto summary = responses.solve(values);
    INFO(summary.reason);
    REQUIRE(has_response(summary.status));
    Eigen::Vector3d place;
    double amplitude = 0.0;
    for (Eigen::Index i = 0; i < 3; ++i) {
      const std::string name = "m" + std::to_string(i);
      place[i] = responses[name + "_mean"];
      amplitude = std::max(amplitude, responses[name + "_amplitude"]);
    }
    if (amplitude > 0.0) continue;
    ++held;
    constexpr double kInside = 1e-9;  // of forces of order 1
    constexpr double kFromLimits =
        1e-8;  // places at a limit are reported inside it by 5e-10 of it, limits of up to 6
    const Eigen::Vector3d highest((mean + swing) * Eigen::Vector3d::UnitX()),
        lowest((mean - swing) * Eigen::Vector3d::UnitX());
    CHECK(out_of_reach(W, highest - K * place, limit) < kInside);
    CHECK(out_of_reach(W, lowest - K * place, limit) < kInside);
    for (int other = 0; other < 200; ++other) {
      Eigen::VectorXd shares =
          Eigen::VectorXd::NullaryExpr(6, [&] { return std::clamp(5.0 * uniform(random) - 3.0, -1.0, 1.0); });
      shares = shares.cwiseProduct(limit).eval();
      const Eigen::Vector3d elsewhere = K.llt().solve(highest - W * shares);
      if (out_of_reach(W, lowest - K * elsewhere, limit) > kInside) continue;
      ++compared;
      CHECK((K * place).dot(elsewhere - place) >= -kFromLimits);
    }
  }
  CHECK(held > 20);
  CHECK(compared > 500);
}

// A chain whose masses are held to the ground and to each other has 78 cuts in all, too many ways to look for
// them.
TEST_CASE(
    "Masses in loops with too many cuts rest where the shares of their contacts are within the limits") {
  constexpr std::size_t kMasses = 12;
  constexpr double mean = 0.5, swing = 0.9, limit = 1.0;
  Network network;
  network.excitations = {{ExcitationKind::force, 0, 1}, {ExcitationKind::force, 0, 0}};
  NetworkValues chain;
  chain.omega = 0.3;
  chain.excitation = {{swing, 0.4}, {mean, 0.0}};
  const auto add = [&](ElementType type, Node from, Node to, double value) {
    network.elements.push_back({"e" + std::to_string(network.elements.size()), type, from, to});
    chain.element.push_back(value);
  };
  for (std::size_t i = 0; i < kMasses; ++i) {
    const Node mass{NodeKind::mass, i};
    network.masses.push_back("m" + std::to_string(i));
    chain.mass.push_back(1.0);
    add(ElementType::spring, kGround, mass, 1.0);
    add(ElementType::coulomb, kGround, mass, limit);
    if (i > 0) add(ElementType::coulomb, {NodeKind::mass, i - 1}, mass, limit);
  }
  Responses responses(network);
  responses.solve(chain);
  CHECK((responses["status"] == 1.0 || responses["status"] == 2.0));
  CHECK(responses["m0_amplitude"] == 0.0);
  // Two contacts carry the load of the first mass less what its spring takes.
  CHECK(responses["m0_mean"] <= mean + kRounding);
  CHECK(responses["m0_mean"] >= mean + swing - 2.0 * limit - kRounding);
  for (std::size_t i = 0; i < network.elements.size(); ++i) {
    if (network.elements[i].type != ElementType::coulomb) continue;
    INFO(network.elements[i].name);
    CHECK(responses[network.elements[i].name + "_force_peak"] <= limit + kRounding);
    CHECK(responses[network.elements[i].name + "_stuck_fraction"] == 1.0);
  }
}

TEST_CASE("A clamp lets go where the limits of no distribution hold it") {
  Responses responses(clamp());
  for (const double force : {kLower + kJoint - 1e-6, kLower + kJoint + 1e-2}) {
    const bool holds = force < kLower + kJoint;
    INFO("force " << force);
    responses.solve(values(force, 0.4));
    CHECK((responses["joint_stuck_fraction"] == 1.0) == holds);
    CHECK((responses["lower_stuck_fraction"] == 1.0) == holds);
    CHECK(responses["upper_stuck_fraction"] == 1.0);
    CHECK((responses["driven_amplitude"] > 0.0) != holds);
  }
}

}  // namespace
}  // namespace frahm::periodic::loops_test
