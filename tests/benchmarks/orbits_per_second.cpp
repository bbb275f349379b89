// Orbits per second and core, beside the strongest peer in the same run: Boost.odeint's dopri5 on the
// smoothed friction law F (2/pi) arctan(1e5 v), integrated until the peak changes by less than 1e-4 from one
// period to the next, which is how such maps are made today. Process CPU time, one thread, median of several
// repetitions.
//
// What the exact derivatives of one peak by inertance (or damping), friction and frequency cost beside the
// orbit.
//
// And what the smoothed law costs here: the arctan law by CVODES and shooting, to 1e-8 and better, beside the
// exact law at the same points.
//
//   benchmark_orbits            everything
//   benchmark_orbits --no-peer  Frahm only
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <cstring>
#include <ctime>
#include <numbers>
#include <vector>

#include "solvers/response/periodic_response.hpp"

namespace {

using namespace frahm;
using mechanics::ElementType;
using mechanics::ExcitationKind;
using mechanics::Network;
using mechanics::NetworkValues;
using mechanics::NodeKind;
using std::numbers::pi;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// A map of rows of frequencies, and the equation of motion of its smoothed twin.
struct Work {
  const char* name;
  Network network;
  std::vector<std::vector<NetworkValues>> rows;
  double (*peer_peak)(const NetworkValues&);
};

// x'' + 2 zeta x' + x + f Sgn(x') = cos(r t), zeta = 0.02, r in 0.2..2, f in 0..0.7.
double single_mass_peak(const NetworkValues& values);
Work single_mass() {
  Work work{"one mass", {}, {}, single_mass_peak};
  const mechanics::Node ground{NodeKind::ground, 0}, mass{NodeKind::mass, 0};
  work.network.masses = {"mass"};
  work.network.elements = {{"spring", ElementType::spring, ground, mass},
                           {"damper", ElementType::damper, ground, mass},
                           {"friction", ElementType::coulomb, ground, mass}};
  work.network.excitations = {{ExcitationKind::force, 0, 1}};
  for (int i = 0; i <= 28; ++i) {
    std::vector<NetworkValues> row;
    for (int k = 0; k <= 400; ++k) {
      row.push_back({0.2 + 1.8 * k / 400.0, {1.0}, {1.0, 0.04, 0.025 * i}, {{1.0, 0.0}}});
    }
    work.rows.push_back(std::move(row));
  }
  return work;
}

// The rig (README, studies/rig/rig_atlas.toml): 150..350 rpm, friction 0..0.3, inertance 4.72, 8.81, 12.9 kg.
double rig_peak(const NetworkValues& values);
Work rig() {
  Work work{"rig", {}, {}, rig_peak};
  const mechanics::Node ground{NodeKind::ground, 0}, main{NodeKind::mass, 0}, tmd{NodeKind::mass, 1};
  const mechanics::Node exciter{NodeKind::prescribed, 0};
  work.network.masses = {"main", "tmd"};
  work.network.prescribed = {"exciter"};
  work.network.elements = {
      {"suspension", ElementType::spring, ground, main}, {"drive", ElementType::spring, exciter, main},
      {"guide", ElementType::coulomb, ground, main},     {"guide_damper", ElementType::damper, ground, main},
      {"tmd_spring", ElementType::spring, main, tmd},    {"tmd_damper", ElementType::damper, main, tmd},
      {"inerter", ElementType::inerter, main, tmd},      {"tmd_friction", ElementType::coulomb, main, tmd}};
  work.network.excitations = {{ExcitationKind::motion, 0, 1}};
  for (const double inertance : {4.72, 8.81, 12.9}) {
    for (int i = 0; i <= 30; ++i) {
      std::vector<NetworkValues> row;
      for (int k = 0; k <= 400; ++k) {
        const double omega = (150.0 + 0.5 * k) * pi / 30.0;
        row.push_back({omega,
                       {102.66, 12.82},
                       {6 * 8181.0, 8181.0, 0.01 * i * 8181.0 * 0.02955, 1.7688, 10985.1,
                        26.5104 + 0.4811 * inertance, inertance, 15.0109},
                       {{0.02955, -pi / 2}}});
      }
      work.rows.push_back(std::move(row));
    }
  }
  return work;
}

// Seconds per orbit, median of `repetitions`; `sum` keeps the work from being optimised away.
double frahm_seconds(const Work& work, const std::vector<periodic::Quantity>& quantities, periodic::Path path,
                     int repetitions) {
  std::vector<double> seconds;
  std::vector<double> out;
  std::vector<periodic::ResponseSummary> found;
  std::size_t orbits = 0;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    periodic::PeriodicResponse response(work.network, quantities, path);
    orbits = 0;
    const double start = cpu_seconds();
    for (const auto& row : work.rows) {
      out.resize(row.size() * quantities.size());
      found.resize(row.size());
      response.solve_row(row, found, out);
      orbits += row.size();
    }
    seconds.push_back((cpu_seconds() - start) / static_cast<double>(orbits));
  }
  std::nth_element(seconds.begin(), seconds.begin() + repetitions / 2, seconds.end());
  return seconds[static_cast<std::size_t>(repetitions / 2)];
}

// Every orbit from its element values, as an optimiser asks for it, and three derivatives of one peak.
void time_gradients(const Work& work) {
  periodic::PeriodicResponse response(work.network, {{periodic::Measure::peak, 0}});
  NetworkValues zero = work.rows[0][0];
  zero.omega = 0.0;
  for (double& mass : zero.mass) mass = 0.0;
  for (double& element : zero.element) element = 0.0;
  for (auto& excitation : zero.excitation) excitation = {};
  std::vector<NetworkValues> directions(3, zero);
  directions[0].element[work.network.masses.size() > 1 ? 6 : 1] = 1.0;
  directions[1].element[2] = 1.0;
  directions[2].omega = 1.0;
  std::array<double, 3> gradient{};
  double peak = 0.0, orbits = 0.0, derivatives = 0.0;
  std::size_t points = 0;
  for (std::size_t row = 1; row < work.rows.size(); row += 7) {
    for (const NetworkValues& values : work.rows[row]) {
      const double start = cpu_seconds();
      response.set_values(values);
      response.solve();
      response.quantities({&peak, 1});
      const double solved = cpu_seconds();
      response.gradient(directions, gradient);
      orbits += solved - start;
      derivatives += cpu_seconds() - solved;
      ++points;
    }
  }
  const double per_point = 1e6 / static_cast<double>(points);
  fmt::print(
      "{:9} one peak, new element values each time: {:.2f} us an orbit; its derivatives by three parameters: "
      "{:.2f} us\n",
      work.name, orbits * per_point, derivatives * per_point);
}

double smooth_sign(double v) {
  return 2.0 / pi * std::atan(1e5 * v);
}

// Peak of coordinate 0 in steady state, by dopri5 with tolerances 1e-3 (relative) and 1e-6 (absolute).
template <std::size_t Size, class Rate>
double integrated_peak(const Rate& rate, double omega, double relative_unit) {
  namespace odeint = boost::numeric::odeint;
  using State = std::array<double, Size>;
  State state{};
  const auto stepper =
      odeint::make_controlled(1e-6 * relative_unit, 1e-3, odeint::runge_kutta_dopri5<State>());
  const double period = 2.0 * pi / omega;
  constexpr int kMostPeriods = 2000;
  double last = 0.0;
  for (int cycle = 0; cycle < kMostPeriods; ++cycle) {
    double peak = 0.0;
    odeint::integrate_adaptive(stepper, rate, state, cycle * period, (cycle + 1) * period, period / 200.0,
                               [&](const State& x, double) { peak = std::max(peak, std::abs(x[0])); });
    if (cycle > 3 && std::abs(peak - last) < 1e-4 * peak) return peak;
    last = peak;
  }
  return last;
}

double single_mass_peak(const NetworkValues& values) {
  using State = std::array<double, 2>;
  const auto rate = [&](const State& x, State& dx, double t) {
    dx[0] = x[1];
    dx[1] =
        std::cos(values.omega * t) - values.element[1] * x[1] - x[0] - values.element[2] * smooth_sign(x[1]);
  };
  return integrated_peak<2>(rate, values.omega, 1.0);
}

double rig_peak(const NetworkValues& values) {
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
  return integrated_peak<4>(rate, values.omega, 1e-2);
}

void compare(const Work& work, double frahm) {
  periodic::PeriodicResponse response(work.network, {{periodic::Measure::peak, 0}});
  std::vector<double> errors;
  std::size_t points = 0;
  const double start = cpu_seconds();
  double outside = 0.0;  // time of the exact orbits, not the peer's
  for (std::size_t row = 1; row < work.rows.size(); row += 7) {
    for (std::size_t k = 13; k < work.rows[row].size(); k += 97) {
      const double peak = work.peer_peak(work.rows[row][k]);
      ++points;
      const double exact_start = cpu_seconds();
      double exact = 0.0;
      response.forget();
      response.set_values(work.rows[row][k]);
      response.solve();
      response.quantities({&exact, 1});
      if (exact > 1e-6 * work.rows[row][k].excitation[0].amplitude)
        errors.push_back(std::abs(peak / exact - 1.0));
      outside += cpu_seconds() - exact_start;
    }
  }
  const double peer = (cpu_seconds() - start - outside) / static_cast<double>(points);
  std::sort(errors.begin(), errors.end());
  fmt::print(
      "{:9} odeint dopri5 1e-3/1e-6: {:.2e} s a point ({} points), error median {:.0e}, largest {:.0e}; "
      "Frahm is {:.0f} times as fast\n",
      work.name, peer, points, errors[errors.size() / 2], errors.back(), peer / frahm);
}

// Every 7th row, every 97th point: the exact orbit from nothing known, and that of the arctan law of slope
// 1e5.
void compare_laws(const Work& work) {
  Network smooth = work.network;
  for (mechanics::Element& element : smooth.elements) {
    if (element.type == ElementType::coulomb) element.law = mechanics::FrictionLaw::arctan;
  }
  const std::vector<periodic::Quantity> peak{{periodic::Measure::peak, 0}};
  periodic::PeriodicResponse exact(work.network, peak), arctan(smooth, peak);
  double exact_seconds = 0.0, arctan_seconds = 0.0, value = 0.0;
  std::size_t points = 0, found = 0;
  const auto timed = [&](periodic::PeriodicResponse& response, const NetworkValues& values, double& seconds) {
    const double start = cpu_seconds();
    response.forget();
    response.set_values(values);
    response.solve();
    response.quantities({&value, 1});
    seconds += cpu_seconds() - start;
  };
  for (std::size_t row = 1; row < work.rows.size(); row += 7) {
    for (std::size_t k = 13; k < work.rows[row].size(); k += 97) {
      NetworkValues values = work.rows[row][k];
      timed(exact, values, exact_seconds);
      values.second.assign(values.element.size(), 1e5);
      timed(arctan, values, arctan_seconds);
      ++points;
      if (!std::isnan(value)) ++found;
    }
  }
  const double per_point = 1.0 / static_cast<double>(points);
  fmt::print(
      "{:9} arctan law, slope 1e5, CVODES: {:.2e} s a point ({} of {} points found); exact law at the same "
      "points, each from nothing: {:.2e} s; ratio {:.0f}\n",
      work.name, arctan_seconds * per_point, found, points, exact_seconds * per_point,
      arctan_seconds / exact_seconds);
}

}  // namespace

int main(int argc, char** argv) {
  const bool with_peer = argc < 2 || std::strcmp(argv[1], "--no-peer") != 0;
  constexpr int kRepetitions = 5;
  for (const Work& work : {single_mass(), rig()}) {
    std::vector<periodic::Quantity> peaks;
    for (std::size_t i = 0; i < work.network.masses.size(); ++i)
      peaks.push_back({periodic::Measure::peak, i});
    double kernel = 0.0;
    for (const auto path : {periodic::Path::general, periodic::Path::fastest}) {
      kernel = frahm_seconds(work, peaks, path, kRepetitions);
      const double standard = frahm_seconds(work, periodic::standard_quantities(work.network), path, kRepetitions);
      fmt::print(
          "{:9} {} peaks only: {:.3f} us an orbit, {:.0f} orbits/s a core; standard quantities: {:.3f} us, {:.0f} "
          "orbits/s\n",
          work.name, path == periodic::Path::general ? "general" : "fastest", 1e6 * kernel, 1.0 / kernel,
          1e6 * standard, 1.0 / standard);
    }
    time_gradients(work);
    compare_laws(work);
    if (with_peer) compare(work, kernel);
  }
}
