#pragma once

#include <Eigen/Core>
#include <vector>

#include "solvers/events/passage_steps.hpp"
#include "solvers/flow/joint_rows.hpp"
#include "solvers/quantities/trace.hpp"
#include "solvers/transient/motion.hpp"

namespace frahm::transient {

// The largest sizes of displacements, velocities and accelerations along a motion, step by step: stationary
// points are solved on a step's Taylor polynomial, and both limits of a jump count. A step is expanded only
// where its ends do not show that nothing larger lies between them.
//
// With the values and slopes at both ends, the Bernstein coefficients of the cubic Hermite interpolant bound
// it; the trace differs from it by at most M4 L^4 / 384, and its derivative from the interpolant's by at most
// sqrt(3) M4 L^3 / 216 (G. Birkhoff and A. Priver, J. Math. Phys. 46 (1967) 440). An acceleration is bounded
// as the derivative of its velocity. M4 follows from the energy norm: each derivative by the step fraction
// takes a factor of kStepRate at most.
//
// Where mean squares are asked for, every step is expanded and its polynomial's square integrated exactly.
class LargestValues {
 public:
  using Flow = periodic::Flow<Eigen::Dynamic, Eigen::Dynamic>;
  using Steps = periodic::PassageSteps<Eigen::Dynamic, Eigen::Dynamic>;
  using Step = periodic::PassageStep<Eigen::Dynamic, Eigen::Dynamic>;

  // From now on this is followed too, before the motion begins. kind: displacement, velocity or acceleration.
  // Returns its number; what is followed already keeps its own.
  // mean_square: is asked for too; not of an acceleration.
  std::size_t add(periodic::TraceKind kind, const mechanics::Incidence& at, bool mean_square = false);

  // Matrices and forcing of the flow are new.
  void set_system(const Flow& flow);
  // A step that begins at the time `at` [s].  energy: the energy norm of the motion [sqrt(J)], to a factor of
  // two.
  void follow(const Flow& flow, const Steps& steps, Step& step, double at, double energy);

  // The largest value [m], [m/s] or [m/s^2] with its sign, and when it is first reached to 1e-12 of it.
  const Extremum& largest(std::size_t number) const { return followed_[number].largest; }
  // Mean over the motion of its square [m^2], [m^2/s^2], where it was asked for.
  double mean_square(std::size_t number) const { return followed_[number].square / followed_[number].time; }

 private:
  using Instant = periodic::Instant<Eigen::Dynamic, Eigen::Dynamic>;

  struct Followed {
    periodic::TraceKind kind = periodic::TraceKind::displacement;
    mechanics::Incidence at;
    std::vector<Eigen::Index> masses;     // of which it has a share
    Eigen::VectorXd of_u, of_du, of_ddu;  // displacement, velocity, acceleration of its supports
    struct {
      periodic::StateRow displacement, velocity;
    } joint;                                  // where it has one: the whole rows, in steps
    double speed = 0.0, support_speed = 0.0;  // its velocity's bound for a unit of energy; of its supports
    double reached = -1.0;                    // the size that was first reached at the time of `largest`
    Extremum largest = {};
    bool has_square = false;
    double square = 0.0, time = 0.0;  // the integral of its square, over this time [s]
  };
  // Value and slope at both ends of a step, of the trace; of an acceleration those of its velocity.
  struct Ends {
    periodic::ValueAndSlope left, right;
  };

  static periodic::ValueAndSlope at_joint(const Followed& followed, const Instant& instant);
  static Ends ends_of(const Followed& followed, const Step& step);
  static void consider(double value, double time, Followed& followed);
  static periodic::Polynomial polynomial_of(const Followed& followed, const Steps& steps, Step& step);

  std::vector<Followed> followed_;
};

}  // namespace frahm::transient
