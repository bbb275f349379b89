#pragma once

#include <complex>
#include <vector>

#include "solvers/identification/measurement.hpp"
#include "solvers/mechanics/network.hpp"

namespace frahm::identification {

// A measured excitation that replaces a network's own, from one of its times to the next. The exact flow
// takes constants and harmonics, so the interpolation consists of the record's mean and two harmonics of a
// fundamental so slow (kTurned of a radian an interval at most) that it is, as good as exactly,
//   linear between the values of a force,
//   the cubic spline through those of a displacement, whose velocity is continuous:
//   mean + a cos psi + c cos 2 psi + p sin psi + b sin 2 psi,  psi = order omega (t - middle of the
//   interval).
// Slopes of the spline at its two ends are those of the parabola through the first, or last, three values.
class MeasuredForcing {
 public:
  // Throws mechanics::MechanicsError where displacements have fewer than three values.
  MeasuredForcing(const mechanics::Network& network, const TimeRecord& record);

  const mechanics::Network& network() const { return network_; }  // with the measured excitation

  // Values and derivatives of the model in the layout of that network; the excitation does not change.
  mechanics::NetworkValues values_of(const mechanics::NetworkValues& model) const;
  mechanics::NetworkValues direction_of(const mechanics::NetworkValues& by) const;

  // The harmonics of the excitation between time i and the next, phase 0 being at the first
  // (periodic::Flow::set_oscillators). orders: of the network's system.
  void oscillators(std::size_t i, const std::vector<int>& orders,
                   std::vector<std::complex<double>>& at_zero) const;

 private:
  static constexpr double kTurned = 0.02;

  struct Column {
    mechanics::ExcitationKind kind;
    int order = 1;                       // of psi; the other harmonic has twice this
    double mean = 0.0;                   // of the values
    double scale = 1.0;                  // largest distance from it, > 0
    std::vector<double> values, slopes;  // less the mean; slopes [m/s] of a displacement
  };
  mechanics::Network network_;
  std::vector<double> time_;
  std::vector<Column> columns_;
  double omega_ = 0.0;  // [rad/s]
};

}  // namespace frahm::identification
