#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "solvers/laws/damper_bend.hpp"
#include "solvers/laws/elastic_stop.hpp"
#include "solvers/laws/spring_bend.hpp"
#include "solvers/orbits/orbit.hpp"
#include "tests/solvers/gradient_parameters.hpp"

// Derivatives of periodic responses in which several contacts or elements change their state at one instant:
// those of equal elements side by side are those of one of their sum, those of masses that do not feel each
// other those of one alone.
namespace frahm::periodic::one_instant_gradient_test {
namespace {

using mechanics::ElementType, mechanics::ExcitationKind, mechanics::Network, mechanics::NetworkValues,
    mechanics::Node, mechanics::NodeKind;

constexpr double kSame = 1e-8;  // relative to the largest derivative of the quantity by any pair
constexpr double kSolved = 1e-10;

const Node ground{}, first{NodeKind::mass, 0}, second{NodeKind::mass, 1};

struct Case {
  Network network;
  NetworkValues values;
};
using Place = std::function<double&(NetworkValues&)>;
struct Pair {
  Place ours, reference;
  double share = 1.0;  // of the reference's change
};
Place omega() {
  return [](NetworkValues& v) -> double& { return v.omega; };
}
Place element(std::size_t e) {
  return [e](NetworkValues& v) -> double& { return v.element[e]; };
}
Place other(std::size_t e) {
  return [e](NetworkValues& v) -> double& { return v.second[e]; };
}
Place force(std::size_t k) {
  return [k](NetworkValues& v) -> double& { return v.excitation[k].amplitude; };
}
Place at(std::size_t e, std::size_t bend = 0) {
  return [e, bend](NetworkValues& v) -> double& { return v.bends[e][bend].place; };
}
Place stiffness(std::size_t e, std::size_t bend = 0) {
  return [e, bend](NetworkValues& v) -> double& { return v.bends[e][bend].stiffness; };
}
Place damping(std::size_t e, std::size_t bend = 0) {
  return [e, bend](NetworkValues& v) -> double& { return v.bends[e][bend].damping; };
}

const std::vector<std::string> kNames = {"mass_peak",          "mass_rms",   "mass_mean",
                                         "mass_velocity_peak", "mass_phase", "mass_acceleration_peak"};

struct Derivatives {
  std::string reason;
  std::vector<double> own, by;  // by: of each pair all quantities
  std::vector<std::string> why_none;
};
Derivatives derivatives(const Case& of, const std::vector<std::string>& names,
                        const std::vector<NetworkValues>& directions) {
  std::vector<Quantity> quantities;
  for (const std::string& name : names) {
    const auto quantity = find_quantity(name, of.network);
    INFO(name);
    REQUIRE(quantity);
    quantities.push_back(*quantity);
  }
  PeriodicResponse response(of.network, quantities);
  response.set_values(of.values);
  const Status status = response.solve().status;
  REQUIRE((status == Status::ok || status == Status::several));
  Derivatives result;
  result.own.resize(names.size());
  response.quantities(result.own);
  result.by.resize(names.size() * directions.size());
  result.reason = response.gradient(directions, result.by);
  for (std::size_t i = 0; i < names.size(); ++i) result.why_none.push_back(response.why_no_derivative(i));
  return result;
}

NetworkValues along(const Case& of, const Place& place, double size = 1.0) {
  NetworkValues direction = zero_direction(of.values);
  place(direction) = size;
  return direction;
}

// names: of the reference, in both; those of further quantities of contacts that are alike may follow.
void check_same(const Case& ours, const Case& reference, const std::vector<Pair>& pairs,
                std::vector<std::string> names = kNames, std::size_t at_least = 5) {
  std::vector<NetworkValues> by, by_reference;
  for (const Pair& pair : pairs) {
    by.push_back(along(ours, pair.ours));
    by_reference.push_back(along(reference, pair.reference, pair.share));
  }
  const Derivatives a = derivatives(ours, names, by), b = derivatives(reference, names, by_reference);
  REQUIRE(b.reason == "");
  REQUIRE(a.reason == "");
  std::size_t compared = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    INFO(names[i]);
    CHECK(a.own[i] == Approx(b.own[i]).epsilon(kSolved).margin(kSolved));
    double size = 1e-3 * std::abs(b.own[i]);
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      if (std::isfinite(b.by[p * names.size() + i]))
        size = std::max(size, std::abs(b.by[p * names.size() + i]));
    }
    bool all = true;
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      INFO("pair " << p);
      const double x = a.by[p * names.size() + i], y = b.by[p * names.size() + i];
      all = all && !std::isnan(x);
      if (std::isnan(x))
        CHECK(a.why_none[i] != "");
      else if (!std::isnan(y))
        CHECK(std::abs(x - y) <= kSame * size);
    }
    compared += all ? 1 : 0;
  }
  CHECK(compared >= at_least);
}

struct Further {
  mechanics::Element element;
  double value = 0.0, second = 0.0;
  std::vector<mechanics::BendValue> bends = {};
};
// A mass on a spring and a damper under a force, and further elements.
Case one_mass(double frequency, const std::vector<Further>& further) {
  Case of;
  of.network.masses = {"mass"};
  of.network.elements = {{"spring", ElementType::spring, ground, first},
                         {"damper", ElementType::damper, ground, first}};
  of.network.excitations = {{ExcitationKind::force, 0, 1}, {ExcitationKind::force, 0, 0}};
  of.values = {
      .omega = frequency, .mass = {1.0}, .element = {1.0, 0.1}, .excitation = {{1.0, 0.2}, {0.1, 0.0}}};
  of.values.second = {0.0, 0.0};
  of.values.bends = {{}, {}};
  for (const Further& each : further) {
    of.network.elements.push_back(each.element);
    of.values.element.push_back(each.value);
    of.values.second.push_back(each.second);
    of.values.bends.push_back(each.bends);
  }
  return of;
}
mechanics::Element bent(const char* name, ElementType type, const laws::Bend& law) {
  mechanics::Element element{name, type, ground, first};
  element.bends = {{1.0, &law}};
  return element;
}
std::vector<Pair> of_the_mass(std::vector<Pair> more) {
  std::vector<Pair> all{
      {omega(), omega()}, {element(0), element(0)}, {element(1), element(1)}, {force(0), force(0)}};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

TEST_CASE("A response against two equal stops has the derivatives of one as stiff as both") {
  for (const double c : {0.0, 0.3}) {
    INFO("damping " << c);
    const auto stop = [&](const char* name, double share) {
      return Further{bent(name, ElementType::gap, laws::elastic_stop),
                     6.0 * share,
                     c * share,
                     {{0.4, 6.0 * share, c * share}}};
    };
    std::vector<Pair> more = {{stiffness(2), stiffness(2)}, {at(3), at(2), 0.5}};
    if (c > 0.0) more.push_back({damping(3), damping(2)});
    const Case both = one_mass(0.8, {stop("both", 1.0)});
    // The instant of the two stops is not one any more if one is moved, and an acceleration's peak is there.
    check_same(one_mass(0.8, {stop("one", 0.5), stop("other", 0.5)}), both, of_the_mass(more), kNames, 4);
    check_same(one_mass(0.8, {stop("one", 0.1), stop("two", 0.3), stop("three", 0.6)}), both,
               of_the_mass({}));
  }
}

TEST_CASE("So has one on two equal tables of springs or of dampers") {
  const auto hard = [](const char* name, double share) {
    return Further{
        bent(name, ElementType::spring, laws::spring_bend), 0.2 * share, 0.0, {{0.3, 1.5 * share, 0.0}}};
  };
  check_same(one_mass(0.8, {hard("one", 0.5), hard("other", 0.5)}), one_mass(0.8, {hard("both", 1.0)}),
             of_the_mass({{stiffness(2), stiffness(2)}, {at(3), at(2), 0.5}}), kNames, 4);
  const auto valve = [](const char* name, double share) {
    return Further{
        bent(name, ElementType::damper, laws::damper_bend), 0.05 * share, 0.0, {{0.2, 0.0, 0.4 * share}}};
  };
  check_same(one_mass(0.8, {valve("one", 0.5), valve("other", 0.5)}), one_mass(0.8, {valve("both", 1.0)}),
             of_the_mass({{damping(2), damping(2)}, {at(3), at(2), 0.5}}), kNames, 4);
}

Further rubs(const char* name, double F, bool other_way, double F_s) {
  mechanics::Element element{name, ElementType::coulomb, other_way ? first : ground,
                             other_way ? ground : first};
  element.has_static_force = F_s > 0.0;
  return {element, F, F_s};
}

TEST_CASE("So has one with equal friction one way and the other, with static friction, or with two jenkins") {
  for (const double frequency : {0.3, 0.8}) {  // with stops, without
    for (const double F_s : {0.0, 0.4}) {
      for (const bool other_way : {false, true}) {
        INFO("omega " << frequency << " static force " << F_s << " other way " << other_way);
        check_same(one_mass(frequency,
                            {rubs("one", 0.15, false, 0.5 * F_s), rubs("other", 0.15, other_way, 0.5 * F_s)}),
                   one_mass(frequency, {rubs("both", 0.3, false, F_s)}),
                   of_the_mass({{element(2), element(2)}}));
      }
    }
  }
  const auto slips = [](const char* name, double share) {
    return Further{{name, ElementType::jenkins, ground, first}, 0.8 * share, 0.2 * share};
  };
  check_same(one_mass(0.8, {slips("one", 0.5), slips("other", 0.5)}), one_mass(0.8, {slips("both", 1.0)}),
             of_the_mass({{element(2), element(2)}, {other(3), other(2)}}), kNames, 4);
}

// Two masses, each with what the only one has, and what joins them.
// spare: how many more masses there are, by themselves.
Case two_masses(const Case& one, const std::vector<std::pair<mechanics::Element, double>>& joints,
                std::size_t spare = 0) {
  Case of;
  of.network.masses = {"mass", "twin"};
  of.values.omega = one.values.omega;
  of.values.mass = {1.0, 1.0};
  for (const Node mass : {first, second}) {
    for (std::size_t e = 0; e < one.network.elements.size(); ++e) {
      mechanics::Element element = one.network.elements[e];
      element.along = mechanics::between(ground, mass);
      if (mass.index == 1) element.name += "_twin";
      of.network.elements.push_back(element);
      of.values.element.push_back(one.values.element[e]);
      of.values.second.push_back(one.values.second[e]);
      of.values.bends.push_back(one.values.bends[e]);
    }
    for (std::size_t k = 0; k < one.network.excitations.size(); ++k) {
      of.network.excitations.push_back(one.network.excitations[k]);
      of.network.excitations.back().node = mass.index;
      of.values.excitation.push_back(one.values.excitation[k]);
    }
  }
  for (std::size_t i = 0; i < spare; ++i) {
    const Node mass{NodeKind::mass, 2 + i};
    of.network.masses.push_back("spare" + std::to_string(i));
    of.values.mass.push_back(1.0);
    for (const ElementType type : {ElementType::spring, ElementType::damper}) {
      of.network.elements.emplace_back((type == ElementType::spring ? "k" : "c") + std::to_string(i), type,
                                       ground, mass);
      of.values.element.push_back(type == ElementType::spring ? 1.0 : 0.1);
      of.values.second.push_back(0.0);
      of.values.bends.emplace_back();
    }
  }
  for (const auto& [element, value] : joints) {
    of.network.elements.push_back(element);
    of.values.element.push_back(value);
    of.values.second.push_back(0.0);
    of.values.bends.emplace_back();
  }
  return of;
}

Further stop(double c) {
  return {bent("stop", ElementType::gap, laws::elastic_stop), 6.0, c, {{0.4, 6.0, c}}};
}

// Central differences, where the two masses stop one after the other.
TEST_CASE(
    "A symmetric structure whose masses stop at one instant has the derivatives of its peaks by one side") {
  constexpr double kStep = 1e-4, kDifferences = 1e-6;
  Case symmetric;
  symmetric.network.masses = {"mass", "other"};
  symmetric.network.elements = {{"spring", ElementType::spring, ground, first},
                                {"other_spring", ElementType::spring, ground, second},
                                {"link", ElementType::spring, first, second},
                                {"damper", ElementType::damper, ground, first},
                                {"other_damper", ElementType::damper, ground, second},
                                {"guide", ElementType::coulomb, ground, first},
                                {"other_guide", ElementType::coulomb, ground, second}};
  symmetric.network.excitations = {{ExcitationKind::force, 0, 1}, {ExcitationKind::force, 1, 1}};
  symmetric.values.omega = 0.7;
  symmetric.values.mass = {1.0, 1.0};
  symmetric.values.element = {1.0, 1.0, 0.4, 0.1, 0.1, 0.3, 0.3};
  symmetric.values.excitation = {{1.0, 0.0}, {1.0, 0.0}};
  const std::vector<std::string> names = {"mass_peak", "mass_peak_phase", "mass_rms", "spring_force_peak"};
  for (const std::size_t changed : {0u, 3u, 5u}) {
    INFO(symmetric.network.elements[changed].name);
    const Derivatives exact = derivatives(symmetric, names, {along(symmetric, element(changed))});
    REQUIRE(exact.reason == "");
    Case above = symmetric, below = symmetric;
    above.values.element[changed] += kStep;
    below.values.element[changed] -= kStep;
    const Derivatives more = derivatives(above, names, {}), less = derivatives(below, names, {});
    for (std::size_t i = 0; i < names.size(); ++i) {
      INFO(names[i] << ": " << exact.why_none[i]);
      CHECK(exact.by[i] == Approx((more.own[i] - less.own[i]) / (2.0 * kStep)).epsilon(kDifferences));
    }
  }
}

TEST_CASE("Masses that do not feel each other have their own derivatives, however they change together") {
  const auto check = [](double frequency, const Further& third, std::vector<std::string> names) {
    INFO("omega " << frequency << " " << third.element.name << " " << third.second);
    const Case one = one_mass(frequency, {third});
    names.insert(names.end(), kNames.begin(), kNames.end());
    for (const std::size_t spare : {0U, 7U})  // with tables of the flow, without
      check_same(two_masses(one, {}, spare), one,
                 {{element(0), element(0)}, {element(2), element(2)}, {force(0), force(0)}}, names, 5);
  };
  check(0.8, stop(0.0), {});
  check(0.8, stop(0.3), {"stop_energy"});
  for (const double F_s : {0.0, 0.4}) {
    check(0.3, rubs("friction", 0.3, false, F_s), {"friction_energy", "friction_stuck_fraction"});
    check(0.8, rubs("friction", 0.3, false, F_s), {"friction_energy"});
  }
}

TEST_CASE(
    "Masses that feel each other by an inerter have a derivative where all is shifted alike, or all rest") {
  const mechanics::Element joint{"joint", ElementType::inerter, first, second};
  const Case turns = one_mass(0.8, {rubs("friction", 0.1, false, 0.0)});
  const Case two = two_masses(turns, {{joint, 0.5}});
  // By both masses' springs as by the only one's: the inerter does not move.
  NetworkValues both = along(two, element(0));
  both.element[3] = 1.0;
  const Derivatives a = derivatives(two, {"mass_peak", "mass_rms"}, {both}),
                    b = derivatives(turns, {"mass_peak", "mass_rms"}, {along(turns, element(0))});
  REQUIRE(a.reason == "");
  CHECK(a.by[0] == Approx(b.by[0]).epsilon(kSame));
  CHECK(a.by[1] == Approx(b.by[1]).epsilon(kSame));
  // By one of them they turn one after the other, and the first moves the other.
  CHECK(derivatives(two, {"mass_peak"}, {along(two, element(0))}).reason ==
        "several contacts come to rest at one instant");
  // Where both stay at rest it does not matter which one comes first; how long each rests does.
  const Case stops = two_masses(one_mass(0.3, {rubs("friction", 0.6, false, 0.0)}), {{joint, 0.5}});
  const Derivatives c =
      derivatives(stops, {"mass_rms", "friction_stuck_fraction"}, {along(stops, element(0))});
  REQUIRE(c.reason == "");
  CHECK(std::isnan(c.by[1]));
  CHECK(c.why_none[1] == "several contacts or elements change their state at one instant");
  constexpr double kStep = 1e-5, kDifference = 1e-4;
  double rms[2];
  for (const int side : {0, 1}) {
    Case moved = stops;
    moved.values.element[0] += side == 0 ? -kStep : kStep;
    rms[side] = derivatives(moved, {"mass_rms"}, {}).own[0];
  }
  CHECK(c.by[0] == Approx((rms[1] - rms[0]) / (2.0 * kStep)).epsilon(kDifference));
}

}  // namespace
}  // namespace frahm::periodic::one_instant_gradient_test
