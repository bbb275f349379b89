#pragma once

#include <Eigen/Core>

#include "solvers/flow/equations.hpp"

namespace frahm::periodic {

// How an orbit closes that free directions R leave anywhere: its state repeats but for a displacement along
// R. R are those of the orbit: stops and tables that it reaches hold it as springs do. Velocities along those
// U of them that nothing takes up follow from the forcing alone; any constant one may be added, and by
// convention their mean is zero.
class Closing {
 public:
  Closing() = default;
  // reached: bends, of which the orbit goes beyond some.
  Closing(const StepFree& free, ContactMask reached);

  // Whether there are free directions; otherwise nothing below does anything.
  bool is_modulo() const { return R_.cols() > 0; }
  const Eigen::MatrixXd& directions() const { return R_; }  // R, n x r
  const Eigen::MatrixXd& along() const { return along_; }   // R^T M, r x n
  // Of coordinates along R those parts in which any place is as good as another: no bend is beyond, either.
  const Eigen::MatrixXd& anywhere() const { return anywhere_; }  // a projector, r x r

  // The residual of the map from z, its end less z, without what lies along R; of the velocity along U, what
  // it is to be at these oscillators less what it is.
  template <class State, class Oscillators>
  void apply(const State& z, const Oscillators& u, State& residual) const {
    const Eigen::Index n = along_.cols();
    remove(residual);
    if (U_.cols() == 0) return;
    residual.segment(n, n) += U_ * (driven_ * u - along_U_ * (z.segment(n, n) + residual.segment(n, n)));
  }
  // The change of the map's end with the network's values, by the derivative of the equations, as the
  // residual is projected: of the velocity along U, where U^T M v is the integral of U^T f,
  //   U^T M dv = integral of U^T df - U^T dM v.
  template <int N, int H, class By, class State, class Oscillators>
  void apply_change(const StepEquations<N, H>& eq, const By& by, const State& z, const Oscillators& u,
                    State& change) const {
    remove(change);
    if (U_.cols() == 0) return;
    const Eigen::Index n = along_.cols();
    const Eigen::VectorXd momentum =
        eq.integrated(U_.transpose() * by.force) * u - U_.transpose() * (by.M * z.segment(n, n));
    change.segment(n, n) += U_ * (eq.step * eq.step * momentum - along_U_ * change.segment(n, n));
  }
  // A state's or a matrix's rows without displacements along R.
  template <class Rows>
  void remove(Rows& rows) const {
    if (!is_modulo()) return;
    const Eigen::Index n = along_.cols();
    rows.topRows(n) -= (R_ * (along_ * rows.topRows(n))).eval();
  }
  // The derivative of the map, without displacements along R and velocities along U.
  template <class Square>
  void project(Square& tangent) const {
    if (!is_modulo()) return;
    const Eigen::Index n = along_.cols();
    remove(tangent);
    if (U_.cols() > 0) tangent.middleRows(n, n) -= (U_ * (along_U_ * tangent.middleRows(n, n))).eval();
  }

 private:
  Eigen::MatrixXd R_, along_, anywhere_;  // n x r, r x n, r x r
  Eigen::MatrixXd U_, along_U_, driven_;  // n x u, u x n, u x oscillators
};

// The energy norm of a residual, which counts displacements along the network's free directions as if springs
// made them swing at 1 rad a step: stops may hold an orbit there.
template <int N, int H>
double closing_norm(const StepEquations<N, H>& eq, const typename Sizes<N, H>::State& residual) {
  const double norm = eq.energy_norm(residual);
  if (!eq.has_free_masses) return norm;
  const double along = (eq.free.along * residual.head(eq.masses())).norm() / eq.step;
  return std::hypot(norm, along / std::sqrt(2.0));
}

// Closing of an orbit that goes through these modes.
template <class Flow, class Passage>
Closing closing_of(const Flow& flow, const Passage& passage) {
  const auto& eq = flow.equations();
  if (!eq.has_free_masses) return {};
  ContactMask reached = 0;
  for (const auto& segment : passage.segments) reached |= flow.mode(segment.mode).beyond;
  return Closing(eq.free, reached);
}

}  // namespace frahm::periodic
