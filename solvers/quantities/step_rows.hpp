#pragma once

#include <Eigen/Core>
#include <vector>

#include "solvers/flow/linear_form.hpp"
#include "solvers/quantities/integrals.hpp"

namespace frahm::periodic {

// Forms at the nodes of a whole step (integrals.hpp). They are linear in state and oscillators at its start,
// y = (z, u), by rows that a mode has once.
template <int N, int H>
class StepRows {
 public:
  using S = Sizes<N, H>;
  static constexpr int kSize = S::is_fixed ? S::kState + S::kOscillators : Eigen::Dynamic;
  using Row = Eigen::Matrix<double, kNodes, kSize>;

  // The flow, of a small system, must outlive the rows.
  explicit StepRows(const Flow<N, H>& flow) : flow_(flow) {}

  // To be called after the flow's forcing has changed.
  void forget() { turns_.clear(); }

  // form(s_i) = row i of this times y.
  Row of(const LinearForm<N, H>& form, const Mode<N, H>& mode);

 private:
  using OfOscillators = Eigen::Matrix<double, kNodes, S::kOscillators>;
  using Nodes = Eigen::Matrix<double, kNodes, kTerms>;
  using Series = Eigen::Matrix<double, kTerms, kSize>;

  static const Nodes& nodes();
  void turn(const Mode<N, H>& mode);

  const Flow<N, H>& flow_;
  std::vector<OfOscillators> turns_;  // each oscillator at the nodes, by those at the start
};

template <int N, int H>
const typename StepRows<N, H>::Nodes& StepRows<N, H>::nodes() {
  static const Nodes at = [] {
    Nodes each;
    for (int i = 0; i < kNodes; ++i) each.row(i) = powers(kNodeAt[i]).transpose();
    return each;
  }();
  return at;
}

// z(s) = series_z(s) z + series_u(s) u + series(s) over a whole step; the first oscillator is 1.
template <int N, int H>
typename StepRows<N, H>::Row StepRows<N, H>::of(const LinearForm<N, H>& form, const Mode<N, H>& mode) {
  const auto& tables = flow_.configuration(mode).tables;
  const Eigen::Index states = form.z.size(), oscillators = form.u.size();
  if (turns_.empty()) turn(mode);
  Row row = Row::Zero(kNodes, states + oscillators);
  if (!form.z.isZero(0.0)) {
    Series series = Series::Zero(kTerms, states + oscillators);
    for (Eigen::Index k = 0; k < states; ++k) {
      if (form.z[k] == 0.0) continue;
      series.leftCols(states) += form.z[k] * tables.series_z.template middleRows<kTerms>(kTerms * k);
      series.rightCols(oscillators) += form.z[k] * tables.series_u.template middleRows<kTerms>(kTerms * k);
      series.col(states) += form.z[k] * mode.series.template segment<kTerms>(kTerms * k);
    }
    row.noalias() = nodes().lazyProduct(series);
  }
  for (Eigen::Index k = 0; k < oscillators; ++k)
    if (form.u[k] != 0.0) row.rightCols(oscillators) += form.u[k] * turns_[static_cast<std::size_t>(k)];
  return row;
}

template <int N, int H>
void StepRows<N, H>::turn(const Mode<N, H>& mode) {
  const StepEquations<N, H>& eq = flow_.equations();
  turns_.assign(static_cast<std::size_t>(eq.oscillators()), OfOscillators::Zero(kNodes, eq.oscillators()));
  Instant<N, H> unit;
  unit.z = S::State::Zero(eq.states());
  Expansion<N, H> x;
  for (Eigen::Index k = 0; k < eq.oscillators(); ++k) {
    unit.u = S::Oscillators::Unit(eq.oscillators(), k);
    flow_.expand(unit, mode, x);
    // The first one is 1, whatever the others are.
    for (Eigen::Index j = k == 0 ? 0 : 1; j < eq.oscillators(); ++j)
      turns_[static_cast<std::size_t>(j)].col(k) = nodes() * x.u.col(j);
  }
}

extern template class StepRows<1, 1>;
extern template class StepRows<2, 1>;
extern template class StepRows<Eigen::Dynamic, Eigen::Dynamic>;

}  // namespace frahm::periodic
