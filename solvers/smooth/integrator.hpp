#pragma once

#include <Eigen/Core>
#include <memory>

#include "solvers/flow/search_work.hpp"
#include "solvers/smooth/equation.hpp"
#include "solvers/smooth/trajectory.hpp"

namespace frahm::smooth {

struct IntegratorOptions {
  // Local error of a step, relative to the state and to its scale: near what rounding allows, as the errors
  // of some thousand steps a period add up, and a weakly damped orbit multiplies them.
  double tolerance = 1e-13;
  // For the sensitivities, whose columns are scaled to order 1: Newton's method tolerates such errors, and
  // the Floquet multipliers are wanted to 1e-6 or so.
  double sensitivity_tolerance = 1e-8;
  double follow_tolerance = 1e-7;  // of motions that are followed only until they come near an orbit
  long most_steps = 200000;  // of one passage: some ten times what two stops a period take at a slope of 1e6
};

// The result of a passage.
struct Passage {
  Eigen::VectorXd end;
  Eigen::MatrixXd tangent;  // d end / d start
  Trajectory trajectory;
  double local_errors = 0.0;  // sum of the energy norms of the steps' estimated errors [sqrt(J)]
  long steps = 0;
  const char* failure = nullptr;  // why it did not reach its end
};

// Passages of an equation by SUNDIALS CVODES: BDF of variable order and step, Newton's method with the
// analytic Jacobian, forward sensitivities by the start (staggered corrector). One object is for one thread;
// objects share nothing.  Source: A. C. Hindmarsh et al., SUNDIALS, ACM Trans. Math. Softw. 31 (2005).
class Integrator {
 public:
  // The equation must outlive the integrator. Throws std::runtime_error where CVODES cannot be set up.
  explicit Integrator(Equation& equation, const IntegratorOptions& options = {});
  ~Integrator();
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  // From the state `start` at time t [s] over `duration` [s].  scale: size N, > 0, the scale of each
  // component for its errors.
  void pass(const Eigen::VectorXd& start, double t, double duration, const Eigen::VectorXd& scale,
            Passage& passage);
  // The same to a looser tolerance and without sensitivities: `state` moves to its end. False where it does
  // not reach it.
  bool follow(Eigen::VectorXd& state, double t, double duration, const Eigen::VectorXd& scale);

  // For all passages: one fails where it is over.
  periodic::SearchWork& work() { return work_; }

 private:
  class Cvodes;
  periodic::SearchWork work_;
  std::unique_ptr<Cvodes> cvodes_;
};

}  // namespace frahm::smooth
