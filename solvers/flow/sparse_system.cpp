#include "solvers/flow/sparse_system.hpp"

#include <algorithm>
#include <array>

#include "solvers/flow/side_by_side.hpp"
#include "solvers/flow/sizes.hpp"

namespace frahm::periodic {
namespace {

std::vector<SparseRows::Diagonal> occupied_diagonals(const Eigen::MatrixXd& matrix) {
  std::vector<SparseRows::Diagonal> diagonals;
  const Eigen::Index n = matrix.rows();
  for (Eigen::Index offset = 1 - n; offset < n; ++offset) {
    const Eigen::VectorXd values = matrix.diagonal(offset);
    if (!values.isZero(0.0))
      diagonals.push_back({.offset = static_cast<int>(offset),
                           .value = {values.begin(), values.end()},
                           .first = static_cast<int>(std::max<Eigen::Index>(0, -offset))});
  }
  return diagonals;
}

bool has_three_diagonals(const SparseRows& A) {
  return A.diagonals.size() == 3 && A.diagonals[0].offset == -1 && A.diagonals[1].offset == 0 &&
         A.diagonals[2].offset == 1;
}

RowsOf<float> in_single_precision(const SparseRows& rows) {
  RowsOf<float> result{.start = rows.start,
                       .column = rows.column,
                       .value = {rows.value.begin(), rows.value.end()},
                       .full = rows.full.cast<float>(),
                       .diagonals = {}};
  for (const SparseRows::Diagonal& d : rows.diagonals)
    result.diagonals.push_back(
        {.offset = d.offset, .value = {d.value.begin(), d.value.end()}, .first = d.first});
  return result;
}

}  // namespace

SparseRows rows_alone(const Eigen::MatrixXd& matrix) {
  SparseRows rows;
  rows.start.push_back(0);
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      if (matrix(i, j) == 0.0) continue;
      rows.column.push_back(static_cast<int>(j));
      rows.value.push_back(matrix(i, j));
    }
    rows.start.push_back(static_cast<int>(rows.column.size()));
  }
  return rows;
}

SparseRows sparse_rows(const Eigen::MatrixXd& matrix) {
  constexpr double kFull = 0.4;  // of all entries: from there on whole columns take less time
  SparseRows rows = rows_alone(matrix);
  constexpr std::size_t kFewer = 3;  // numbers of a diagonal take as long as an entry by its row
  const bool is_full = static_cast<double>(rows.value.size()) > kFull * static_cast<double>(matrix.size());
  if (matrix.rows() == matrix.cols()) rows.diagonals = occupied_diagonals(matrix);
  if (rows.diagonals.size() * rows.start.size() > kFewer * rows.value.size()) rows.diagonals.clear();
  if (is_full) {
    rows.full = matrix;
    rows.diagonals.clear();
  }
  return rows;
}

SparseSystem sparse_system(const Eigen::MatrixXd& M_inverse, const Eigen::MatrixXd& K,
                           const Eigen::MatrixXd& C, const Eigen::MatrixXd& D, const Eigen::MatrixXd& W,
                           const Eigen::VectorXd& rate) {
  const Eigen::MatrixXd MW = M_inverse * W;
  SparseSystem system{.stiffness = sparse_rows(M_inverse * K),
                      .damping = sparse_rows(M_inverse * C),
                      .internal = sparse_rows(M_inverse * D),
                      .contacts = sparse_rows(MW),
                      .directions = sparse_rows(W.transpose()),
                      .stretch = sparse_rows(D.transpose()),
                      .contact_stiffness = rows_alone(MW.transpose() * K),
                      .contact_damping = rows_alone(MW.transpose() * C),
                      .contact_internal = rows_alone(MW.transpose() * D),
                      .bend_directions = {},
                      .bend_pull = {},
                      .internal_rate = rate};
  system.is_chain = has_three_diagonals(system.stiffness) && has_three_diagonals(system.damping);
  return system;
}

SystemOf<float> in_single_precision(const SparseSystem& system) {
  return {.stiffness = in_single_precision(system.stiffness),
          .damping = in_single_precision(system.damping),
          .internal = in_single_precision(system.internal),
          .contacts = in_single_precision(system.contacts),
          .directions = in_single_precision(system.directions),
          .stretch = in_single_precision(system.stretch),
          .contact_stiffness = {},
          .contact_damping = {},
          .contact_internal = {},
          .bend_directions = in_single_precision(system.bend_directions),
          .bend_pull = in_single_precision(system.bend_pull),
          .internal_rate = system.internal_rate.cast<float>(),
          .is_chain = system.is_chain};
}

HeldOf<float> in_single_precision(const HeldContacts& held) {
  HeldOf<float> rough{.list = held.list,
                      .force = in_single_precision(held.force),
                      .hold_all = held.hold_all,
                      .spring = held.spring.cast<float>(),
                      .beyond = {}};
  for (const BeyondBend<double>& bend : held.beyond)
    rough.beyond.push_back(
        {bend.index, static_cast<float>(bend.stiffness), static_cast<float>(bend.damping)});
  return rough;
}

Eigen::VectorXd forces_of(const HeldContacts& held, const Eigen::VectorXd& c) {
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(c.size());
  for (std::size_t j = 0; j < held.list.size(); ++j) {
    for_each_entry(held.force, static_cast<int>(j), [&](int k, double value) {
      forces[held.list[j]] += value * c[held.list[static_cast<std::size_t>(k)]];
    });
  }
  return forces;
}

void keep(const SparseSystem& system, const HeldContacts& held, const double* support, double* a) {
  std::array<double, 2 * kMostContacts + 1> work;  // NOLINT(*-member-init): written before it is read
  if (held.hold_all) std::fill_n(a, system.masses(), 0.0);
  keep_numbers(system, held, support, work.data(), a);
}

void pull(const SparseSystem& system, const HeldContacts& held, const double* q, const double* v,
          const double* s, double* a, double* ds) {
  std::array<double, 2 * kMostContacts + 1> work;  // NOLINT(*-member-init): written before it is read
  pull_numbers(system, held, q, v, s, work.data(), a, ds);
}

}  // namespace frahm::periodic
