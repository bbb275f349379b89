#pragma once

#include <Eigen/Core>

#include "solvers/flow/equations.hpp"

namespace frahm::periodic {

// One configuration and its flow over a step, as tables over all states: of small systems, in which they take
// less time than the equation itself.
//   q'' = Aq q + Av v + As s + Au u(t) + Af phi,   phi_j = sigma_j F_j of the contacts that slide, otherwise
//   0 z(1) = E z(0) + Eu u(0) + Ef phi,
// the exponential of the matrix augmented by the oscillators of the forcing (C. Van Loan, IEEE Trans. Autom.
// Control 23 (1978) 395): finite at resonance of an undamped mode and at critical damping alike.
template <int N, int H>
struct StepTables {
  using S = Sizes<N, H>;

  typename S::Square Aq, Av;
  typename S::VectorByInternal As;
  typename S::VectorByContacts Af;
  typename S::Square P;  // velocities -> velocities that keep the stuck contacts stuck, M-orthogonal
  typename S::ContactSquare constraint;   // G^+; zero rows and columns for sliding contacts
  typename S::VectorByContacts reaction;  // M^-1 W G^+
  // lambda = Lq q + Lv v + Ls s + ...
  typename S::ContactsByVector Lq, Lv;
  typename S::ContactsByInternal Ls;

  // The flow as Taylor series in the step fraction, z(s) = series_z(s) z(0) + series_u(s) u(0) + series_f(s)
  // phi.
  typename S::SeriesByState series_z;
  typename S::SeriesByOscillators series_u;
  typename S::SeriesByContacts series_f;
  // The same at s = 1.
  typename S::StateSquare E;
  typename S::StateByOscillators Eu;
  typename S::StateByContacts Ef;

  // The guard of each contact over a step, kTerms rows each: the force that holds it while it sticks,
  // otherwise its velocity; of sizes that are not fixed, where an event need not expand the whole state.
  typename S::ContactsByState guard;  // over the state at one instant
  Eigen::MatrixXd guard_z, guard_u, guard_f;

  // The series of states and friction forces, once Aq, Av, As and Af are set. spring: see Configuration.
  void propagate_homogeneous(const StepEquations<N, H>& equations, const typename S::Internal& spring);
  // The series of the oscillators. Au, internal_drive: see Configuration.
  void propagate_forcing(const StepEquations<N, H>& equations, const typename S::Internal& spring,
                         const typename S::VectorByOscillators& Au,
                         const typename S::InternalByOscillators& internal_drive);
  // The guards' own series, after those of the state. Lu: see Configuration.
  void set_guards(const StepEquations<N, H>& equations, ContactMask stuck);
  void drive_guards(const StepEquations<N, H>& equations, ContactMask stuck,
                    const typename S::ContactsByOscillators& Lu);
  // Columns of states moved on by part of a step.
  void move_by_fraction(double fraction, typename S::StateSquare& states) const;

 private:
  // Columns of solutions, and of what drives them.
  template <int Columns, int MostColumns = Columns>
  struct Solutions {
    using Vectors =
        Eigen::Matrix<double, N, Columns, N == 1 ? Eigen::RowMajor : Eigen::ColMajor, N, MostColumns>;
    using Forces = Eigen::Matrix<double, S::kInternal, Columns, Eigen::ColMajor, S::kInternal, MostColumns>;
    Vectors q, v;
    Forces s;

    Solutions(const StepEquations<N, H>& eq, Eigen::Index columns)
        : q(eq.masses(), columns), v(eq.masses(), columns), s(eq.internal_forces(), columns) {
      q.setZero();
      v.setZero();
      s.setZero();
    }
  };

  // The Taylor series of solutions whose coefficients 0 are given: coefficient k + 1 is the derivative of
  // coefficient k over k + 1. drive_next(k, v', s') adds what drives the velocities and internal forces at k.
  template <class Columns, class Series, class DriveNext>
  void expand_series(const StepEquations<N, H>& equations, const typename S::Internal& spring, Columns x,
                     Series& series, const DriveNext& drive_next) const {
    const Eigen::Index n = equations.masses(), internal = equations.internal_forces();
    series.resize(equations.states() * kTerms, x.q.cols());
    typename Columns::Vectors next(n, x.q.cols());
    typename Columns::Forces s_next = x.s;
    for (int k = 0; k < kTerms; ++k) {
      for (Eigen::Index column = 0; column < x.q.cols(); ++column) {
        for (Eigen::Index i = 0; i < n; ++i) {
          series(i * kTerms + k, column) = x.q(i, column);
          series((n + i) * kTerms + k, column) = x.v(i, column);
        }
        for (Eigen::Index i = 0; i < internal; ++i) series((2 * n + i) * kTerms + k, column) = x.s(i, column);
      }
      next.noalias() = Aq * x.q + Av * x.v;
      if constexpr (S::kInternal != 0) {
        next += As * x.s;
        s_next = spring.asDiagonal() * (equations.D.transpose() * x.v) -
                 equations.internal_rate.asDiagonal() * x.s;
      }
      drive_next(k, next, s_next);
      const double share = 1.0 / (k + 1.0);
      x.q = x.v * share;
      x.v = next * share;
      x.s = s_next * share;
    }
  }
  template <class Series, class Sums>
  static void sum_series(const Series& series, Sums& sums) {
    const Eigen::Index components = series.rows() / kTerms;
    sums.resize(components, series.cols());
    for (Eigen::Index column = 0; column < series.cols(); ++column) {
      for (Eigen::Index i = 0; i < components; ++i) {
        sums(i, column) = series.col(column).template segment<kTerms>(i * kTerms).sum();
      }
    }
  }
};

template <int N, int H>
void StepTables<N, H>::propagate_homogeneous(const StepEquations<N, H>& equations,
                                             const typename S::Internal& spring) {
  const Eigen::Index n = equations.masses();
  Solutions<S::kState> units(equations, equations.states());
  units.q.leftCols(n).setIdentity();
  units.v.middleCols(n, n).setIdentity();
  if constexpr (S::kInternal != 0) units.s.rightCols(equations.internal_forces()).setIdentity();
  expand_series(equations, spring, units, series_z, [](int, auto&, auto&) {});
  sum_series(series_z, E);

  // A unit friction force from rest, constant over the step.
  const Solutions<Eigen::Dynamic, S::kMaxContacts> from_rest(equations, equations.contacts());
  const auto constant_force = [&](int k, auto& v_next, auto&) {
    if (k == 0) v_next += Af;
  };
  expand_series(equations, spring, from_rest, series_f, constant_force);
  sum_series(series_f, Ef);
}

template <int N, int H>
void StepTables<N, H>::propagate_forcing(const StepEquations<N, H>& equations,
                                         const typename S::Internal& spring,
                                         const typename S::VectorByOscillators& Au,
                                         const typename S::InternalByOscillators& internal_drive) {
  // Column i starts from rest with oscillator i at 1. The forcing's own Taylor coefficients follow from its
  // rows.
  typename S::VectorByOscillators drive = Au, drive_rate;
  // Without internal forces it is empty, and constant.
  // NOLINTNEXTLINE(performance-unnecessary-copy-initialization)
  typename S::InternalByOscillators of_internal = internal_drive, of_internal_rate;
  drive_rate.resizeLike(drive);
  of_internal_rate.resizeLike(of_internal);
  const auto forcing = [&](int k, auto& v_next, [[maybe_unused]] auto& s_next) {
    const double share = 1.0 / (k + 1.0);
    v_next += drive;
    equations.differentiate(drive, drive_rate);
    drive = drive_rate * share;
    if constexpr (S::kInternal != 0) {
      s_next += of_internal;
      equations.differentiate(of_internal, of_internal_rate);
      of_internal = of_internal_rate * share;
    }
  };
  const Solutions<S::kOscillators> from_rest(equations, equations.oscillators());
  expand_series(equations, spring, from_rest, series_u, forcing);
  sum_series(series_u, Eu);
}

// `guard` over the series of all components of the state.
template <class Guard, class Series>
Eigen::MatrixXd guard_series(const Guard& guard, const Series& series) {
  Eigen::MatrixXd of_guards = Eigen::MatrixXd::Zero(kTerms * guard.rows(), series.cols());
  for (Eigen::Index j = 0; j < guard.rows(); ++j) {
    for (Eigen::Index i = 0; i < guard.cols(); ++i) {
      if (guard(j, i) != 0.0)
        of_guards.middleRows<kTerms>(kTerms * j) +=
            guard(j, i) * series.template middleRows<kTerms>(kTerms * i);
    }
  }
  return of_guards;
}

template <int N, int H>
void StepTables<N, H>::set_guards(const StepEquations<N, H>& equations, ContactMask stuck) {
  const Eigen::Index n = equations.masses();
  guard.setZero(equations.contacts(), equations.states());
  for (Eigen::Index j = 0; j < guard.rows(); ++j) {
    if (contains(stuck, j))
      guard.row(j) << Lq.row(j), Lv.row(j), Ls.row(j);
    else
      guard.row(j).segment(n, n) = equations.W.col(j).transpose();
  }
  guard_z = guard_series(guard, series_z);
  guard_f = guard_series(guard, series_f);
}

// To what the state makes come the oscillators' own: row * u(t) has the Taylor coefficients row^(k)/k!.
template <int N, int H>
void StepTables<N, H>::drive_guards(const StepEquations<N, H>& equations, ContactMask stuck,
                                    const typename S::ContactsByOscillators& Lu) {
  guard_u = guard_series(guard, series_u);
  typename S::ContactsByOscillators rows = equations.support_velocity, rates = rows;
  for (Eigen::Index j = 0; j < rows.rows(); ++j) {
    if (contains(stuck, j)) rows.row(j) = Lu.row(j);
  }
  for (int k = 0; k < kTerms; ++k) {
    for (Eigen::Index j = 0; j < rows.rows(); ++j) guard_u.row(kTerms * j + k) += rows.row(j);
    equations.differentiate(rows, rates);
    rows = rates / (k + 1.0);
  }
}

template <int N, int H>
void StepTables<N, H>::move_by_fraction(double fraction, typename S::StateSquare& states) const {
  const Polynomial power = powers(fraction);
  const Eigen::Index size = states.rows();
  typename S::StateSquare flow(size, size);
  for (Eigen::Index column = 0; column < size; ++column) {
    const Eigen::Map<const typename S::StatePolynomials> series(series_z.col(column).data(), kTerms, size);
    flow.col(column).noalias() = series.transpose() * power;
  }
  states = (flow * states).eval();
}

}  // namespace frahm::periodic
