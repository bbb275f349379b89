#pragma once

#include <algorithm>
#include <cmath>

#include "solvers/events/passage_steps.hpp"
#include "solvers/orbits/orbit.hpp"

namespace frahm::periodic {

// Integrals of the powers of s from 0 to `length`.
inline Polynomial integrals_of_powers(double length) {
  Polynomial result;
  for (int k = 0; k < kTerms; ++k) result[k] = std::pow(length, k + 1) / (k + 1.0);
  return result;
}

// Displacements offset + rate t from which those of an orbit are counted, t in steps from its section on, a
// number for each mass; empty where no mass is free [m, m a step].
struct RidingFrame {
  Eigen::VectorXd offset, rate;
  bool moves() const { return rate.size() > 0; }
  // From displacements at t = `at` to those of a motion whose drift is zero at half the period: what it adds
  // `since` then, the mean of what does not drift being zero.
  Eigen::VectorXd moved_on(double at, double since) const { return (since - at) * rate - offset; }
  // What a displacement w^T q + ... loses of its rate there, by its factors w.
  template <class Factors>
  double rate_of(const Factors& w) const {
    return moves() ? w.dot(rate) : 0.0;
  }
};

// An orbit laid out in steps of one mode each, from its section on.
template <int N, int H>
class OrbitSteps : public PassageSteps<N, H> {
 public:
  using PassageSteps<N, H>::PassageSteps;

  void lay_out(const Orbit<N, H>& orbit) {
    const Flow<N, H>& flow = this->flow_;
    this->clear();
    for (const Segment<N, H>& segment : orbit.passage.segments) {
      const Mode<N, H>& mode = flow.mode(segment.mode);
      typename Sizes<N, H>::State z = segment.z;
      for (double done = 0.0; done < segment.length;) {
        PassageStep<N, H>& step = this->add();
        step.start = segment.start + done;
        step.length = std::min(1.0, segment.length - done);
        step.mode = segment.mode;
        const double phase = orbit.section + step.start * flow.fundamental_rate();
        if (done == 0.0)
          flow.instant_at(z, phase, mode, step.left);
        else
          step.left = this->steps()[this->steps().size() - 2].right;
        if (step.length == 1.0) {
          step.expanded = flow.step(step.left, mode, step.right, step.expansion);
        } else {
          this->expand(step);
          Flow<N, H>::evaluate(step.expansion, step.length, z);
          flow.instant_at(z, phase + step.length * flow.fundamental_rate(), mode, step.right);
        }
        done += 1.0;
        step.ends_segment = done >= segment.length;
      }
    }
    frame_ = {};
    if (orbit.closing.is_modulo()) ride_along(orbit);
  }

  // What the displacements of these steps are counted from; nothing moves where nothing is free.
  const RidingFrame& frame() const { return frame_; }

 private:
  // Counts all displacements from a frame that free masses, on the mean, do not leave:
  //   q - R (c_0 + c_1 t),  c_1 T = R^T M (q(T) - q(0)),  c_0 so that the mean of R^T M q is zero.
  // After half a period R^T M q has the opposite sign. A stop that is not reached keeps its distance, where
  // nothing drifts.
  void ride_along(const Orbit<N, H>& orbit) {
    const StepEquations<N, H>& eq = this->flow_.equations();
    const Eigen::Index n = eq.masses();
    const Eigen::MatrixXd& along = orbit.closing.along();
    const Eigen::VectorXd first = along * orbit.z.head(n), last = along * orbit.passage.end.head(n);
    Eigen::VectorXd offset = 0.5 * (first + last), rate = Eigen::VectorXd::Zero(first.size());
    if (!orbit.half_period) {
      rate = (last - first) / eq.period;
      offset.setZero();
      for (PassageStep<N, H>& step : this->steps()) {
        const Expansion<N, H>& x = this->expand(step);
        offset += along * (x.z.leftCols(n).transpose() * integrals_of_powers(step.length));
      }
      offset = offset / eq.period - 0.5 * rate * eq.period;
    }
    constexpr double kNoDrift = 1e-9;
    if (rate.norm() * eq.period <= kNoDrift * std::max(first.norm(), offset.norm()))
      offset = orbit.closing.anywhere() * offset;
    frame_.offset = orbit.closing.directions() * offset;
    frame_.rate = orbit.closing.directions() * rate;
    for (PassageStep<N, H>& step : this->steps()) {
      Expansion<N, H>& x = step.expansion;
      this->expand(step);
      const Eigen::VectorXd at_left = frame_.offset + step.start * frame_.rate;
      step.left.z.head(n) -= at_left;
      step.right.z.head(n) -= at_left + step.length * frame_.rate;
      x.z.row(0).head(n) -= at_left.transpose();
      x.z.row(1).head(n) -= frame_.rate.transpose();
    }
  }

  RidingFrame frame_;
};

}  // namespace frahm::periodic
