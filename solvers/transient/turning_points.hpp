#pragma once

#include <vector>

#include "solvers/events/tolerances.hpp"
#include "solvers/flow/flow.hpp"
#include "solvers/transient/motion.hpp"

namespace frahm::transient {

// A velocity that ends with less deceleration than this, relative to the largest one its scale allows, has
// not reached zero: it creeps, and counts as zero only because it is so small (periodic::kRest).
inline constexpr double kCreeping = 3.0 * periodic::kRest;

// One step of a mass: its Taylor polynomials in the step fraction, and how long the step lasts.
struct MassStep {
  double start = 0.0;                           // [s]
  double step = 0.0;                            // [s] a whole step
  double length = 1.0;                          // (0, 1]: the part of it that belongs to the motion
  periodic::Polynomial displacement, velocity;  // [m], [m a step]
  double speed_scale = 0.0;                     // against which a velocity is small [m a step]
};

// The extrema of one mass's displacement: the roots of its velocity, step by step.
class TurningPoints {
 public:
  void follow(const MassStep& step);
  const std::vector<Extremum>& extrema() const { return extrema_; }

 private:
  enum class Sense { unknown, forward, backward, held };

  void enter(Sense sense, const MassStep& step, double at);

  Sense sense_ = Sense::unknown;
  double deceleration_ = 0.0;  // of the velocity at the end of the step before, relative to the scale
  std::vector<Extremum> extrema_;
};

}  // namespace frahm::transient
