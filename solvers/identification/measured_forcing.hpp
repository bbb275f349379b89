#pragma once

#include <vector>

#include "solvers/identification/measurement.hpp"
#include "solvers/mechanics/network.hpp"

namespace frahm::identification {

// A measured excitation in the place of a network's own, from one of its times to the next. The exact flow
// knows constants and harmonics, so the interpolation is made of those, of a fundamental so slow (kTurned of
// a radian an interval at most) that it is, as good as exactly,
//   linear between the values of a force:           c + p sin psi
//   the cubic spline through those of a displacement, whose velocity is continuous:
//                                                   c + a cos psi + p sin psi + b sin 2 psi
// psi = omega (t - middle of the interval). Slopes of the spline at its two ends are those of the parabola
// through the first, or last, three values.
class MeasuredForcing {
 public:
  // Throws mechanics::MechanicsError where displacements have fewer than three values.
  MeasuredForcing(const mechanics::Network& network, const TimeRecord& record);

  const mechanics::Network& network() const { return network_; }  // with the measured excitation

  // Values and derivatives of the model in the layout of that network; the excitation does not change.
  mechanics::NetworkValues values_of(const mechanics::NetworkValues& model) const;
  mechanics::NetworkValues direction_of(const mechanics::NetworkValues& by) const;

  // Excitation between time i and the next, its phase 0 at the first.
  void set_interval(std::size_t i, mechanics::NetworkValues& values) const;

 private:
  static constexpr double kTurned = 0.05;

  struct Column {
    mechanics::ExcitationKind kind;
    std::vector<double> values, slopes;  // slopes [m/s] of a displacement
  };
  mechanics::Network network_;
  std::vector<double> time_;
  std::vector<Column> columns_;
  double omega_ = 0.0;  // [rad/s]
};

}  // namespace frahm::identification
