#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>

#include "solvers/identification/simulation.hpp"
#include "solvers/laws/damper_bend.hpp"
#include "solvers/laws/elastic_stop.hpp"
#include "solvers/laws/spring_bend.hpp"
#include "tests/solvers/gradient_parameters.hpp"

// Derivatives of motions in which several contacts or elements change their state at one instant: equal
// elements side by side against one of their sum, masses that do not feel each other against one alone,
// others against differences; or the reason why there is none.
namespace frahm::identification::one_instant_test {
namespace {

using mechanics::ElementType, mechanics::Network, mechanics::NetworkValues, mechanics::Node,
    mechanics::NodeKind;

constexpr double kSame = 1e-9;        // of two exact derivatives, relative to the largest of the trace
constexpr double kDifference = 3e-5;  // of a difference whose second order has a kink, likewise
constexpr double kStep = 1e-6;        // of differences

const Node ground{}, first{NodeKind::mass, 0}, second{NodeKind::mass, 1};

struct Case {
  Network network;
  Model model;
  TimeRecord record;
};
using Place = std::function<double&(Model&)>;

Model direction_of(const Model& model, const Place& place, double size = 1.0) {
  const std::vector<double> none(model.values.mass.size(), 0.0);
  Model zero{periodic::zero_direction(model.values), {none, none}};
  place(zero) = size;
  return zero;
}

void observe(Case& of, double end, int samples = 60) {
  // No sample lies at an event.
  for (int k = 0; k <= samples; ++k) of.record.time.push_back(end * k / samples + (k > 0 ? 1e-3 : 0.0));
  for (std::size_t mass = 0; mass < of.network.masses.size(); ++mass) {
    for (const Signal signal : {Signal::displacement, Signal::velocity, Signal::acceleration})
      of.record.channels.push_back({of.network.masses[mass], mass, signal, {}});
  }
}

periodic::ObservedMotion derivatives(const Case& of, const std::vector<Model>& by) {
  Simulation simulation(of.network, of.record, {});
  periodic::ObservedMotion motion;
  REQUIRE(simulation.run(of.model, by, of.record.time.size(), motion) == "");
  for (const Eigen::MatrixXd& each : motion.by) REQUIRE(each.allFinite());
  return motion;
}

std::string reason(const Case& of, const Model& by) {
  Simulation simulation(of.network, of.record, {});
  periodic::ObservedMotion motion;
  return simulation.run(of.model, {&by, 1}, of.record.time.size(), motion);
}

// Each pair is the same change of both cases; `shares` of the second makes the first's.
struct Pair {
  Place ours, reference;
  double share = 1.0;
};
void check_same(const Case& ours, const Case& reference, const std::vector<Pair>& pairs) {
  std::vector<Model> by, by_reference;
  for (const Pair& pair : pairs) {
    by.push_back(direction_of(ours.model, pair.ours));
    by_reference.push_back(direction_of(reference.model, pair.reference, pair.share));
  }
  const auto a = derivatives(ours, by), b = derivatives(reference, by_reference);
  const Eigen::Index columns = b.values.cols();
  CHECK((a.values.leftCols(columns) - b.values).cwiseAbs().maxCoeff() <
        kSame * b.values.cwiseAbs().maxCoeff());
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    for (Eigen::Index c = 0; c < columns; ++c) {
      INFO("pair " << p << " channel " << c);
      const double size = b.by[p].col(c).cwiseAbs().maxCoeff();
      CHECK(size > 0.0);
      CHECK((a.by[p].col(c) - b.by[p].col(c)).cwiseAbs().maxCoeff() <= kSame * size);
    }
  }
}

void check_differences(const Case& of, const std::vector<Place>& places) {
  Simulation simulation(of.network, of.record, {});
  std::vector<Model> by;
  for (const Place& place : places) by.push_back(direction_of(of.model, place));
  const auto exact = derivatives(of, by);
  for (std::size_t p = 0; p < places.size(); ++p) {
    periodic::ObservedMotion sides[2];
    for (const int side : {0, 1}) {
      Model model = of.model;
      places[p](model) += side == 0 ? -kStep : kStep;
      REQUIRE(simulation.run(model, {}, of.record.time.size(), sides[side]) == "");
    }
    const Eigen::MatrixXd difference = (sides[1].values - sides[0].values) / (2.0 * kStep);
    for (Eigen::Index c = 0; c < difference.cols(); ++c) {
      INFO("place " << p << " channel " << c);
      const double apart = (exact.by[p].col(c) - difference.col(c)).cwiseAbs().maxCoeff();
      CHECK(apart <= kDifference * std::max(1e-2, difference.cwiseAbs().maxCoeff()));
    }
  }
}

Place element(std::size_t e) {
  return [e](Model& m) -> double& { return m.values.element[e]; };
}
Place other(std::size_t e) {
  return [e](Model& m) -> double& { return m.values.second[e]; };
}
Place at(std::size_t e, std::size_t bend = 0) {
  return [e, bend](Model& m) -> double& { return m.values.bends[e][bend].place; };
}
Place stiffness(std::size_t e, std::size_t bend = 0) {
  return [e, bend](Model& m) -> double& { return m.values.bends[e][bend].stiffness; };
}
Place damping(std::size_t e, std::size_t bend = 0) {
  return [e, bend](Model& m) -> double& { return m.values.bends[e][bend].damping; };
}
Place displacement(std::size_t mass) {
  return [mass](Model& m) -> double& { return m.initial.displacement[mass]; };
}
Place velocity(std::size_t mass) {
  return [mass](Model& m) -> double& { return m.initial.velocity[mass]; };
}

// A mass on a spring and a damper, and further elements; it is let go at -1 with a velocity.
struct Further {
  mechanics::Element element;
  double value = 0.0, second = 0.0;
  std::vector<mechanics::BendValue> bends = {};
};
Case one_mass(const std::vector<Further>& further) {
  Case of;
  of.network.masses = {"mass"};
  of.network.elements = {{"spring", ElementType::spring, ground, first},
                         {"damper", ElementType::damper, ground, first}};
  of.model.values = {.omega = 1.0, .mass = {1.0}, .element = {1.0, 0.05}};
  of.model.values.second = {0.0, 0.0};
  of.model.values.bends = {{}, {}};
  for (const Further& each : further) {
    of.network.elements.push_back(each.element);
    of.model.values.element.push_back(each.value);
    of.model.values.second.push_back(each.second);
    of.model.values.bends.push_back(each.bends);
  }
  of.model.initial = {{-1.0}, {0.3}};
  observe(of, 20.0);
  return of;
}
mechanics::Element bent(const char* name, ElementType type, const laws::Bend& law, double side = 1.0) {
  mechanics::Element element{name, type, ground, first};
  element.bends = {{side, &law}};
  return element;
}

std::vector<Pair> of_the_mass() {
  return {{element(0), element(0)},
          {element(1), element(1)},
          {displacement(0), displacement(0)},
          {velocity(0), velocity(0)}};
}
std::vector<Pair> with(std::vector<Pair> more) {
  std::vector<Pair> all = of_the_mass();
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

TEST_CASE("Motions against two equal stops have the derivatives of one as stiff as both") {
  for (const double c : {0.0, 0.3}) {
    INFO("damping " << c);
    const auto stop = [&](const char* name, double share) {
      return Further{bent(name, ElementType::gap, laws::elastic_stop),
                     6.0 * share,
                     c * share,
                     {{0.4, 6.0 * share, c * share}}};
    };
    std::vector<Pair> pairs = with({{stiffness(2), stiffness(2)}, {at(2), at(2), 0.5}, {at(3), at(2), 0.5}});
    if (c > 0.0) pairs.push_back({damping(3), damping(2)});
    check_same(one_mass({stop("one", 0.5), stop("other", 0.5)}), one_mass({stop("both", 1.0)}), pairs);
    // Shares that are not equal in the last digits either.
    check_same(one_mass({stop("one", 0.1), stop("two", 0.3), stop("three", 0.6)}),
               one_mass({stop("both", 1.0)}), of_the_mass());
  }
}

TEST_CASE("So have those on two equal tables of springs and of dampers") {
  const auto hard = [](const char* name, double share) {
    return Further{
        bent(name, ElementType::spring, laws::spring_bend), 0.2 * share, 0.0, {{0.3, 1.5 * share, 0.0}}};
  };
  check_same(one_mass({hard("one", 0.5), hard("other", 0.5)}), one_mass({hard("both", 1.0)}),
             with({{stiffness(2), stiffness(2)}, {at(3), at(2), 0.5}}));
  const auto valve = [](const char* name, double share) {
    return Further{
        bent(name, ElementType::damper, laws::damper_bend), 0.05 * share, 0.0, {{0.2, 0.0, 0.4 * share}}};
  };
  check_same(one_mass({valve("one", 0.5), valve("other", 0.5)}), one_mass({valve("both", 1.0)}),
             with({{damping(2), damping(2)}, {at(3), at(2), 0.5}}));
}

TEST_CASE("So have those of equal friction one way and the other, of equal static friction and of jenkins") {
  const auto rubs = [](const char* name, double share, bool other_way, double F_s) {
    mechanics::Element element{name, ElementType::coulomb, other_way ? first : ground,
                               other_way ? ground : first};
    element.has_static_force = F_s > 0.0;
    return Further{element, 0.1 * share, F_s * share};
  };
  for (const double F_s : {0.0, 0.15}) {
    INFO("static force " << F_s);
    for (const bool other_way : {false, true})
      check_same(one_mass({rubs("one", 0.5, false, F_s), rubs("other", 0.5, other_way, F_s)}),
                 one_mass({rubs("both", 1.0, false, F_s)}), with({{element(2), element(2)}}));
  }
  const auto slips = [](const char* name, double share) {
    return Further{{name, ElementType::jenkins, ground, first}, 0.8 * share, 0.15 * share};
  };
  check_same(one_mass({slips("one", 0.5), slips("other", 0.5)}), one_mass({slips("both", 1.0)}),
             with({{element(2), element(2)}, {other(3), other(2)}}));
}

// Two masses, each with what the only one has, and what joins them.
Case two_masses(const Case& one, const std::vector<std::pair<mechanics::Element, double>>& joints) {
  Case of;
  of.network.masses = {"mass", "twin"};
  NetworkValues& values = of.model.values;
  values.omega = 1.0;
  values.mass = {1.0, 1.0};
  for (const Node mass : {first, second}) {
    for (std::size_t e = 0; e < one.network.elements.size(); ++e) {
      mechanics::Element element = one.network.elements[e];
      element.along = mechanics::between(ground, mass);
      if (mass.index == 1) element.name += "_twin";
      of.network.elements.push_back(element);
      values.element.push_back(one.model.values.element[e]);
      values.second.push_back(one.model.values.second[e]);
      values.bends.push_back(one.model.values.bends[e]);
    }
  }
  for (const auto& [element, value] : joints) {
    of.network.elements.push_back(element);
    values.element.push_back(value);
    values.second.push_back(0.0);
    values.bends.emplace_back();
  }
  const double x = one.model.initial.displacement[0], v = one.model.initial.velocity[0];
  of.model.initial = {{x, x}, {v, v}};
  observe(of, 20.0);
  return of;
}

Further stop(double c) {
  return {bent("stop", ElementType::gap, laws::elastic_stop), 6.0, c, {{0.4, 6.0, c}}};
}
Further friction(double F, double F_s) {
  mechanics::Element element{"friction", ElementType::coulomb, ground, first};
  element.has_static_force = F_s > 0.0;
  return {element, F, F_s};
}

TEST_CASE("Masses that do not feel each other have their own derivatives through events at one instant") {
  for (const Further& third : {stop(0.3), friction(0.1, 0.0), friction(0.1, 0.15), friction(0.02, 0.0)}) {
    INFO(third.element.name << " " << third.value << " " << third.second);
    const Case one = one_mass({third});
    const Place own = third.bends.empty() ? element(2) : stiffness(2);
    check_same(two_masses(one, {}), one, with({{own, own}}));
  }
}

TEST_CASE(
    "Masses that are joined by a spring and hit damped stops or come to rest together do as differences") {
  const mechanics::Element joint{"joint", ElementType::spring, first, second};
  for (const Further& third : {stop(0.3), friction(0.1, 0.0), friction(0.1, 0.15)}) {
    INFO(third.element.name << " " << third.second);
    const Case of = two_masses(one_mass({third}), {{joint, 0.5}});
    check_differences(of, {element(0), element(2), element(5), displacement(0), velocity(1)});
  }
}

TEST_CASE(
    "Masses that feel each other by an inerter have a derivative if all is shifted alike, or all rest") {
  const mechanics::Element joint{"joint", ElementType::inerter, first, second};
  // Reversals, whose order decides.
  Case of = two_masses(one_mass({friction(0.02, 0.0)}), {{joint, 0.5}});
  for (double& t : of.record.time) t *= 0.25;  // before they rest
  CHECK(reason(of, direction_of(of.model, element(2))) == "several contacts come to rest at one instant");
  Case one = one_mass({friction(0.02, 0.0)});
  one.record.time = of.record.time;
  Model both = direction_of(of.model, element(2));
  element(5)(both) = 1.0;
  const auto exact = derivatives(of, {both}), alone = derivatives(one, {direction_of(one.model, element(2))});
  CHECK((exact.by[0].leftCols(3) - alone.by[0]).cwiseAbs().maxCoeff() <
        kSame * alone.by[0].cwiseAbs().maxCoeff());
  // Stops: from x = -0.12 half a swing ends inside the band of friction.
  of = two_masses(one_mass({friction(0.1, 0.0)}), {{joint, 0.5}});
  of.model.initial = {{-0.15, -0.15}, {0.0, 0.0}};
  check_differences(of, {element(0), element(2), element(5), displacement(0)});
  // Damped stops, whose forces add up.
  check_differences(two_masses(one_mass({stop(0.3)}), {{joint, 0.5}}),
                    {element(0), at(2), stiffness(5), displacement(0), velocity(1)});
}

// Without dampers, from the rest at 1 the first mass turns at t = pi at -(1 - 2 F), whatever F is; the second
// starts at 0 with the velocity -1 and comes back at t = pi with 1.
Case turns_and_hits(double F, double F_s, bool between) {
  Case of;
  of.network.masses = {"mass", "twin"};
  mechanics::Element gap = bent("stop", ElementType::gap, laws::elastic_stop);
  gap.along = mechanics::between(between ? first : ground, second);
  mechanics::Element rubs{"friction", ElementType::coulomb, ground, first};
  rubs.has_static_force = F_s > 0.0;
  of.network.elements = {{"spring", ElementType::spring, ground, first},
                         {"spring_twin", ElementType::spring, ground, second},
                         rubs,
                         gap};
  of.model.values = {.omega = 1.0,
                     .mass = {1.0, 1.0},
                     .element = {1.0, 1.0, F, 2.0},
                     .second = {0.0, 0.0, F_s, 0.05},
                     .bends = {{}, {}, {}, {{between ? 1.0 - 2.0 * F : 0.0, 2.0, 0.05}}}};
  of.model.initial = {{1.0, 0.0}, {0.0, -1.0}};
  observe(of, 3.3, 33);
  return of;
}

TEST_CASE("A contact that turns and a damped stop that is hit at one instant") {
  const std::vector<Place> places = {element(0), element(2), displacement(0), velocity(1)};
  // The contact turns, and the stop is another mass's.
  check_differences(turns_and_hits(0.1, 0.0, false), places);
  // The contact stays at rest, with what the stop adds.
  check_differences(turns_and_hits(0.25, 0.6, true), places);
  // It turns, and the stop pushes its mass: the order decides.
  const Case of = turns_and_hits(0.1, 0.0, true);
  CHECK(reason(of, direction_of(of.model, velocity(1))) ==
        "several contacts or elements change their state at one instant");
}

TEST_CASE("Events at one instant between two samples of a measured force, and exactly at one") {
  const auto driven = [](Case of, double event) {
    of.record.motion = MotionKind::forced;
    of.record.time.clear();
    for (int k = 0; k <= 40; ++k) of.record.time.push_back(event * k / 20.0);
    of.record.excitation = {{mechanics::ExcitationKind::force, 0, std::vector<double>(41, 0.0)}};
    for (Channel& channel : of.record.channels) channel.signal = Signal::displacement;
    return of;
  };
  constexpr double kTurn = std::numbers::pi;
  check_differences(driven(turns_and_hits(0.25, 0.6, true), kTurn),
                    {element(0), displacement(0), velocity(1)});
  check_differences(driven(turns_and_hits(0.1, 0.0, false), kTurn),
                    {element(0), displacement(0), velocity(1)});
  const mechanics::Element joint{"joint", ElementType::inerter, first, second};
  Case of = two_masses(one_mass({stop(0.3)}), {{joint, 0.5}});
  of.model.values.element[1] = of.model.values.element[4] = 0.0;  // undamped
  of.model.initial = {{-1.0, -1.0}, {0.0, 0.0}};
  // cos t = -0.4 where both are at the place.
  check_differences(driven(of, std::acos(-0.4)), {element(0), at(2), displacement(0), velocity(1)});
}

}  // namespace
}  // namespace frahm::identification::one_instant_test
