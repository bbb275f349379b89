#include "studies/page/profile_group.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "solvers/quantities/quantity.hpp"
#include "studies/provenance/result_variables.hpp"

namespace frahm::studies {
namespace {

using mechanics::Element, mechanics::Node, mechanics::NodeKind;

constexpr std::size_t none = static_cast<std::size_t>(-1);

bool is_mass(const Node& node, std::size_t mass) {
  return node.kind == NodeKind::mass && node.index == mass;
}

// Whether an element joins place n of the profile to the one below, the lowest to ground or to a support.
bool joins(const Element& element, const Profile& profile, std::size_t n) {
  const auto is_below = [&](const Node& node) {
    return n == 0 ? node.kind != NodeKind::mass && node.kind != NodeKind::joint
                  : is_mass(node, profile.masses[n - 1]);
  };
  const std::size_t mass = profile.masses[n];
  if (!mechanics::is_between_two_nodes(element.along)) return false;
  const Node &a = element.along[0].node, &b = element.along[1].node;
  return (is_mass(a, mass) && is_below(b)) || (is_mass(b, mass) && is_below(a));
}

// For each place the index of the first spring below it, or none.
std::vector<std::size_t> springs_below(const Study& study, const Profile& profile) {
  const auto& elements = study.network.elements;
  std::vector<std::size_t> springs;
  for (std::size_t n = 0; n < profile.masses.size(); ++n) {
    const auto found = std::ranges::find_if(elements, [&](const Element& element) {
      return element.type == mechanics::ElementType::spring && joins(element, profile, n);
    });
    springs.push_back(found == elements.end() ? none : static_cast<std::size_t>(found - elements.begin()));
  }
  return springs;
}

}  // namespace

results::GroupContent profile_group(const Study& study, const Profile& profile) {
  const mechanics::Network& network = study.network;
  std::vector<std::string> masses, springs, owners = network.masses;
  for (const std::size_t mass : profile.masses) masses.push_back(network.masses[mass]);
  for (const std::size_t spring : springs_below(study, profile))
    springs.push_back(spring == none ? "" : network.elements[spring].name);
  for (const Element& element : network.elements) {
    if (element.parts > 0) owners.push_back(element.name);
  }
  const auto list = [](const std::vector<std::string>& names) {
    return fmt::format("{}", fmt::join(names, ","));
  };
  results::GroupContent group{
      .path = "page/profile",
      .texts = {{"masses", list(masses)}, {"springs", list(springs)}, {"owners", list(owners)}}};
  if (!profile.position)
    group.texts.emplace_back(
        "hint", "all masses in the order of the study, absorbers too; [report] profile names the storeys");
  if (!profile.height.empty())
    group.columns.push_back({.variable = variable("height", study.dimensionless ? "1" : "m"),
                             .dimension = "place",
                             .values = profile.height});
  return group;
}

std::vector<std::string> profile_quantities(const Study& study, const Profile& profile,
                                            const std::vector<results::Variable>& recorded) {
  std::vector<std::string> names;
  const auto add = [&](periodic::Measure measure, std::size_t index) {
    const std::string name = periodic::describe({measure, index}, study.network, study.dimensionless).name;
    if (std::ranges::find(recorded, name, &results::Variable::name) != recorded.end()) names.push_back(name);
  };
  for (const std::size_t mass : profile.masses) add(periodic::Measure::peak, mass);
  for (const std::size_t spring : springs_below(study, profile))
    if (spring != none) add(periodic::Measure::stroke, spring);
  return names;
}

}  // namespace frahm::studies
