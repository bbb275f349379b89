#pragma once

#include <Eigen/LU>
#include <vector>

#include "solvers/orbits/rest_directions.hpp"
#include "solvers/quantities/passage_sensitivity.hpp"

// The derivative of a periodic orbit: delta (passage_sensitivity.hpp) repeats with the orbit,
//   (1 - s Phi) delta(0) = s g_p,
// with g_p = delta at the passage's end if it starts from zero at the section, Phi the passage's tangent, and
// s = -1 for a passage of half a period.
namespace frahm::periodic {

// "" if the orbit's search succeeded; otherwise why there is no derivative.
template <int N, int H>
const char* why_no_orbit_derivative(const Orbit<N, H>& orbit) {
  switch (orbit.status) {
    case Status::ok:
    case Status::several:
      return "";
    case Status::grazing:
      return kGrazes;
    case Status::unbounded:
      return "the response is unbounded";
    default:
      return "there is no response";
  }
}

template <int N, int H>
class OrbitSensitivity {
 public:
  using S = Sizes<N, H>;

  explicit OrbitSensitivity(const Flow<N, H>& flow) : flow_(flow), passage_(flow) {}

  // Prepares derivatives of this orbit, laid out in `steps`; both must outlive them.
  // Returns "" or why the orbit has none.
  const char* prepare(const Orbit<N, H>& orbit, OrbitSteps<N, H>& steps);

  // Along one direction; `by` must outlive what is asked below. Returns "" or why there is none.
  const char* differentiate(const StepDerivative<N, H>& by);

  // delta over the orbit's passage.
  const PassageSensitivity<N, H>& passage() const { return passage_; }
  // Of the frame that displacements are counted from.
  const RidingFrame& frame_by() const { return frame_by_; }

 private:
  void add_rest_positions(typename S::State& right_side) const;
  RidingFrame frame_change(const typename S::State& start, const typename S::State& end) const;
  bool has_rest_positions() const { return !orbit_->half_period && orbit_->stuck_throughout != 0; }

  const Flow<N, H>& flow_;
  const Orbit<N, H>* orbit_ = nullptr;
  std::span<const PassageStep<N, H>> steps_;
  const RidingFrame* frame_ = nullptr;
  RidingFrame frame_by_;
  RestDirections rest_;             // of contacts that stick throughout
  Eigen::MatrixXd shift_per_keep_;  // E (L^T E)^+
  PassageSensitivity<N, H> passage_;
  Eigen::PartialPivLU<typename S::StateSquare> periodicity_;  // of 1 - s Phi
};

template <int N, int H>
const char* OrbitSensitivity<N, H>::prepare(const Orbit<N, H>& orbit, OrbitSteps<N, H>& steps) {
  const StepEquations<N, H>& eq = flow_.equations();
  orbit_ = &orbit;
  steps.lay_out(orbit);
  for (PassageStep<N, H>& step : steps.steps()) steps.expand(step);
  steps_ = steps.steps();
  frame_ = &steps.frame();
  if (orbit.passage.starts_at_event)
    return "events follow one another too closely for a section between them";

  typename S::StateSquare A = -orbit.sign() * orbit.passage.tangent;
  orbit.closing.project(A);
  A.diagonal().array() += 1.0;
  if (has_rest_positions()) {
    // A rest position may be anywhere: the known L^T dz(0) replaces its equation.
    rest_ = rest_directions(eq, orbit.stuck_throughout);
    shift_per_keep_ = shift_per_kept(rest_);
    A += shift_per_keep_ * rest_.L.transpose();
  }
  periodicity_.compute(A);
  return "";
}

template <int N, int H>
const char* OrbitSensitivity<N, H>::differentiate(const StepDerivative<N, H>& by) {
  passage_.set_direction(by);
  const typename S::State g_p =
      passage_.carry(steps_, orbit_->passage.changes, S::State::Zero(flow_.equations().states()));
  if (*passage_.why_none() != '\0') return passage_.why_none();
  typename S::State right_side = orbit_->sign() * g_p;
  if (orbit_->closing.is_modulo())
    orbit_->closing.apply_change(flow_.equations(), by, orbit_->z, steps_.front().left.u, right_side);
  add_rest_positions(right_side);
  const typename S::State start = periodicity_.solve(right_side);
  constexpr double kBeyondRounding = 1e12;
  const StepEquations<N, H>& eq = flow_.equations();
  if (!start.allFinite() || eq.energy_norm(start) > kBeyondRounding * eq.energy_norm(right_side)) {
    return "the period map has a multiplier of 1: the response is one of many";
  }
  const typename S::State end = passage_.carry(steps_, orbit_->passage.changes, start);
  frame_by_ = {};
  if (orbit_->closing.is_modulo() && *passage_.why_none() == '\0') {
    frame_by_ = frame_change(start, end);
    passage_.ride_along(frame_by_.offset, frame_by_.rate);
  }
  return passage_.why_none();
}

// Of the frame that an orbit is counted from (OrbitSteps), with dM at constant R:
//   T dc_1 = R^T M (dq(T) - dq(0)),   the mean of R^T (M dq + dM q) is zero, q counted from the frame;
// the same at both ends together, where half a period turns its sign.
template <int N, int H>
RidingFrame OrbitSensitivity<N, H>::frame_change(const typename S::State& start,
                                                 const typename S::State& end) const {
  const StepEquations<N, H>& eq = flow_.equations();
  const StepDerivative<N, H>& by = passage_.equations();
  const Eigen::Index n = eq.masses();
  const Eigen::MatrixXd &R = orbit_->closing.directions(), &along = orbit_->closing.along();
  const Eigen::MatrixXd along_by =
      eq.step * eq.step * (R.transpose() * (by.M + 2.0 * by.log_step * eq.M));  // R^T dM in SI
  const auto at_ends = [&](const auto& d, const Instant<N, H>& x) {
    return Eigen::VectorXd(along * d.head(n) + along_by * x.z.head(n));
  };
  if (orbit_->half_period) {
    const Eigen::VectorXd offset =
        0.5 * (at_ends(start, steps_.front().left) + at_ends(end, steps_.back().right));
    return {R * offset, Eigen::VectorXd::Zero(n)};
  }
  const Eigen::VectorXd rate = along * (end - start).head(n) / eq.period;
  Eigen::VectorXd offset = -0.5 * eq.period * eq.period * rate;
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const Polynomial share = integrals_of_powers(steps_[i].length);
    offset += along * (passage_.polynomials(i).leftCols(n).transpose() * share) +
              along_by * (steps_[i].expansion.z.leftCols(n).transpose() * share);
  }
  offset /= eq.period;
  if (frame_->rate.isZero(0.0) || !orbit_->closing.anywhere().isIdentity(1e-9))
    offset = orbit_->closing.anywhere() * offset;
  return {R * offset, R * rate};
}

// A contact that sticks throughout rests where the energy is least, which makes the mean of L^T z zero:
//   L^T z(t) = p^T (y(t) - mean y),   L^T dz = p^T d(y - mean y) + s dk/k^2.
template <int N, int H>
void OrbitSensitivity<N, H>::add_rest_positions(typename S::State& right_side) const {
  if (!has_rest_positions()) return;
  const StepEquations<N, H>& eq = flow_.equations();
  const StepDerivative<N, H>& by = passage_.equations();
  Eigen::VectorXd kept(count(orbit_->stuck_throughout));
  Eigen::Index column = 0;
  for (Eigen::Index j = 0; j < eq.contacts(); ++j) {
    if (!contains(orbit_->stuck_throughout, j)) continue;
    typename S::OscillatorRow moving = by.support_displacement.row(j);
    moving[0] = 0.0;  // its mean
    kept[column] = moving.dot(steps_.front().left.u);
    if constexpr (S::kInternal != 0) {
      if (!eq.holds(j)) {
        const Eigen::Index internal = eq.internal_of[static_cast<std::size_t>(j)];
        const double k = eq.internal_stiffness[internal];
        kept[column] += orbit_->z[2 * eq.masses() + internal] * by.internal_stiffness[internal] / (k * k);
      }
    }
    ++column;
  }
  if (rest_.balanced.rows() > 0) kept = (rest_.balanced.transpose() * kept).eval();
  right_side += shift_per_keep_ * kept;
}

}  // namespace frahm::periodic
