#pragma once

#include <algorithm>

#include "solvers/flow/sparse_system.hpp"

// The products of a large system with one motion (Number = Real), or with several side by side (Number = a
// register of them), for the files whose inner loops they are.
namespace frahm::periodic {

// (A x)_i
template <class Real, class Number>
[[gnu::always_inline]] inline Number row_times(const RowsOf<Real>& A, std::size_t i, const Number* x) {
  Number sum{};
  for (int e = A.start[i]; e < A.start[i + 1]; ++e)
    sum += A.value[static_cast<std::size_t>(e)] * x[A.column[static_cast<std::size_t>(e)]];
  return sum;
}

// a -= row i of A x factor
template <class Real, class Number>
[[gnu::always_inline]] inline void subtract_row(const RowsOf<Real>& A, std::size_t i, Number factor,
                                                Number* a) {
  for (int e = A.start[i]; e < A.start[i + 1]; ++e)
    a[A.column[static_cast<std::size_t>(e)]] -= A.value[static_cast<std::size_t>(e)] * factor;
}

// a_i -= (A x)_i by one diagonal, for the rows from `begin` to `end` that it has.
template <class Diagonal, class Number>
[[gnu::always_inline]] inline void subtract_diagonal(const Diagonal& d, int begin, int end, const Number* x,
                                                     Number* a) {
  begin = std::max(begin, d.first);
  end = std::min(end, d.end());
  for (int i = begin; i < end; ++i) a[i] -= d.value[static_cast<std::size_t>(i - d.first)] * x[i + d.offset];
}

// a -= A x
template <class Real, class Number>
[[gnu::always_inline]] inline void subtract_product(const RowsOf<Real>& A, const Number* x, Number* a) {
  const std::size_t n = A.start.size() - 1;
  if (!A.diagonals.empty()) {
    for (const auto& d : A.diagonals) subtract_diagonal(d, 0, static_cast<int>(n), x, a);
  } else if (A.full.size() > 0) {
    const Real* column = A.full.data();
    for (Eigen::Index j = 0; j < A.full.cols(); ++j, column += n) {
      for (std::size_t i = 0; i < n; ++i) a[i] -= column[i] * x[j];
    }
  } else {
    for (std::size_t i = 0; i < n; ++i) a[i] -= row_times(A, i, x);
  }
}

// a = -(A x + B y) of two chains, each number read and written once.
template <class Real, class Number>
[[gnu::always_inline]] inline void pull_of_chains(const RowsOf<Real>& A, const Number* __restrict__ x,
                                                  const RowsOf<Real>& B, const Number* __restrict__ y,
                                                  Number* __restrict__ a) {
  const std::size_t last = A.start.size() - 2;
  const Real *A0 = A.diagonals[0].value.data(), *A1 = A.diagonals[1].value.data(),
             *A2 = A.diagonals[2].value.data();
  const Real *B0 = B.diagonals[0].value.data(), *B1 = B.diagonals[1].value.data(),
             *B2 = B.diagonals[2].value.data();
  a[0] = -(A1[0] * x[0] + A2[0] * x[1] + B1[0] * y[0] + B2[0] * y[1]);
  for (std::size_t i = 1; i < last; ++i)
    a[i] = -(A0[i - 1] * x[i - 1] + A1[i] * x[i] + A2[i] * x[i + 1]) -
           (B0[i - 1] * y[i - 1] + B1[i] * y[i] + B2[i] * y[i + 1]);
  a[last] =
      -(A0[last - 1] * x[last - 1] + A1[last] * x[last] + B0[last - 1] * y[last - 1] + B1[last] * y[last]);
}

// a -= M^-1 W lambda,  lambda = G^-1 (W^T a + support).  support: of every contact, null: zero.  work:
// keep_work numbers
template <class Real, class Number>
[[gnu::always_inline]] inline void keep_numbers(const SystemOf<Real>& system, const HeldOf<Real>& held,
                                                const Number* support, Number* work, Number* a) {
  if (held.list.empty()) return;
  const std::size_t m = held.list.size();
  Number* slip = work;
  Number* lambda = work + m;  // of every contact: zero where it is not held
  std::fill_n(lambda, system.contacts_count(), Number{});
  for (std::size_t j = 0; j < m; ++j) {
    slip[j] = row_times(system.directions, static_cast<std::size_t>(held.list[j]), a);
    if (support != nullptr) slip[j] += support[held.list[j]];
  }
  for (std::size_t j = 0; j < m; ++j) lambda[held.list[j]] = row_times(held.force, j, slip);
  subtract_product(system.contacts, lambda, a);
}
// The same where no support moves: no mass moves if all are held.
template <class Real, class Number>
[[gnu::always_inline]] inline void keep_numbers(const SystemOf<Real>& system, const HeldOf<Real>& held,
                                                Number* work, Number* a) {
  if (held.hold_all)
    std::fill_n(a, system.masses(), Number{});
  else
    keep_numbers<Real, Number>(system, held, nullptr, work, a);
}
template <class Real>
std::size_t keep_work(const SystemOf<Real>& system) {
  return static_cast<std::size_t>(2 * system.contacts_count() + 1);
}

// a = -P M^-1 (K q + C v + D s),  s' = spring D^T v - rate s
template <class Real, class Number>
[[gnu::always_inline]] inline void pull_numbers(const SystemOf<Real>& system, const HeldOf<Real>& held,
                                                const Number* q, const Number* v, const Number* s,
                                                Number* work, Number* a, Number* ds) {
  const auto n = static_cast<std::size_t>(system.masses());
  const auto internal = static_cast<std::size_t>(system.internal_forces());
  if (system.is_chain) {
    pull_of_chains(system.stiffness, q, system.damping, v, a);
  } else {
    std::fill_n(a, n, Number{});
    subtract_product(system.stiffness, q, a);
    subtract_product(system.damping, v, a);
  }
  if (internal > 0) subtract_product(system.internal, s, a);
  for (const BeyondBend<Real>& bend : held.beyond) {
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

}  // namespace frahm::periodic
