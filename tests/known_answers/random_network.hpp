#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "solvers/laws/damper_bend.hpp"
#include "solvers/laws/elastic_stop.hpp"
#include "solvers/laws/spring_bend.hpp"
#include "solvers/mechanics/network.hpp"

// Networks drawn at random: a chain of masses on springs and dampers, with further springs, an inerter,
// friction, Maxwell and hysteretic elements and a shaken support that acts through all of them. Contacts form
// no loops among the masses and their support, in which friction forces are a matter of convention.
namespace frahm::periodic {

struct RandomNetwork {
  mechanics::Network network;
  mechanics::NetworkValues values;
};

struct RandomNetworkOptions {
  int masses = 1;
  int contacts = 0;
  int maxwell_elements = 0;
  bool hysteretic = false;
  int jenkins_elements = 0;
  int rising_dampers = 0;         // whose tables bend on both sides and never fall
  int stops = 0;                  // gaps on one side, half of them with damping
  bool static_friction = false;   // up to twice the sliding force
  std::vector<int> orders = {1};  // of the forces and of the support's motion
  bool shaken = true;             // a prescribed node exists
  double largest_friction = 1.0;  // of the amplitude of the force, 1 N
  int two_sided_stops = 0;        // gaps on both sides, half of them with damping
  int spring_tables = 0;          // that bend twice on both sides, and may fall between
  int falling_dampers = 0;        // whose tables fall on both sides and rise again
};

inline RandomNetwork random_network(const RandomNetworkOptions& options, std::mt19937& random) {
  using namespace mechanics;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto spread = [&](double decades) { return std::pow(10.0, decades * (uniform(random) - 0.5)); };
  const auto pick = [&](int count) { return static_cast<int>(uniform(random) * count); };
  const auto n = static_cast<std::size_t>(options.masses);
  const Node ground{}, support{NodeKind::prescribed, 0};
  const auto mass = [](std::size_t i) { return Node{NodeKind::mass, i}; };
  const auto numbered = [](char letter, std::size_t number) {
    return std::string(1, letter).append(std::to_string(number));
  };
  RandomNetwork result;
  Network& network = result.network;
  NetworkValues& values = result.values;
  const auto add = [&](ElementType type, Node a, Node b, double value) {
    network.elements.push_back({numbered('e', network.elements.size()), type, a, b});
    values.element.push_back(value);
    values.second.push_back(0.0);
  };
  for (std::size_t i = 0; i < n; ++i) {
    network.masses.push_back(numbered('m', i));
    values.mass.push_back(spread(1.0));
    const Node before = i == 0 ? ground : mass(i - 1);
    add(ElementType::spring, before, mass(i), spread(1.0));
    add(ElementType::damper, before, mass(i), 0.1 * spread(1.5));
  }
  if (n > 1) {
    add(ElementType::spring, ground, mass(n - 1), spread(2.0));
    add(ElementType::inerter, mass(0), mass(n - 1), 0.5 * spread(1.0));
  }
  if (options.shaken) {
    network.prescribed.push_back("support");
    const Node at = mass(static_cast<std::size_t>(pick(options.masses)));
    add(ElementType::spring, support, at, spread(1.0));
    add(ElementType::damper, support, at, 0.1 * spread(1.0));
    add(ElementType::inerter, support, at, 0.1 * spread(1.0));
  }
  std::vector<std::size_t> cluster(n + 2);  // of masses, ground and support joined by contacts
  for (std::size_t i = 0; i < cluster.size(); ++i) cluster[i] = i;
  const auto place = [&](const Node& node) {
    return node.kind == NodeKind::mass ? node.index : node.kind == NodeKind::ground ? n : n + 1;
  };
  for (int j = 0; j < options.contacts; ++j) {
    const Node b = mass(static_cast<std::size_t>(pick(options.masses)));
    Node a = ground;
    if (options.shaken && uniform(random) < 0.3)
      a = support;
    else if (n > 1 && uniform(random) < 0.5)
      a = mass((b.index + 1 + static_cast<std::size_t>(pick(options.masses - 1))) % n);
    const std::size_t from = cluster[place(a)], to = cluster[place(b)];
    if (from == to) continue;
    std::replace(cluster.begin(), cluster.end(), from, to);
    add(ElementType::coulomb, a, b, options.largest_friction * uniform(random));
  }
  for (int j = 0; j < options.maxwell_elements; ++j) {
    const Node b = mass(static_cast<std::size_t>(pick(options.masses)));
    const Node a = options.shaken && uniform(random) < 0.5 ? support
                   : b.index > 0                           ? mass(b.index - 1)
                                                           : ground;
    add(ElementType::maxwell, a, b, spread(1.0));
    values.second.back() = spread(1.5);
  }
  if (options.hysteretic) {
    add(ElementType::hysteretic, options.shaken ? support : ground, mass(n - 1), spread(1.0));
    values.second.back() = 0.2 * spread(1.0);
  }
  const auto between = [&] {  // a mass, and the ground, the support or the mass before
    const Node b = mass(static_cast<std::size_t>(pick(options.masses)));
    const Node a = options.shaken && uniform(random) < 0.3 ? support
                   : b.index > 0                           ? mass(b.index - 1)
                                                           : ground;
    return std::pair{a, b};
  };
  for (int j = 0; j < options.jenkins_elements; ++j) {
    const auto [a, b] = between();
    add(ElementType::jenkins, a, b, 2.0 * spread(1.0));
    values.second.back() = options.largest_friction * uniform(random);
  }
  values.bends.resize(values.element.size());
  for (int j = 0; j < options.rising_dampers; ++j) {
    const auto [a, b] = between();
    const double c = 0.1 * spread(1.0);
    add(ElementType::damper, a, b, c);
    network.elements.back().bends = {{1.0, &laws::damper_bend}, {-1.0, &laws::damper_bend}};
    values.bends.push_back({{0.3 * uniform(random), 0.0, 0.3 * uniform(random)},
                            {0.3 * uniform(random), 0.0, -0.9 * c * uniform(random)}});
  }
  for (int j = 0; j < options.stops; ++j) {
    const auto [a, b] = between();
    const double k = 4.0 * spread(1.0), c = uniform(random) < 0.5 ? 0.0 : 0.3 * uniform(random);
    add(ElementType::gap, a, b, k);
    values.second.back() = c;
    network.elements.back().bends = {{uniform(random) < 0.5 ? 1.0 : -1.0, &laws::elastic_stop}};
    values.bends.push_back({{uniform(random), k, c}});
  }
  for (int j = 0; j < options.two_sided_stops; ++j) {
    const auto [a, b] = between();
    const double k = 4.0 * spread(1.0), c = uniform(random) < 0.5 ? 0.0 : 0.3 * uniform(random);
    add(ElementType::gap, a, b, k);
    values.second.back() = c;
    network.elements.back().bends = {{1.0, &laws::elastic_stop}, {-1.0, &laws::elastic_stop}};
    values.bends.push_back({{uniform(random), k, c}, {uniform(random), k, c}});
  }
  for (int j = 0; j < options.spring_tables; ++j) {
    const auto [a, b] = between();
    const double k = spread(1.0), inner = 0.2 + uniform(random), outer = inner + 0.2 + uniform(random);
    const double softer = -1.5 * k * uniform(random), stiffer = 3.0 * k * uniform(random) - softer;
    add(ElementType::spring, a, b, k);
    const auto bend = [](double side) { return BendPlace{side, &laws::spring_bend}; };
    network.elements.back().bends = {bend(1.0), bend(1.0), bend(-1.0), bend(-1.0)};
    values.bends.push_back(
        {{inner, softer, 0.0}, {outer, stiffer, 0.0}, {inner, softer, 0.0}, {outer, stiffer, 0.0}});
  }
  for (int j = 0; j < options.falling_dampers; ++j) {
    const auto [a, b] = between();
    const double c = 0.2 * spread(1.0), inner = 0.2 + uniform(random), outer = inner + 0.2 + uniform(random);
    const double falls = -c * (1.0 + 0.5 * uniform(random)), rises = c - falls;
    add(ElementType::damper, a, b, c);
    const auto bend = [](double side) { return BendPlace{side, &laws::damper_bend}; };
    network.elements.back().bends = {bend(1.0), bend(1.0), bend(-1.0), bend(-1.0)};
    values.bends.push_back(
        {{inner, 0.0, falls}, {outer, 0.0, rises}, {inner, 0.0, falls}, {outer, 0.0, rises}});
  }
  for (std::size_t e = 0; options.static_friction && e < network.elements.size(); ++e) {
    if (network.elements[e].type != ElementType::coulomb) continue;
    network.elements[e].has_static_force = true;
    values.second[e] = values.element[e] * (1.0 + uniform(random));
  }
  for (const int order : options.orders) {
    const auto on = static_cast<std::size_t>(pick(options.masses));
    network.excitations.push_back({ExcitationKind::force, on, order});
    values.excitation.push_back({order == 0 ? 0.3 : 1.0 / order, 2.0 * std::numbers::pi * uniform(random)});
    if (!options.shaken) continue;
    network.excitations.push_back({ExcitationKind::motion, 0, order});
    values.excitation.push_back({0.5 / (order + 1), 2.0 * std::numbers::pi * uniform(random)});
  }
  values.omega = spread(1.4);
  return result;
}

}  // namespace frahm::periodic
