#pragma once

#include <variant>

#include "solvers/mechanics/network.hpp"
#include "solvers/smooth/friction_curve.hpp"

// The forces of smooth laws over the velocity or the displacement across their elements.
namespace frahm::smooth {

// F (2/pi) arctan(slope v)
struct Arctan {
  double limit = 0.0, slope = 0.0;  // F [N], [s/m]

  ForceAndSlope at(double v) const;
};

// cubic u^3, next to the linear spring
struct Cubic {
  double cubic = 0.0;  // [N/m3]

  ForceAndSlope at(double u) const;
};

class SmoothForce {
 public:
  // limit: F of a coulomb element [N].
  SmoothForce(const mechanics::Element& element, const mechanics::SmoothValue& value, double limit);

  // The force [N] and its derivative at x [m/s or m].
  ForceAndSlope at(double x) const {
    return std::visit([x](const auto& law) { return law.at(x); }, law_);
  }
  bool is_of_velocity() const { return is_of_velocity_; }
  // The displacement [m] of a motion of this frequency [rad/s] at which the force bends, where the system
  // yields by `compliance` [m/N] across the element; 0 where there is no such place.
  double bent_displacement(double omega, double compliance) const;

 private:
  using Law = std::variant<Arctan, FrictionCurve, Cubic>;
  static Law law_of(const mechanics::Element& element, const mechanics::SmoothValue& value, double limit);

  Law law_;
  bool is_of_velocity_;
};

}  // namespace frahm::smooth
