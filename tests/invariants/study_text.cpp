#include "tests/invariants/study_text.hpp"

#include <fmt/format.h>

namespace frahm::invariants {
namespace {

using namespace mechanics;

struct Keys {
  const char* type;
  const char* first;
  const char* second;  // nullptr: none
};

Keys keys_of(ElementType type) {
  switch (type) {
    case ElementType::spring:
      return {"spring", "stiffness", nullptr};
    case ElementType::damper:
      return {"damper", "damping", nullptr};
    case ElementType::inerter:
      return {"inerter", "inertance", nullptr};
    case ElementType::coulomb:
      return {"coulomb", "force", nullptr};
    case ElementType::hysteretic:
      return {"hysteretic", "stiffness", "loss_factor"};
    case ElementType::maxwell:
      return {"maxwell", "stiffness", "damping"};
    case ElementType::jenkins:
      return {"jenkins", "stiffness", "force"};
    case ElementType::gap:
      return {"gap", "stiffness", "damping"};
  }
  return {"", "", nullptr};
}

// TOML wants a point or an exponent in a number with a fraction: {:#} keeps the point.
std::string number(double x) {
  return fmt::format("{:#}", x);
}

std::string direction_text(const Network& network, const Direction& along) {
  if (is_between_two_nodes(along))
    return fmt::format("between = [\"{}\", \"{}\"]", node_name(network, along[0].node),
                       node_name(network, along[1].node));
  std::string shares;
  for (const auto& [node, factor] : along)
    shares += fmt::format("{}{} = {}", shares.empty() ? "" : ", ", node_name(network, node), number(factor));
  return fmt::format("along = {{ {} }}", shares);
}

std::string element_text(const Case& c, std::size_t e) {
  const Element& element = c.network.elements[e];
  const Keys keys = keys_of(element.type);
  std::string text =
      fmt::format("[[element]]\nname = \"{}\"\ntype = \"{}\"\n{}\n{} = {}\n", element.name, keys.type,
                  direction_text(c.network, element.along), keys.first, number(c.values.element[e]));
  if (element.type == ElementType::gap)
    text += fmt::format("clearance = {}\n", number(c.values.bends[e].front().place));
  if (keys.second != nullptr) text += fmt::format("{} = {}\n", keys.second, number(c.values.second[e]));
  return text;
}

std::string excitation_text(const Case& c, std::size_t k) {
  const Excitation& excitation = c.network.excitations[k];
  const bool is_force = excitation.kind == ExcitationKind::force;
  const std::string& node = (is_force ? c.network.masses : c.network.prescribed)[excitation.node];
  return fmt::format("[[excitation.{}]]\n{} = \"{}\"\namplitude = {}\norder = {}\nphase = {}\n",
                     is_force ? "force" : "motion", is_force ? "on" : "node", node,
                     number(c.values.excitation[k].amplitude), excitation.order,
                     number(c.values.excitation[k].phase));
}

}  // namespace

std::string study_text(const Case& c, const std::string& title) {
  std::string text = fmt::format(
      "[study]\nschema = 1\nkind = \"sweep\"\ntitle = \"{}\"\nunits = \"dimensionless\"\n[parameters]\nomega "
      "= {}\n",
      title, number(c.values.omega));
  for (std::size_t i = 0; i < c.network.masses.size(); ++i)
    text +=
        fmt::format("[[mass]]\nname = \"{}\"\nmass = {}\n", c.network.masses[i], number(c.values.mass[i]));
  for (std::size_t e = 0; e < c.network.elements.size(); ++e) text += element_text(c, e);
  text +=
      fmt::format("[excitation]\nfrequency = \"omega\"\nreference_order = {}\n", c.network.reference_order);
  for (std::size_t k = 0; k < c.network.excitations.size(); ++k) text += excitation_text(c, k);
  return text +
         fmt::format("[[axis]]\nparameter = \"omega\"\nvalues = [{}]\n[output]\nquantities = \"all\"\n",
                     number(c.values.omega));
}

}  // namespace frahm::invariants
