#pragma once

#include <vector>

#include "solvers/algebra/shortest_solution.hpp"
#include "solvers/flow/equations.hpp"

namespace frahm::periodic {

// Directions d along which forces may jump at one instant, of contacts and of bends, in groups that do not
// feel one another: d_i^T M^-1 d_k = 0 for i and k of different groups, so that a jump of the forces of one
// group accelerates nothing of the other.
template <int N, int H>
class CoupledGroups {
 public:
  using Vector = typename Sizes<N, H>::Vector;

  CoupledGroups(const StepEquations<N, H>& eq, ContactMask contacts, ContactMask bends);

  std::size_t count() const { return groups_.size(); }
  ContactMask contacts(std::size_t group) const { return groups_[group].contacts; }
  ContactMask bends(std::size_t group) const { return groups_[group].bends; }
  // The part that the group's forces have in the accelerations `a`, which are due to all groups' forces.
  Vector part(std::size_t group, const Vector& a) const;

 private:
  struct Group {
    ContactMask contacts = 0, bends = 0;
    std::vector<Eigen::Index> columns;
  };

  Eigen::MatrixXd D_, MD_, G_;  // directions (n x number), M^-1 D, D^T M^-1 D
  std::vector<Group> groups_;
};

template <int N, int H>
CoupledGroups<N, H>::CoupledGroups(const StepEquations<N, H>& eq, ContactMask contacts, ContactMask bends) {
  constexpr double kRounding = 1e-12;
  const std::vector<Eigen::Index> of_contacts = list_of(contacts), of_bends = list_of(bends);
  const auto first_bend = static_cast<Eigen::Index>(of_contacts.size());
  const Eigen::Index size = first_bend + static_cast<Eigen::Index>(of_bends.size());
  D_.resize(eq.masses(), size);
  MD_.resize(eq.masses(), size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const bool is_bend = i >= first_bend;
    const auto j = is_bend ? of_bends[static_cast<std::size_t>(i - first_bend)]
                           : of_contacts[static_cast<std::size_t>(i)];
    if (is_bend)
      D_.col(i) = eq.bends.B.col(j);
    else
      D_.col(i) = eq.W.col(j);
    MD_.col(i).noalias() = eq.M_inverse * D_.col(i);
  }
  G_.noalias() = D_.transpose() * MD_;
  std::vector<bool> has_group(static_cast<std::size_t>(size), false);
  const auto join = [&](Eigen::Index i, Group& group) {
    has_group[static_cast<std::size_t>(i)] = true;
    group.columns.push_back(i);
    if (i < first_bend)
      group.contacts |= bit(of_contacts[static_cast<std::size_t>(i)]);
    else
      group.bends |= bit(of_bends[static_cast<std::size_t>(i - first_bend)]);
  };
  for (Eigen::Index start = 0; start < size; ++start) {
    if (has_group[static_cast<std::size_t>(start)]) continue;
    Group& group = groups_.emplace_back();
    join(start, group);
    for (std::size_t known = 0; known < group.columns.size(); ++known) {
      const Eigen::Index i = group.columns[known];
      for (Eigen::Index k = 0; k < size; ++k) {
        const bool feels = std::abs(G_(i, k)) > kRounding * std::sqrt(G_(i, i) * G_(k, k));
        if (feels && !has_group[static_cast<std::size_t>(k)]) join(k, group);
      }
    }
  }
}

// a = sum_i M^-1 d_i phi_i:  the group's phi are those of D^T M^-1 D phi = D^T a, as no other group's force
// has a part in D^T a.
template <int N, int H>
typename CoupledGroups<N, H>::Vector CoupledGroups<N, H>::part(std::size_t group, const Vector& a) const {
  if (groups_.size() == 1) return a;
  const std::vector<Eigen::Index>& its = groups_[group].columns;
  const Eigen::MatrixXd G = G_(its, its);
  const Eigen::VectorXd phi = algebra::shortest_solution(G, D_(Eigen::all, its).transpose() * a);
  return MD_(Eigen::all, its) * phi;
}

}  // namespace frahm::periodic
