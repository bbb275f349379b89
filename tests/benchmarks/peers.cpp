#include "tests/benchmarks/peers.hpp"

#include <algorithm>
#include <array>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <numbers>

namespace frahm::benchmarks {
namespace {

using mechanics::NetworkValues;
using std::numbers::pi;

double smooth_sign(double v) {
  return 2.0 / pi * std::atan(1e5 * v);
}

template <std::size_t Size, class Rate>
double integrated_peak(const Rate& rate, double omega, double unit, const PeerAccuracy& accuracy) {
  namespace odeint = boost::numeric::odeint;
  using State = std::array<double, Size>;
  State state{};
  const auto stepper = odeint::make_controlled(accuracy.absolute * unit, accuracy.relative,
                                               odeint::runge_kutta_dopri5<State>());
  const double period = 2.0 * pi / omega;
  constexpr int kMostPeriods = 2000;
  double last = 0.0;
  for (int cycle = 0; cycle < kMostPeriods; ++cycle) {
    double peak = 0.0;
    odeint::integrate_adaptive(stepper, rate, state, cycle * period, (cycle + 1) * period, period / 200.0,
                               [&](const State& x, double) { peak = std::max(peak, std::abs(x[0])); });
    if (cycle > 3 && std::abs(peak - last) < accuracy.settled * peak) return peak;
    last = peak;
  }
  return last;
}

}  // namespace

double one_mass_peak(const NetworkValues& values, const PeerAccuracy& accuracy) {
  using State = std::array<double, 2>;
  const auto rate = [&](const State& x, State& dx, double t) {
    dx[0] = x[1];
    dx[1] =
        std::cos(values.omega * t) - values.element[1] * x[1] - x[0] - values.element[2] * smooth_sign(x[1]);
  };
  return integrated_peak<2>(rate, values.omega, 1.0, accuracy);
}

double rig_peak(const NetworkValues& values, const PeerAccuracy& accuracy) {
  using State = std::array<double, 4>;
  const auto& e = values.element;
  const double M = values.mass[0], m = values.mass[1], b = e[6];
  const double determinant = M * m + b * (M + m);  // of the mass matrix [M+b, -b; -b, m+b]
  const auto rate = [&](const State& x, State& dx, double t) {
    const double drive =
        values.excitation[0].amplitude * std::cos(values.omega * t + values.excitation[0].phase);
    const double between = e[4] * (x[0] - x[1]) + e[5] * (x[2] - x[3]) + e[7] * smooth_sign(x[2] - x[3]);
    const double on_main =
        e[1] * drive - (e[0] + e[1]) * x[0] - e[3] * x[2] - e[2] * smooth_sign(x[2]) - between;
    dx[0] = x[2];
    dx[1] = x[3];
    dx[2] = ((m + b) * on_main + b * between) / determinant;
    dx[3] = (b * on_main + (M + b) * between) / determinant;
  };
  return integrated_peak<4>(rate, values.omega, 1e-2, accuracy);
}

}  // namespace frahm::benchmarks
