#include "tests/invariants/changes.hpp"

#include <algorithm>
#include <numeric>
#include <random>

namespace frahm::invariants {
namespace {

using namespace mechanics;

double& second_of(Case& c, std::size_t element) {
  return c.values.second[element];
}

// In units of length [m], time [s] and mass [kg]; values are what the new numbers are of the old.
Change in_other_units(const Case& original, const std::string& name, double length, double time,
                      double mass) {
  const double force = mass * length / (time * time);
  Change change{name, original, {length, time, force}};
  NetworkValues& values = change.changed.values;
  const double stiffness = force / length, damping = stiffness * time;
  values.omega /= time;
  for (double& m : values.mass) m *= mass;
  for (std::size_t e = 0; e < values.element.size(); ++e) {
    switch (original.network.elements[e].type) {
      case ElementType::spring:
      case ElementType::hysteretic:
        values.element[e] *= stiffness;
        break;
      case ElementType::damper:
        values.element[e] *= damping;
        break;
      case ElementType::inerter:
        values.element[e] *= mass;
        break;
      case ElementType::coulomb:
        values.element[e] *= force;
        break;
      case ElementType::maxwell:
        values.element[e] *= stiffness;
        second_of(change.changed, e) *= damping;
        break;
      case ElementType::jenkins:
        values.element[e] *= stiffness;
        second_of(change.changed, e) *= force;
        break;
      case ElementType::gap:
        values.element[e] *= stiffness;
        second_of(change.changed, e) *= damping;
        for (BendValue& bend : values.bends[e])
          bend = {bend.place * length, bend.stiffness * stiffness, bend.damping * damping};
        break;
    }
  }
  for (std::size_t k = 0; k < values.excitation.size(); ++k) {
    const bool is_force = original.network.excitations[k].kind == ExcitationKind::force;
    values.excitation[k].amplitude *= is_force ? force : length;
  }
  return change;
}

Change amplified(const Case& original, const std::string& name, double factor) {
  Change change{name, original, {factor, 1.0, factor}};
  for (ExcitationValue& value : change.changed.values.excitation) value.amplitude *= factor;
  for (std::size_t e = 0; e < original.network.elements.size(); ++e) {
    if (original.network.elements[e].type == ElementType::coulomb) change.changed.values.element[e] *= factor;
    if (original.network.elements[e].type == ElementType::jenkins) second_of(change.changed, e) *= factor;
  }
  return change;
}

Change mirrored(const Case& original) {
  Change change{"mirrored", original, {}};
  change.sign = -1.0;
  for (ExcitationValue& value : change.changed.values.excitation) value.amplitude *= -1.0;
  return change;
}

Change later(const Case& original, double by) {
  Change change{"phase origin", original, {}};
  for (std::size_t k = 0; k < original.network.excitations.size(); ++k)
    change.changed.values.excitation[k].phase += original.network.excitations[k].order * by;
  return change;
}

std::vector<std::size_t> shuffled_places(std::size_t count, std::mt19937_64& random) {
  std::vector<std::size_t> places(count);
  std::iota(places.begin(), places.end(), std::size_t{0});
  std::shuffle(places.begin(), places.end(), random);
  return places;
}

// Masses, elements and excitations in another order, and every second element the other way round.
Change shuffled(const Case& original) {
  std::mt19937_64 random(original.seed + 1);
  const Network& network = original.network;
  const auto masses = shuffled_places(network.masses.size(), random);
  const auto elements = shuffled_places(network.elements.size(), random);
  const auto excitations = shuffled_places(network.excitations.size(), random);
  Change change{"shuffled", original, {}};
  Case& to = change.changed;
  std::vector<std::size_t> place(masses.size());
  for (std::size_t i = 0; i < masses.size(); ++i) {
    place[masses[i]] = i;
    to.network.masses[i] = network.masses[masses[i]];
    to.values.mass[i] = original.values.mass[masses[i]];
  }
  const auto moved = [&](Node node) {
    if (node.kind == NodeKind::mass) node.index = place[node.index];
    return node;
  };
  for (std::size_t e = 0; e < elements.size(); ++e) {
    Element element = network.elements[elements[e]];
    for (auto& [node, factor] : element.along) {
      node = moved(node);
      if (e % 2 == 0) factor = -factor;
    }
    if (e % 2 == 0) std::ranges::reverse(element.along);
    to.network.elements[e] = element;
    to.values.element[e] = original.values.element[elements[e]];
    to.values.second[e] = original.values.second[elements[e]];
  }
  for (std::size_t k = 0; k < excitations.size(); ++k) {
    Excitation excitation = network.excitations[excitations[k]];
    if (excitation.kind == ExcitationKind::force) excitation.node = place[excitation.node];
    to.network.excitations[k] = excitation;
    to.values.excitation[k] = original.values.excitation[excitations[k]];
  }
  return change;
}

// One element as two of half its value.
Change split(const Case& original, std::size_t element, const std::string& name) {
  Change change{name, original, {}};
  change.without = original.network.elements[element].name;
  Case& to = change.changed;
  to.values.element[element] *= 0.5;
  if (original.network.elements[element].type == ElementType::maxwell) to.values.second[element] *= 0.5;
  to.network.elements.push_back(to.network.elements[element]);
  to.network.elements.back().name = "half";
  to.values.element.push_back(to.values.element[element]);
  to.values.second.push_back(to.values.second[element]);
  return change;
}

void add_splits(const Case& original, std::vector<Change>& changes) {
  std::vector<std::size_t> linear, coulomb;
  for (std::size_t e = 0; e < original.network.elements.size(); ++e)
    (original.network.elements[e].type == ElementType::coulomb ? coulomb : linear).push_back(e);
  if (!linear.empty())
    changes.push_back(split(original, linear[original.seed % linear.size()], "split element"));
  if (!coulomb.empty())
    changes.push_back(split(original, coulomb[original.seed % coulomb.size()], "split contact"));
}

// The same excitation counted in periods so many times as long, or as short.
Change orders_multiplied(const Case& original) {
  int common = 0;
  for (const Excitation& excitation : original.network.excitations)
    common = std::gcd(common, excitation.order);
  common = std::gcd(common, original.network.reference_order);
  const int times = original.seed % 20 == 0 ? 30 : 2 + static_cast<int>(original.seed % 2);
  Change change{common > 1 ? "orders divided" : "orders multiplied", original, {}};
  const auto new_order = [&](int order) { return common > 1 ? order / common : order * times; };
  for (Excitation& excitation : change.changed.network.excitations)
    excitation.order = new_order(excitation.order);
  change.changed.network.reference_order = new_order(original.network.reference_order);
  change.periods = common > 1 ? 1.0 / common : times;
  change.changed.values.omega /= change.periods;
  return change;
}

// A mass that no force drives, behind a gear: q = ratio x the new coordinate, so that all act on it by a
// lever.
void add_geared(const Case& original, double ratio, std::vector<Change>& changes) {
  const Network& network = original.network;
  const std::size_t mass = original.seed % network.masses.size();
  const auto drives = [&](const Excitation& x) { return x.kind == ExcitationKind::force && x.node == mass; };
  if (std::ranges::any_of(network.excitations, drives)) return;
  Change change{"geared", original, {}};
  change.without = network.masses[mass];
  change.changed.values.mass[mass] *= ratio * ratio;
  for (Element& element : change.changed.network.elements) {
    for (auto& [node, factor] : element.along) {
      if (node == Node{NodeKind::mass, mass}) factor *= ratio;
    }
  }
  changes.push_back(std::move(change));
}

}  // namespace

std::vector<Change> changes_of(const Case& original) {
  std::vector<Change> changes{amplified(original, "amplified by 10", 10.0),
                              amplified(original, "amplified by 1e-5", 1e-5),
                              in_other_units(original, "unit of time 3.7", 1.0, 3.7, 1.0),
                              in_other_units(original, "unit of time 1e-3", 1.0, 1e-3, 1.0),
                              in_other_units(original, "unit of length 0.0254", 0.0254, 1.0, 1.0),
                              in_other_units(original, "unit of mass 0.4536", 1.0, 1.0, 0.45359237),
                              in_other_units(original, "unit of mass 1e6", 1.0, 1.0, 1e6),
                              mirrored(original),
                              shuffled(original),
                              later(original, 1.0),
                              later(original, 2.6),
                              orders_multiplied(original)};
  add_splits(original, changes);
  add_geared(original, -2.5, changes);
  return changes;
}

std::vector<Case> parts_of_excitation(const Case& original) {
  const Network& network = original.network;
  if (network.excitations.size() < 2) return {};
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    if (network.elements[e].type == ElementType::coulomb && original.values.element[e] != 0.0) return {};
  }
  std::vector<Case> parts(2, original);
  for (std::size_t k = 0; k < network.excitations.size(); ++k)
    parts[k == 0 ? 1 : 0].values.excitation[k].amplitude = 0.0;
  return parts;
}

}  // namespace frahm::invariants
