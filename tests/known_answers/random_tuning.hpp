#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "solvers/tuning/task.hpp"

// Tunings drawn at random: a main mass on a spring with one or two absorbers, with inerters, friction in the
// guide, limits of strokes and two scenarios each now and then; two or three elements are tuned, from
// anywhere in their box.
namespace frahm {

inline tuning::Task random_tuning(std::mt19937& random) {
  using mechanics::ElementType;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto between = [&](double least, double most) {
    return least * std::pow(most / least, uniform(random));
  };
  const auto chance = [&](double share) { return uniform(random) < share; };
  tuning::Task task;
  mechanics::Network& network = task.network;
  mechanics::NetworkValues values;
  const mechanics::Node ground{}, main{mechanics::NodeKind::mass, 0};
  std::vector<std::size_t> tuned, springs;
  const auto add = [&](const std::string& name, ElementType type, mechanics::Node a, mechanics::Node b,
                       double value) {
    network.elements.push_back({name, type, a, b});
    values.element.push_back(value);
    values.second.push_back(0.0);
    return network.elements.size() - 1;
  };
  network.masses = {"main"};
  values.mass = {1.0};
  add("main_spring", ElementType::spring, ground, main, 1.0);
  add("main_damper", ElementType::damper, ground, main, between(0.005, 0.1));
  const bool rubs = chance(0.3);
  if (rubs) add("guide", ElementType::coulomb, ground, main, between(0.02, 0.3));
  const int absorbers = chance(0.4) ? 2 : 1;
  for (int i = 0; i < absorbers; ++i) {
    const std::string number = std::to_string(i);
    const mechanics::Node absorber{mechanics::NodeKind::mass, network.masses.size()};
    network.masses.push_back("absorber" + number);
    const double mass = between(0.02, 0.3), stiffness = mass * std::pow(between(0.6, 1.6), 2);
    values.mass.push_back(mass);
    springs.push_back(add("spring" + number, ElementType::spring, main, absorber, stiffness));
    tuned.push_back(springs.back());
    const double damping = 2.0 * between(0.02, 0.3) * std::sqrt(mass * stiffness);
    tuned.push_back(add("damper" + number, ElementType::damper, main, absorber, damping));
    if (chance(0.4)) {
      const mechanics::Node from = chance(0.5) ? ground : main;
      tuned.push_back(
          add("inerter" + number, ElementType::inerter, from, absorber, mass * between(0.05, 0.5)));
    }
  }
  network.excitations = {{mechanics::ExcitationKind::force, 0}};
  values.excitation = {{1.0, 0.0, 0.0}};
  std::shuffle(tuned.begin(), tuned.end(), random);
  tuned.resize(std::min<std::size_t>(tuned.size(), chance(0.4) ? 3 : 2));
  for (const std::size_t element : tuned) {
    const double value = values.element[element];
    const double lower = value / between(2.0, 10.0), upper = value * between(2.0, 10.0);
    task.parameters.push_back(
        {network.elements[element].name, lower, upper, lower + (upper - lower) * uniform(random), {}});
  }
  task.scenarios = {"nominal"};
  if (chance(0.3)) task.scenarios = {"soft", "stiff"};
  const std::size_t scenarios = task.scenarios.size();
  task.network_at = [=](std::size_t scenario, std::span<const double> at, mechanics::NetworkValues& out,
                        std::vector<mechanics::NetworkValues>* derivatives) {
    out = values;
    if (scenarios == 2) out.element[0] = scenario == 0 ? 0.85 : 1.15;
    for (std::size_t p = 0; p < tuned.size(); ++p) out.element[tuned[p]] = at[p];
    out.omega = at[tuned.size()];
    if (!derivatives) return;
    mechanics::NetworkValues zero;
    zero.excitation = {{0.0, 0.0, 0.0}};
    zero.mass.assign(values.mass.size(), 0.0);
    zero.element.assign(values.element.size(), 0.0);
    zero.second.assign(values.second.size(), 0.0);
    derivatives->assign(tuned.size() + 1, zero);
    for (std::size_t p = 0; p < tuned.size(); ++p) (*derivatives)[p].element[tuned[p]] = 1.0;
    derivatives->back().omega = 1.0;
  };
  task.band = {between(0.3, 0.7), between(1.4, 2.5)};
  task.quantity = {periodic::Measure::peak, 0};
  if (chance(0.4)) {
    const double most = between(3.0, 60.0);
    task.limits.push_back({"stroke", {periodic::Measure::stroke, springs[0]}, -kInfinity, most, {}});
  }
  return task;
}

}  // namespace frahm
