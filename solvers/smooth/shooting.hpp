#pragma once

#include <Eigen/Core>
#include <complex>
#include <string>
#include <vector>

#include "solvers/orbits/orbit.hpp"
#include "solvers/smooth/integrator.hpp"

namespace frahm::smooth {

using periodic::Status;

// A periodic motion, known over a period from its section, or over half a period where it repeats with the
// opposite sign, z(t + T/2) = -z(t).
struct Orbit {
  Status status = Status::not_computed;  // a smooth law does not graze
  std::string reason;                    // why it failed
  Eigen::VectorXd z;                     // state at the section
  double section = 0.0;                  // time [s] from omega t = 0
  bool half_period = false;
  Passage passage;
  double residual = 0.0;  // of the periodic condition, relative, energy norm
  int newton_iterations = 0;
  int passages = 0;
  int multiple = 1;    // of the forcing's period, that the orbit takes
  int coexisting = 1;  // stable orbits that were found
  int unsettled = 0;   // starts of the search whose motions came to none

  bool is_found() const { return periodic::has_response(status); }
  double sign() const { return half_period ? -1.0 : 1.0; }
  // Largest modulus of the Floquet multipliers of the full period.
  double floquet_radius() const;
  // All of them, the largest first.
  std::vector<std::complex<double>> multipliers() const;
};

struct ShootingOptions {
  double tolerance = 1e-11;     // of the relative residual: near what the integrator's tolerance leaves of it
  double good_enough = 1e-9;    // accepted where that keeps it from falling further
  double largest_error = 1e-6;  // estimated, of the orbit, relative, energy norm: a larger one is a failure
  int most_passages = 60;       // each some hundredths of a second
  int most_rejections = 3;      // shorter Newton steps that are tried before the map itself is applied
  bool applies_map = true;      // else the search ends there
};

// The periodic orbit as a fixed point of the period map, by Newton's method with the integrator's
// sensitivities. If a Newton step does not reduce the residual, the map itself is applied where that is
// wanted: under monotone laws (arctan, a curve that rises) it expands no distance in the energy norm.
class Shooting {
 public:
  // Both must outlive the shooting.
  Shooting(const Equation& equation, Integrator& integrator, const ShootingOptions& options = {})
      : equation_(equation), integrator_(integrator), options_(options) {}

  // Starts from the guess orbit.z at orbit.section; orbit.half_period selects the map. Fills the rest of
  // `orbit`. scale: of each component, for its errors.
  void find(const Eigen::VectorXd& scale, Orbit& orbit);

 private:
  void apply_map(const Eigen::VectorXd& scale, Orbit& orbit);
  bool newton(const Eigen::VectorXd& scale, Orbit& orbit);
  double estimated_error(const Orbit& orbit) const;
  void march(const Eigen::VectorXd& scale, int maps, Orbit& orbit);
  bool may_go_on(const Orbit& orbit) const {
    return orbit.passage.failure == nullptr && orbit.passages < options_.most_passages;
  }

  const Equation& equation_;
  Integrator& integrator_;
  ShootingOptions options_;
  Eigen::VectorXd residual_;
};

}  // namespace frahm::smooth
