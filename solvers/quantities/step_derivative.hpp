#pragma once

#include "solvers/quantities/bend_derivative.hpp"

// Derivatives of the equations of motion along a change of the network's values. Time is counted in steps,
// and the step shrinks with the period: omega h is held, so that a period keeps its number of steps and the
// oscillators of the forcing do not change.
namespace frahm::periodic {

// The derivative of StepEquations; what it does not list does not change.
template <int N, int H>
struct StepDerivative {
  using S = Sizes<N, H>;

  double log_step = 0.0;  // dh/h = -d omega/omega, the derivative of the period's logarithm too
  typename S::Square M, C, K;
  typename S::VectorByOscillators force;
  typename S::SupportsByOscillators motion, motion_velocity, motion_acceleration;
  typename S::ContactsByOscillators support_displacement, support_velocity, support_acceleration;
  typename S::Contacts limit, static_limit;
  StepBends<N, H> bends;                              // of their numbers and supports; directions are empty
  Eigen::VectorXd internal_stiffness;                 // dk
  Eigen::MatrixXd internal_by_state, internal_drive;  // of s', by state and by oscillators
  Eigen::MatrixXd D;                                  // changes by joints alone, otherwise empty
  StepJoints joints;

  // system, by: the equations of `eq` and their derivative, before time was counted in steps.
  void set(const StepEquations<N, H>& eq, const mechanics::LinearSystem& system,
           const mechanics::LinearSystem& by);

 private:
  void set_bends(const StepEquations<N, H>& eq, const mechanics::Bends& of_system,
                 const mechanics::Bends& by);
  void set_joints(const StepEquations<N, H>& eq, const mechanics::LinearSystem& system,
                  const mechanics::LinearSystem& by);
};

// The derivative of the motion in one mode: at state z and oscillators u
//   q'' changes by  acceleration_z z + acceleration_u u,   lambda_j by  (force_z z + force_u u)_j.
template <int N, int H>
struct ModeDerivative {
  using S = Sizes<N, H>;
  Eigen::Matrix<double, N, S::kState> acceleration_z;
  typename S::VectorByOscillators acceleration_u;
  Eigen::Matrix<double, Eigen::Dynamic, S::kState, Eigen::RowMajor, S::kMaxContacts, S::kState> force_z;
  typename S::ContactsByOscillators force_u;

  void set(const Flow<N, H>& flow, const Mode<N, H>& mode, const StepDerivative<N, H>& by);
};

template <int N, int H>
void StepDerivative<N, H>::set(const StepEquations<N, H>& eq, const mechanics::LinearSystem& system,
                               const mechanics::LinearSystem& by) {
  const double h = eq.step;
  log_step = -by.omega / system.omega;
  // d(M/h^2) = dM/h^2 - 2 (M/h^2) dh/h,  d(C/h) = dC/h - (C/h) dh/h
  M = by.M / (h * h) - 2.0 * log_step * eq.M;
  C = by.C / h - log_step * eq.C;
  K = by.K;
  on_oscillators(by.constant_force, by.force, by.recorded_force, eq.recorded_size, force);
  on_oscillators(by.constant_motion, by.motion, by.recorded_motion, eq.recorded_size, motion);
  motion_velocity.resizeLike(motion);
  motion_acceleration.resizeLike(motion);
  eq.differentiate(motion, motion_velocity);
  eq.differentiate(motion_velocity, motion_acceleration);
  // d(V h) = h dV + (V h) dh/h
  motion_velocity.col(0) += h * (by.belt_velocity + log_step * system.belt_velocity);
  support_displacement.noalias() = system.W_support.transpose() * motion;
  support_velocity.noalias() = system.W_support.transpose() * motion_velocity;
  support_acceleration.noalias() = system.W_support.transpose() * motion_acceleration;
  limit = by.limit;
  static_limit = by.static_limit;
  set_bends(eq, system.bends, by.bends);
  if constexpr (S::kInternal != 0) {
    // s' = k (D^T v + p^T y') - rate s,  d(rate h) = h drate + (rate h) dh/h
    const Eigen::Index n = eq.masses(), s = eq.internal_forces();
    const Eigen::VectorXd rate = h * by.internal_rate + log_step * eq.internal_rate;
    internal_stiffness = by.internal_stiffness;
    internal_by_state.setZero(s, eq.states());
    internal_by_state.middleCols(n, n) = by.internal_stiffness.asDiagonal() * eq.D.transpose();
    internal_by_state.rightCols(s) = -Eigen::MatrixXd(rate.asDiagonal());
    internal_drive = by.internal_stiffness.asDiagonal() * (system.D_support.transpose() * eq.motion_velocity);
    internal_drive += eq.internal_stiffness.asDiagonal() * (system.D_support.transpose() * motion_velocity);
    if (system.joints.any()) set_joints(eq, system, by);
  }
}

// d(k D^T) = dk D^T + k dD^T with dk a matrix, and so on; the loads P of joints and what they drive.
template <int N, int H>
void StepDerivative<N, H>::set_joints(const StepEquations<N, H>& eq, const mechanics::LinearSystem& system,
                                      const mechanics::LinearSystem& by) {
  const mechanics::Joints &its = system.joints, &d = by.joints;
  const Eigen::Index n = eq.masses(), s = eq.internal_forces();
  const auto k = eq.internal_stiffness.asDiagonal();
  D = by.D;
  on_oscillators(d.constant_load, d.load, d.recorded_load, eq.recorded_size, joints.load);
  Eigen::MatrixXd load_rate(joints.load.rows(), joints.load.cols()), load_rate_by = load_rate;
  eq.differentiate(eq.joints.load, load_rate);
  eq.differentiate(joints.load, load_rate_by);
  internal_by_state.middleCols(n, n) += d.stiffness_by * eq.D.transpose() + k * by.D.transpose();
  internal_by_state.rightCols(s) -= eq.step * d.rate_by;
  const Eigen::MatrixXd driven =
      system.D_support.transpose() * eq.motion_velocity + its.load_drive.transpose() * load_rate;
  internal_drive += d.stiffness_by * driven + k * (by.D_support.transpose() * eq.motion_velocity) +
                    k * (d.load_drive.transpose() * load_rate + its.load_drive.transpose() * load_rate_by);
  joints.B = d.B;
  joints.X = d.X;
  const Eigen::MatrixXd of_loads = d.A * eq.joints.load + its.A * joints.load;
  joints.offset = of_loads + d.B_support * eq.motion + its.B_support * motion;
  joints.offset_velocity.resizeLike(joints.offset);
  joints.offset_acceleration.resizeLike(joints.offset);
  eq.differentiate(of_loads, joints.offset_velocity);
  joints.offset_velocity += d.B_support * eq.motion_velocity + its.B_support * motion_velocity;
  eq.differentiate(joints.offset_velocity, joints.offset_acceleration);
  joints.drive_rate.resizeLike(internal_drive);
  eq.differentiate(internal_drive, joints.drive_rate);
}

// d(c/h) = dc/h - (c/h) dh/h; of the place of a velocity d(D h) = h dD + (D h) dh/h
template <int N, int H>
void StepDerivative<N, H>::set_bends(const StepEquations<N, H>& eq, const mechanics::Bends& of_system,
                                     const mechanics::Bends& by) {
  bends.of_velocity = eq.bends.of_velocity;
  bends.stiffness = by.stiffness;
  bends.damping = by.damping / eq.step - log_step * eq.bends.damping;
  bends.place = by.place;
  for (Eigen::Index j = 0; j < bends.count(); ++j) {
    if (contains(bends.of_velocity, j)) bends.place[j] = eq.step * by.place[j] + log_step * eq.bends.place[j];
  }
  bends.motion.noalias() = of_system.W_support.transpose() * motion;
  bends.motion_velocity.noalias() = of_system.W_support.transpose() * motion_velocity;
  bends.motion_acceleration.noalias() = of_system.W_support.transpose() * motion_acceleration;
}

// M q'' + W lambda = f and w_j^T q'' = -p_j^T y'' of the stuck contacts, differentiated:
//   M dq'' + W dlambda = df - dM q'' = r,     w_j^T dq'' = -p_j^T dy'',    so that, with G = W^T M^-1 W,
//   dlambda = G^+ (W^T M^-1 r + p^T dy''),    dq'' = P M^-1 r - M^-1 W G^+ p^T dy''
template <int N, int H>
void ModeDerivative<N, H>::set(const Flow<N, H>& flow, const Mode<N, H>& mode,
                               const StepDerivative<N, H>& by) {
  const StepEquations<N, H>& eq = flow.equations();
  const Configuration<N, H>& c = flow.configuration(mode);
  const Eigen::Index n = eq.masses(), m = eq.contacts();

  Eigen::Matrix<double, N, S::kState> r_z = decltype(r_z)::Zero(n, eq.states());
  r_z.leftCols(n) = -by.K;
  r_z.middleCols(n, n) = -by.C;
  if constexpr (S::kInternal != 0) {
    if (by.D.size() > 0) r_z.rightCols(eq.internal_forces()) = -by.D;
  }
  r_z.noalias() -= by.M * c.pull_by_state(eq);
  typename S::VectorByOscillators r_u = by.force;
  r_u.noalias() -= by.M * c.Au;
  r_u.col(0).noalias() -= by.M * mode.acceleration;
  for (Eigen::Index j = 0; j < m; ++j) {
    if (!eq.holds(j) || contains(mode.stuck, j)) continue;
    const double limit_by = (contains(c.idle, j) ? by.static_limit : by.limit)[j];
    r_u.col(0) -= (mode.sign(j) * limit_by) * eq.W.col(j);
  }

  for (Eigen::Index j = 0; mode.beyond != 0 && j < eq.bends.count(); ++j) {
    if (!contains(mode.beyond, j)) continue;
    const auto b = eq.bends.B.col(j);
    const BendForceDerivative<N, H> force(eq.bends, by.bends, j);
    r_z.leftCols(n) -= b * force.of_displacement;
    r_z.middleCols(n, n) -= b * force.of_velocity;
    r_u -= b * force.of_oscillators;
  }

  const typename S::Square mobility = c.projector(eq) * eq.M_inverse;
  acceleration_z.noalias() = mobility * r_z;
  acceleration_u.noalias() = mobility * r_u;
  force_z.setZero(m, eq.states());
  force_u.setZero(m, eq.oscillators());
  const ContactMask held = mode.stuck & eq.holding;
  if (held == 0) return;
  const typename S::VectorByContacts reaction = c.reaction(eq);
  const typename S::ContactSquare constraint = c.constraint(eq);
  acceleration_u -= reaction * by.support_acceleration;
  force_z.noalias() = reaction.transpose() * r_z;
  force_u.noalias() = reaction.transpose() * r_u;
  force_u += constraint * by.support_acceleration;
  if (!eq.has_loops) return;

  // If stuck directions are linearly dependent, lambda is that of least sum (lambda_j / F_j)^2, which changes
  // with the F_j: (1 - G^+ G) 2 (dF/F) lambda, in the kernel of G.
  typename S::Contacts turn = S::Contacts::Zero(m);
  for (Eigen::Index j = 0; j < m; ++j) {
    if (contains(held, j) && eq.limit[j] > 0.0) turn[j] = 2.0 * by.limit[j] / eq.limit[j];
  }
  const typename S::VectorByContacts MW = eq.M_inverse * eq.W;
  const typename S::ContactSquare G = eq.W.transpose() * MW;
  typename S::ContactSquare turned = S::ContactSquare::Identity(m, m);
  turned.noalias() -= constraint * G;
  for (Eigen::Index j = 0; j < m; ++j) turned.col(j) *= turn[j];
  decltype(force_z) forces = decltype(force_z)::Zero(m, eq.states());
  for (Eigen::Index j = 0; j < m; ++j) {
    if (contains(mode.stuck, j)) forces.row(j) = flow.stuck_force_form(mode, j).transpose();
  }
  force_z += turned * forces;
  force_u += turned * c.Lu;
  force_u.col(0) += turned * mode.stuck_force;
}

}  // namespace frahm::periodic
