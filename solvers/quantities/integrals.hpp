#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "solvers/flow/linear_form.hpp"
#include "solvers/quantities/orbit_steps.hpp"

// Integrals over an orbit. Means, root mean squares, Fourier components, damping losses are all entries of,
// or products with, one matrix: the integral of y y^T with y = (q, v, s, u) state and oscillators. Products
// of the oscillators with each other are of use where supports move; of a large system without such they are
// left at zero.
namespace frahm::periodic {

// Six-point Gauss-Legendre nodes and weights on [0, 1] (Abramowitz and Stegun, table 25.4). Over a step the
// integrands' rates are at most 2 kStepRate: the error is below 2e-14 of the scale.
inline constexpr int kNodes = 6;
inline constexpr double kNodeAt[kNodes] = {0.03376524289842397, 0.16939530676686774, 0.3806904069584015,
                                           0.6193095930415985,  0.8306046932331323,  0.966234757101576};
inline constexpr double kNodeWeight[kNodes] = {0.08566224618958517, 0.1803807865240693, 0.23395696728634552,
                                               0.23395696728634552, 0.1803807865240693, 0.08566224618958517};

template <int N, int H>
class Integrals {
 public:
  using S = Sizes<N, H>;
  static constexpr int kSize = S::is_fixed ? S::kState + S::kOscillators : Eigen::Dynamic;
  using Gram = Eigen::Matrix<double, kSize, kSize>;
  // Columns of whole vector registers.
  static constexpr int kPaddedSize = S::is_fixed ? (kSize + 3) / 4 * 4 : Eigen::Dynamic;

  // A force and the velocity it works at.
  struct Power {
    LinearForm<N, H> force, velocity;
  };

  // Lists the powers that put energy in during a mode.
  using PowersOf = std::function<void(const Mode<N, H>&, std::vector<Power>&)>;

  // Over the orbit's steps. The orbit covers half a period if `half_period`, and all integrals are of the
  // whole. signals: forms that hold in every mode.
  void integrate(OrbitSteps<N, H>& orbit, const Flow<N, H>& flow, bool half_period,
                 std::span<const LinearForm<N, H>> signals, const PowersOf& powers_of);

  const Gram& gram() const { return gram_; }  // [units of the state x s]
  // For each signal a row: its products with the oscillators, and its square.
  const Eigen::MatrixXd& signals() const { return signals_; }
  double input() const { return input_; }            // [J] in a period
  double input_size() const { return input_size_; }  // integral of |power| [J], to quadrature accuracy

 private:
  // A form's factors of y.
  using Joined = Eigen::Matrix<double, kPaddedSize, 1>;
  static Joined joined(const LinearForm<N, H>& form) {
    Joined c = Joined::Zero(padded(form.z.size() + form.u.size()));
    c.head(form.z.size()) = form.z;
    c.segment(form.z.size(), form.u.size()) = form.u;
    return c;
  }
  static Eigen::Index padded(Eigen::Index size) { return S::is_fixed ? kPaddedSize : size; }

  Gram gram_;
  Eigen::MatrixXd signals_;
  std::vector<Power> powers_;  // of the current mode
  std::vector<std::pair<Joined, Joined>> joined_powers_;
  double input_ = 0.0, input_size_ = 0.0;
};

template <int N, int H>
void Integrals<N, H>::integrate(OrbitSteps<N, H>& orbit, const Flow<N, H>& flow, bool half_period,
                                std::span<const LinearForm<N, H>> signals, const PowersOf& powers_of) {
  using Nodes = Eigen::Matrix<double, kTerms, kNodes>;
  using Samples = Eigen::Matrix<double, kPaddedSize, kNodes>;
  const StepEquations<N, H>& eq = flow.equations();
  const Eigen::Index size = eq.states() + eq.oscillators();
  Nodes full;
  for (int i = 0; i < kNodes; ++i) full.col(i) = powers(kNodeAt[i]);

  const Eigen::Index rows = eq.motion.rows() > 0 ? size : eq.states();
  Eigen::Matrix<double, kPaddedSize, kSize> gram = decltype(gram)::Zero(padded(size), size);
  const auto count = static_cast<Eigen::Index>(signals.size());
  signals_.setZero(count, eq.oscillators() + 1);
  input_ = input_size_ = 0.0;
  bool starts_segment = true;
  Samples y = Samples::Zero(padded(size), kNodes), weighted = y;
  for (PassageStep<N, H>& step : orbit.steps()) {
    if (starts_segment) {
      powers_of(flow.mode(step.mode), powers_);
      joined_powers_.clear();
      for (const Power& p : powers_) joined_powers_.emplace_back(joined(p.force), joined(p.velocity));
    }
    starts_segment = step.ends_segment;
    const Expansion<N, H>& x = orbit.expand(step);
    Nodes at = full;
    if (step.length < 1.0) at.array().colwise() *= powers(step.length).array();
    y.topRows(eq.states()) = x.z.transpose().lazyProduct(at);
    y.middleRows(eq.states(), eq.oscillators()) = x.u.transpose().lazyProduct(at);
    for (int i = 0; i < kNodes; ++i) weighted.col(i) = (step.length * kNodeWeight[i]) * y.col(i);
    if constexpr (S::is_fixed)
      gram += weighted.lazyProduct(y.topRows(size).transpose());
    else
      gram.topRows(rows) += weighted.topRows(rows).lazyProduct(y.transpose());
    for (Eigen::Index s = 0; s < count; ++s) {
      for (int i = 0; i < kNodes; ++i) {
        const auto u = weighted.col(i).segment(eq.states(), eq.oscillators());
        const double value = signals[static_cast<std::size_t>(s)].value(y.col(i));
        signals_.row(s).head(eq.oscillators()) += value * u.transpose();
        signals_(s, eq.oscillators()) += step.length * kNodeWeight[i] * value * value;
      }
    }

    Eigen::Matrix<double, 1, kNodes> power = Eigen::Matrix<double, 1, kNodes>::Zero();
    for (const auto& [force, velocity] : joined_powers_) {
      for (int i = 0; i < kNodes; ++i) power[i] += force.dot(y.col(i)) * velocity.dot(y.col(i));
    }
    for (int i = 0; i < kNodes; ++i) {
      input_ += step.length * kNodeWeight[i] * power[i];
      input_size_ += step.length * kNodeWeight[i] * std::abs(power[i]);
    }
  }
  const double seconds = (half_period ? 2.0 : 1.0) * eq.step;
  gram_ = seconds * gram.topRows(size);
  if (!S::is_fixed && rows < size)
    gram_.block(rows, 0, size - rows, rows) = gram_.block(0, rows, rows, size - rows).transpose().eval();
  signals_ *= seconds;
  input_ *= seconds;
  input_size_ *= seconds;
}

extern template class Integrals<1, 1>;
extern template class Integrals<2, 1>;
extern template class Integrals<Eigen::Dynamic, Eigen::Dynamic>;

}  // namespace frahm::periodic
