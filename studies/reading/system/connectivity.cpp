#include "studies/reading/system/connectivity.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <numeric>

#include "solvers/algebra/null_space.hpp"
#include "solvers/mechanics/bends.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "studies/reading/study/characteristic.hpp"
#include "studies/reading/study/study_values.hpp"
#include "studies/reading/text/spelling.hpp"

namespace frahm::studies {
namespace {

constexpr const char* motions_need_no_spring =
    " (a decay, a transient and a sweep or tuning of exact laws may have free masses)";
constexpr const char* joints_need_springs =
    " (beside a joint, a mass of zero, only a decay and a transient may have free masses; a spring and a "
    "damper that meet at a joint are one maxwell)";

constexpr const char* stops_need_springs =
    " (beside a stop, a play or a table of a spring only a decay and a transient may have free masses)";

const char* where_free(const mechanics::Network& network) {
  if (!network.joints.empty()) return joints_need_springs;
  return mechanics::has_stop(network) ? stops_need_springs : motions_need_no_spring;
}

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

// Whether the element holds masses in position; not with a stiffness of 0.
bool holds(const mechanics::Element& element, const StudyValues& values, std::size_t index) {
  if (values.characteristic[index].kind == StudyCharacteristic::Kind::table)
    return mechanics::kind_of(element).holds;
  const StudyValue& stiffness = values.value(index);
  const bool absent =
      stiffness.expression.is_constant() && stiffness.expression.evaluate(std::span<const double>{}) == 0.0;
  return mechanics::kind_of(element).holds && !absent;
}

// The rows of the stiffness matrices of parts, over all masses.
void add_rows_of_matrices(const mechanics::Network& network, std::vector<Eigen::VectorXd>& rows) {
  for (const mechanics::MatrixPart& part : network.matrices) {
    for (Eigen::Index i = 0; i < part.stiffness.rows(); ++i) {
      Eigen::VectorXd row =
          Eigen::VectorXd::Zero(static_cast<Eigen::Index>(network.masses.size() + network.joints.size()));
      for (std::size_t j = 0; j < part.nodes.size(); ++j)
        row[static_cast<Eigen::Index>(part.nodes[j])] = part.stiffness(i, static_cast<Eigen::Index>(j));
      if (!row.isZero(0.0)) rows.push_back(std::move(row));
    }
  }
}

}  // namespace

void check_masses_are_held(const StudyContext& context, const NetworkOfStudy& system,
                           const std::vector<Position>& masses, StudyKind kind) {
  if (!context.is_whole || free_masses(kind, system.network) == mechanics::FreeMasses::allowed) return;
  const auto& network = system.network;
  const std::size_t masses_alone = network.masses.size();
  const std::size_t held = masses_alone + network.joints.size();
  const auto set_of = [&](const mechanics::Node& node) {
    return node.kind == mechanics::NodeKind::mass    ? node.index
           : node.kind == mechanics::NodeKind::joint ? masses_alone + node.index
                                                     : held;
  };
  Union sets(held + 1);
  for (std::size_t i = 0; i < network.elements.size(); ++i) {
    const auto& element = network.elements[i];
    if (!holds(element, system.values, i)) continue;
    for (const auto& [node, factor] : element.along) sets.join(set_of(node), set_of(element.along[0].node));
    // What a lever holds depends on its factors: check_combinations_are_held().
    if (!mechanics::is_between_two_nodes(element.along)) sets.join(held, set_of(element.along[0].node));
  }
  // Whether matrices hold their nodes, the check of the whole stiffness matrix tells.
  for (const mechanics::MatrixPart& part : network.matrices) {
    for (const std::size_t node : part.nodes) sets.join(node, held);
  }
  for (std::size_t i = 0; i < masses_alone; ++i) {
    if (sets.root(i) == sets.root(held)) continue;
    std::vector<std::string> floating;
    for (std::size_t j = i; j < masses_alone; ++j) {
      if (sets.root(j) == sets.root(i)) floating.push_back(fmt::format("\"{}\"", network.masses[j]));
    }
    throw context.source.error_at(
        rules::floating_mass, masses[i],
        "{} {} float{} free: no chain of springs leads to ground or to a node of prescribed motion, so the "
        "stiffness matrix is not positive definite; add a weak spring to ground, with a frequency far below "
        "those of interest, to hold {}{}",
        floating.size() == 1 ? "mass" : "the masses", listed(floating, " and "),
        floating.size() == 1 ? "s" : "", floating.size() == 1 ? "it" : "them", where_free(network));
  }
}

// Motions q of the masses that strain no spring, w^T q = 0, and no part given by matrices, K q = 0.
void check_combinations_are_held(const Study& study) {
  if (free_masses(study.kind(), study.network) == mechanics::FreeMasses::allowed) return;
  const mechanics::Network& network = study.network;
  const auto nodes = static_cast<Eigen::Index>(network.masses.size() + network.joints.size());
  std::vector<Eigen::VectorXd> springs;
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    if (!holds(network.elements[e], study.values, e)) continue;
    const mechanics::Incidence at = mechanics::incidence(network, network.elements[e]);
    springs.emplace_back(nodes) << at.w, at.j;
  }
  add_rows_of_matrices(network, springs);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(springs.size()), nodes);
  for (std::size_t i = 0; i < springs.size(); ++i)
    A.row(static_cast<Eigen::Index>(i)) = springs[i].normalized();
  const Eigen::MatrixXd free = algebra::null_space(A);
  if (free.cols() == 0) return;
  constexpr double rounding = 1e-9;
  std::vector<std::size_t> floating;
  for (std::size_t i = 0; i < network.masses.size(); ++i)
    if (free.row(static_cast<Eigen::Index>(i)).norm() >= rounding) floating.push_back(i);
  std::vector<std::string> names;
  for (const std::size_t i : floating) names.push_back(fmt::format("\"{}\"", network.masses[i]));
  const StudyValue& first = study.values.mass[floating.front()];
  throw study.source.error_at(
      rules::floating_mass, first.position,
      "{}: {} can move together without straining any spring, so the stiffness matrix is not positive "
      "definite; each needs one more spring, which may be weak, with a frequency far below those of "
      "interest{}",
      first.where, listed(names, " and "), where_free(network));
}

}  // namespace frahm::studies
