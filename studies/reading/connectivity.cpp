#include <fmt/format.h>

#include <numeric>

#include "solvers/mechanics/element_table.hpp"
#include "studies/reading/spelling.hpp"
#include "studies/reading/study_reading.hpp"

namespace frahm::studies {
namespace {

// Sets of masses joined by springs; the last set holds what is fixed or moved from outside.
class Union {
 public:
  explicit Union(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t i, std::size_t j) { parent_[root(i)] = root(j); }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace

void check_masses_are_held(const StudyContext& context, const NetworkOfStudy& system,
                           const std::vector<Position>& masses) {
  const auto& network = system.network;
  const std::size_t held = network.masses.size();
  const auto set_of = [&](const mechanics::Node& node) {
    return node.kind == mechanics::NodeKind::mass ? node.index : held;
  };
  Union sets(held + 1);
  for (std::size_t i = 0; i < network.elements.size(); ++i) {
    const auto& element = network.elements[i];
    const Expression& stiffness = system.values.element[i].expression;
    const bool absent = stiffness.is_constant() && stiffness.evaluate(std::span<const double>{}) == 0.0;
    if (mechanics::kind_of(element).holds && !absent) sets.join(set_of(element.a), set_of(element.b));
  }
  // Whether matrices hold their nodes, the check of the whole stiffness matrix tells.
  for (const mechanics::MatrixPart& part : network.matrices) {
    for (const std::size_t node : part.nodes) sets.join(node, held);
  }
  for (std::size_t i = 0; i < held; ++i) {
    if (sets.root(i) == sets.root(held)) continue;
    std::vector<std::string> floating;
    for (std::size_t j = i; j < held; ++j) {
      if (sets.root(j) == sets.root(i)) floating.push_back(fmt::format("\"{}\"", network.masses[j]));
    }
    throw context.source.error_at(
        rules::floating_mass, masses[i],
        "{} {} float{} free: no chain of springs leads to ground or to a node of prescribed "
        "motion, so the stiffness matrix is not positive definite",
        floating.size() == 1 ? "mass" : "the masses", listed(floating, " and "),
        floating.size() == 1 ? "s" : "");
  }
}

}  // namespace frahm::studies
