#include "solvers/flow/sparse_system.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "solvers/flow/polynomial.hpp"
#include "solvers/flow/sizes.hpp"

namespace frahm::periodic {
namespace {

// Motions are moved four at a time: a register of x86-64-v3, or two of less.
constexpr int kColumns = 4;
using Four = double __attribute__((vector_size(kColumns * sizeof(double))));

// (A x)_i of one motion (double) or of four side by side.
template <class Number>
[[gnu::always_inline]] inline Number row_times(const SparseRows& A, std::size_t i, const Number* x) {
  Number sum{};
  for (int e = A.start[i]; e < A.start[i + 1]; ++e)
    sum += A.value[static_cast<std::size_t>(e)] * x[A.column[static_cast<std::size_t>(e)]];
  return sum;
}

// a -= row i of A x factor
template <class Number>
[[gnu::always_inline]] inline void subtract_row(const SparseRows& A, std::size_t i, Number factor,
                                                Number* a) {
  for (int e = A.start[i]; e < A.start[i + 1]; ++e)
    a[A.column[static_cast<std::size_t>(e)]] -= A.value[static_cast<std::size_t>(e)] * factor;
}

// a -= A x
template <class Number>
[[gnu::always_inline]] inline void subtract_product(const SparseRows& A, const Number* x, Number* a) {
  const std::size_t n = A.start.size() - 1;
  if (!A.diagonals.empty()) {
    for (const SparseRows::Diagonal& d : A.diagonals) {
      const double* value = d.value.data();
      const Number* from = x + d.first + d.offset;
      Number* to = a + d.first;
      for (std::size_t i = 0; i < d.value.size(); ++i) to[i] -= value[i] * from[i];
    }
  } else if (A.full.size() > 0) {
    const double* column = A.full.data();
    for (Eigen::Index j = 0; j < A.full.cols(); ++j, column += n) {
      for (std::size_t i = 0; i < n; ++i) a[i] -= column[i] * x[j];
    }
  } else {
    for (std::size_t i = 0; i < n; ++i) a[i] -= row_times(A, i, x);
  }
}

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

// a -= M^-1 W lambda,  lambda = G^-1 W^T a
template <class Number>
[[gnu::always_inline]] inline void keep_numbers(const SparseSystem& system, const HeldContacts& held,
                                                Number* work, Number* a) {
  if (held.list.empty()) return;
  const auto n = static_cast<std::size_t>(system.masses());
  if (held.hold_all) {
    std::fill_n(a, n, Number{});
    return;
  }
  const std::size_t m = held.list.size();
  Number* slip = work;
  Number* lambda = work + m;  // of every contact: zero where it is not held
  std::fill_n(lambda, system.mobility.rows(), Number{});
  for (std::size_t j = 0; j < m; ++j)
    slip[j] = row_times(system.directions, static_cast<std::size_t>(held.list[j]), a);
  for (std::size_t j = 0; j < m; ++j) lambda[held.list[j]] = row_times(held.force, j, slip);
  subtract_product(system.contacts, lambda, a);
}

template <class Number>
[[gnu::always_inline]] inline void pull_numbers(const SparseSystem& system, const HeldContacts& held,
                                                const Number* q, const Number* v, const Number* s,
                                                Number* work, Number* a, Number* ds) {
  const auto n = static_cast<std::size_t>(system.masses());
  const auto internal = static_cast<std::size_t>(system.internal_forces());
  std::fill_n(a, n, Number{});
  subtract_product(system.stiffness, q, a);
  subtract_product(system.damping, v, a);
  if (internal > 0) subtract_product(system.internal, s, a);
  for (const BeyondBend& bend : held.beyond) {
    const auto j = static_cast<std::size_t>(bend.index);
    const Number force = bend.stiffness * row_times(system.bend_directions, j, q) +
                         bend.damping * row_times(system.bend_directions, j, v);
    subtract_row(system.bend_pull, j, force, a);
  }
  for (std::size_t i = 0; i < internal; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    ds[i] = held.spring[row] * row_times(system.stretch, i, v) - system.internal_rate[row] * s[i];
  }
  keep_numbers(system, held, work, a);
}

std::size_t work_size(const SparseSystem& system) {
  return static_cast<std::size_t>(2 * system.mobility.rows() + 1);
}

// The number of terms after which a Taylor series in steps of this rate has ended: rate^k / k! < 1e-15.
int terms_of(double rate) {
  int terms = 1;
  for (double term = 1.0; term > 1e-15; ++terms) term *= rate / terms;
  return terms;
}

// One step of length h of four motions x = (q, v, s) side by side: x(h) = sum_k h^k x_k.
void take_long_step(const SparseSystem& system, const HeldContacts& held, double h, int terms, Four* x,
                    Four* term, Four* next, Four* work) {
  const auto n = static_cast<std::size_t>(system.masses());
  const std::size_t size = 2 * n + static_cast<std::size_t>(system.internal_forces());
  std::copy_n(x, size, term);
  for (int k = 1; k < terms; ++k) {
    const Four* v = term + n;
    pull_numbers(system, held, term, v, v + n, work, next + n, next + 2 * n);
    std::copy_n(v, n, next);
    const double share = h / k;
    for (std::size_t i = 0; i < size; ++i) {
      term[i] = share * next[i];
      x[i] += term[i];
    }
  }
}

}  // namespace

SparseRows SparseRows::rows_of(const Eigen::MatrixXd& matrix) {
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

SparseRows SparseRows::of(const Eigen::MatrixXd& matrix) {
  SparseRows rows = rows_of(matrix);
  constexpr double kFull = 0.4;      // of all entries: from there on whole columns take less time
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

void SparseRows::add_row(int i, double scale, double* sum) const {
  const auto row = static_cast<std::size_t>(i);
  for (int e = start[row]; e < start[row + 1]; ++e)
    sum[column[static_cast<std::size_t>(e)]] += scale * value[static_cast<std::size_t>(e)];
}

void SparseSystem::set(const Eigen::MatrixXd& M_inverse, const Eigen::MatrixXd& K, const Eigen::MatrixXd& C,
                       const Eigen::MatrixXd& D, const Eigen::MatrixXd& W, const Eigen::VectorXd& rate) {
  const Eigen::MatrixXd MW = M_inverse * W;
  stiffness = SparseRows::of(M_inverse * K);
  damping = SparseRows::of(M_inverse * C);
  internal = SparseRows::of(M_inverse * D);
  contacts = SparseRows::of(MW);
  directions = SparseRows::of(W.transpose());
  stretch = SparseRows::of(D.transpose());
  pull_by_displacement = SparseRows::of(MW.transpose() * K);
  pull_by_velocity = SparseRows::of(MW.transpose() * C);
  mobility = W.transpose() * MW;
  internal_rate = rate;
}

void keep(const SparseSystem& system, const HeldContacts& held, double* a) {
  std::vector<double> work(work_size(system));
  keep_numbers(system, held, work.data(), a);
}

void pull(const SparseSystem& system, const HeldContacts& held, const double* q, const double* v,
          const double* s, double* a, double* ds) {
  std::array<double, 2 * kMostContacts + 1> work;
  pull_numbers(system, held, q, v, s, work.data(), a, ds);
}

void propagate(const SparseSystem& system, const HeldContacts& held, double steps, Eigen::MatrixXd& states) {
  constexpr double kMostRate = 3.0;  // a step: its series adds e^3 of rounding at most
  const double pieces = std::max(1.0, std::ceil(steps * kStepRate / kMostRate));
  const double h = steps / pieces;
  const int terms = terms_of(h * kStepRate);
  const Eigen::Index size = states.rows(), columns = states.cols();
  std::vector<Four> x(static_cast<std::size_t>(size)), term(x), next(x), work(work_size(system));
  for (Eigen::Index first = 0; first < columns; first += kColumns) {
    const Eigen::Index count = std::min<Eigen::Index>(kColumns, columns - first);
    std::fill(x.begin(), x.end(), Four{});
    for (Eigen::Index c = 0; c < count; ++c) {
      for (Eigen::Index i = 0; i < size; ++i) x[static_cast<std::size_t>(i)][c] = states(i, first + c);
    }
    for (double piece = 0.0; piece < pieces; piece += 1.0)
      take_long_step(system, held, h, terms, x.data(), term.data(), next.data(), work.data());
    for (Eigen::Index c = 0; c < count; ++c) {
      for (Eigen::Index i = 0; i < size; ++i) states(i, first + c) = x[static_cast<std::size_t>(i)][c];
    }
  }
}

}  // namespace frahm::periodic
