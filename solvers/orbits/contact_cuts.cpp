#include "solvers/orbits/contact_cuts.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/algebra/null_space.hpp"

namespace frahm::periodic {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using Contacts = std::vector<Index>;

constexpr double kNoPart = 1e-9;  // of a largest entry of 1: rounding

// The contacts of each set that loops connect; loops: those of one basis, in columns.
std::vector<Contacts> connected_sets(const MatrixXd& loops) {
  const Index m = loops.rows();
  Eigen::VectorXi set = Eigen::VectorXi::LinSpaced(static_cast<int>(m), 0, static_cast<int>(m) - 1);
  for (const auto& loop : loops.colwise()) {
    Index first = 0;
    const double rounding = kNoPart * loop.cwiseAbs().maxCoeff(&first);
    for (Index j = 0; j < m; ++j) {
      if (std::abs(loop[j]) <= rounding) continue;
      const int merged = set[j], into = set[first];
      set = (set.array() == merged).select(into, set);
    }
  }
  std::vector<Contacts> sets;
  for (int name = 0; name < m; ++name) {
    Contacts contacts;
    for (Index j = 0; j < m; ++j) {
      if (set[j] == name) contacts.push_back(j);
    }
    if (contacts.size() > 1) sets.push_back(contacts);
  }
  return sets;
}

// In how many ways `chosen` of `all` can be chosen.
double ways(std::size_t all, std::size_t chosen) {
  double result = 1.0;
  for (std::size_t i = 0; i < chosen; ++i)
    result *= static_cast<double>(all - i) / static_cast<double>(i + 1);
  return result;
}

// The cut that leaves these rows of `forms` zero; none if that is not one cut. forms: a basis of all W^T n.
std::optional<VectorXd> cut_beside(const Contacts& rows, const MatrixXd& forms) {
  const MatrixXd n = algebra::null_space(MatrixXd(forms(rows, Eigen::all)));
  if (n.cols() != 1) return std::nullopt;
  VectorXd c = forms * n;
  Index largest = 0;
  c.cwiseAbs().maxCoeff(&largest);
  c /= c[largest];
  c = (c.array().abs() > kNoPart).select(c, 0.0);
  return c;
}

bool is_among(const VectorXd& c, const std::vector<VectorXd>& cuts) {
  return std::ranges::any_of(cuts, [&](const VectorXd& other) {
    return std::min((c - other).norm(), (c + other).norm()) < kNoPart;
  });
}

// The cuts of one connected set: each leaves as many contacts as determine it without force.
std::vector<VectorXd> cuts_of_set(const MatrixXd& forms) {
  const auto m = static_cast<std::size_t>(forms.rows()), d = static_cast<std::size_t>(forms.cols());
  std::vector<VectorXd> cuts;
  std::vector<bool> is_left(m, false);
  std::fill_n(is_left.begin(), d - 1, true);
  do {
    Contacts left;
    for (std::size_t i = 0; i < m; ++i) {
      if (is_left[i]) left.push_back(static_cast<Index>(i));
    }
    const std::optional<VectorXd> c = cut_beside(left, forms);
    if (c && !is_among(*c, cuts)) cuts.push_back(*c);
  } while (std::prev_permutation(is_left.begin(), is_left.end()));
  return cuts;
}

}  // namespace

std::optional<std::vector<VectorXd>> contact_cuts(const MatrixXd& W) {
  constexpr double kMost = 5000;  // choices to look at
  const Index m = W.cols();
  const MatrixXd loops = algebra::null_space(W);
  const std::vector<Contacts> sets = connected_sets(loops);
  std::vector<VectorXd> cuts;
  Eigen::Array<bool, Eigen::Dynamic, 1> outside = Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(m, true);
  for (const Contacts& set : sets) outside(set) = false;
  for (Index j = 0; j < m; ++j) {
    if (outside[j] && !W.col(j).isZero(0.0)) cuts.emplace_back(VectorXd::Unit(m, j));
  }
  for (const Contacts& set : sets) {
    // All W^T n of these contacts are those at right angles to their loops.
    const MatrixXd forms = algebra::null_space(loops(set, Eigen::all).transpose());
    if (ways(set.size(), static_cast<std::size_t>(forms.cols()) - 1) > kMost) return std::nullopt;
    for (const VectorXd& of_set : cuts_of_set(forms)) {
      VectorXd c = VectorXd::Zero(m);
      c(set) = of_set;
      cuts.push_back(std::move(c));
    }
  }
  return cuts;
}

}  // namespace frahm::periodic
