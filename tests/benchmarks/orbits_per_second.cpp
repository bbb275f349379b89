// What an orbit costs, in process CPU time of one thread, medians of five; as Markdown, to be kept with the
// machine, the compiler, the date and the commit.
//
//  - maps in memory, by shooting alone and the fastest way: microseconds an orbit with peaks and with the
//  standard
//    quantities, and what share of the points and of the time is left to shooting
//  - each instruction set that runs here
//  - beside peers on the same points in the same run: Boost.odeint, loose and tight; shooting on the
//  sensitivities of
//    CVODES (Frahm's arctan law of slope 1e5)
//  - the exact derivatives of one peak by three parameters
//
//   benchmark_orbits            everything, some two minutes
//   benchmark_orbits --no-peer  Frahm only
//   benchmark_orbits --smoke    a few points of each, to see that it works
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <ctime>
#include <vector>

#include "solvers/nonstop/nonstop_solver.hpp"
#include "solvers/orbits/orbit.hpp"
#include "solvers/response/periodic_response.hpp"
#include "tests/benchmarks/peers.hpp"
#include "tests/benchmarks/works.hpp"

namespace {

using namespace frahm;
using namespace frahm::benchmarks;
using mechanics::NetworkValues;
using periodic::Path;
using periodic::PeriodicResponse;
using periodic::Quantity;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

std::size_t points_of(const Work& work) {
  std::size_t points = 0;
  for (const auto& row : work.rows) points += row.size();
  return points;
}

std::vector<Quantity> peaks_of(const mechanics::Network& network) {
  std::vector<Quantity> peaks;
  for (std::size_t i = 0; i < network.masses.size(); ++i) peaks.push_back({periodic::Measure::peak, i});
  return peaks;
}

struct Timing {
  double seconds = 0.0;         // an orbit
  std::size_t by_shooting = 0;  // orbits
  double shooting = 0.0;        // share of the time, by the points left to shooting alone
};

// Solves every row. shooting: also how long the points that shooting found take by themselves.
Timing time_rows(const Work& work, const std::vector<Quantity>& quantities, Path path, int repetitions) {
  std::vector<double> seconds, left_seconds;
  std::vector<double> out;
  std::vector<periodic::ResponseSummary> found;
  Timing timing;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    PeriodicResponse response(work.network, quantities, path),
        general(work.network, quantities, Path::general);
    double spent = 0.0, left = 0.0;
    timing.by_shooting = 0;
    for (const auto& row : work.rows) {
      out.resize(row.size() * quantities.size());
      found.resize(row.size());
      const double start = cpu_seconds();
      response.solve_row(row, found, out);
      spent += cpu_seconds() - start;
      std::vector<NetworkValues> rest;
      for (std::size_t i = 0; i < row.size(); ++i) {
        if (found[i].way == periodic::Way::shooting) rest.push_back(row[i]);
      }
      timing.by_shooting += rest.size();
      if (path == Path::general || rest.empty()) continue;
      found.resize(rest.size());
      out.resize(rest.size() * quantities.size());
      const double again = cpu_seconds();
      general.solve_row(rest, found, out);
      left += cpu_seconds() - again;
    }
    seconds.push_back(spent / static_cast<double>(points_of(work)));
    left_seconds.push_back(left / spent);
  }
  timing.seconds = median(seconds);
  timing.shooting = median(left_seconds);
  return timing;
}

void compare_ways(const Work& work, int repetitions) {
  const std::vector<Quantity> peaks = peaks_of(work.network),
                              standard = periodic::standard_quantities(work.network);
  const Timing general_peaks = time_rows(work, peaks, Path::general, repetitions),
               fast_peaks = time_rows(work, peaks, Path::fastest, repetitions),
               general = time_rows(work, standard, Path::general, repetitions),
               fast = time_rows(work, standard, Path::fastest, repetitions);
  const auto points = static_cast<double>(points_of(work));
  fmt::print("| {} | {:.0f} | {:.3f} | {:.3f} | {:.1f} | {:.3f} | {:.3f} | {:.1f} | {:.2f} % | {:.0f} % |\n",
             work.name, points, 1e6 * general_peaks.seconds, 1e6 * fast_peaks.seconds,
             general_peaks.seconds / fast_peaks.seconds, 1e6 * general.seconds, 1e6 * fast.seconds,
             general.seconds / fast.seconds, 100.0 * static_cast<double>(fast_peaks.by_shooting) / points,
             100.0 * fast_peaks.shooting);
}

// Seconds an orbit of the points that an instruction set finds.
double time_kernel(const Work& work, const std::vector<Quantity>& quantities,
                   const periodic::nonstop::Kernel& kernel, int repetitions) {
  const mechanics::Assembly assembly(work.network);
  std::vector<double> seconds, out(quantities.size());
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    periodic::nonstop::NonstopSolver solver(assembly, quantities);
    solver.use(kernel);
    const double start = cpu_seconds();
    for (const auto& row : work.rows) {
      if (!solver.set_row(row)) continue;
      for (std::size_t i = 0; i + periodic::nonstop::kLanes <= row.size(); i += periodic::nonstop::kLanes) {
        for (int lane = 0; lane < periodic::nonstop::kLanes; ++lane)
          solver.set_point(lane, row[i + static_cast<std::size_t>(lane)]);
        solver.solve(periodic::nonstop::kLanes);
        for (int lane = 0; lane < periodic::nonstop::kLanes; ++lane) {
          if (solver.is_found(lane)) solver.quantities(lane, out);
        }
      }
    }
    seconds.push_back((cpu_seconds() - start) / static_cast<double>(points_of(work)));
  }
  return median(seconds);
}

void compare_instruction_sets(const Work& work, int repetitions) {
  for (const periodic::nonstop::Kernel& kernel : periodic::nonstop::kernels()) {
    if (!kernel.runs_here) continue;
    fmt::print("| {} | {} | {:.2f} | {:.2f} |\n", work.name, kernel.name,
               1e-6 / time_kernel(work, peaks_of(work.network), kernel, repetitions),
               1e-6 / time_kernel(work, periodic::standard_quantities(work.network), kernel, repetitions));
  }
}

struct Peer {
  const char* name;
  double seconds = 0.0;  // a point
  std::vector<double> errors = {};
};

void tell_peer(const Work& work, Peer& peer, double own) {
  std::ranges::sort(peer.errors);
  fmt::print("| {} | {} | {:.2e} | {:.0e} | {:.0e} | {:.0f} |\n", work.name, peer.name, peer.seconds,
             peer.errors[peer.errors.size() / 2], peer.errors.back(), peer.seconds / own);
}

// Beside the fastest way on the whole map; the peers on some of its points.
void compare_peers(const Work& work, double (*peer_peak)(const NetworkValues&, const PeerAccuracy&),
                   std::size_t every) {
  const std::vector<Quantity> peak{{periodic::Measure::peak, 0}};
  const double own = time_rows(work, peaks_of(work.network), Path::fastest, 5).seconds;
  mechanics::Network smooth = work.network;
  for (mechanics::Element& element : smooth.elements) {
    if (element.type == mechanics::ElementType::coulomb) element.law = mechanics::ForceLaw::arctan;
  }
  PeriodicResponse exact(work.network, peak), shooting(smooth, peak);
  Peer loose{"Boost.odeint dopri5 1e-3/1e-6, settled to 1e-4"},
      tight{"Boost.odeint dopri5 1e-8, settled to 1e-8"}, cvodes{"CVODES shooting"};
  std::size_t points = 0;
  const auto timed = [](Peer& peer, double reference, const auto& solve) {
    const double start = cpu_seconds();
    const double found = solve();
    peer.seconds += cpu_seconds() - start;
    if (std::isfinite(found) && reference > 0.0) peer.errors.push_back(std::abs(found / reference - 1.0));
  };
  for (std::size_t row = 1; row < work.rows.size(); row += 7) {
    for (std::size_t k = 13; k < work.rows[row].size(); k += every) {
      NetworkValues values = work.rows[row][k];
      double reference = 0.0;
      periodic::ResponseSummary summary;
      exact.solve_row({&values, 1}, {&summary, 1}, {&reference, 1});
      timed(loose, reference, [&] { return peer_peak(values, {}); });
      timed(tight, reference, [&] { return peer_peak(values, {1e-8, 1e-8, 1e-8}); });
      values.smooth.assign(values.element.size(), {.slope = 1e5});
      timed(cvodes, reference, [&] {
        double found = 0.0;
        shooting.forget();
        shooting.set_values(values);
        shooting.solve();
        shooting.quantities({&found, 1});
        return found;
      });
      ++points;
    }
  }
  for (Peer* peer : {&loose, &tight, &cvodes}) {
    peer->seconds /= static_cast<double>(points);
    tell_peer(work, *peer, own);
  }
}

// Every orbit from its element values, as an optimiser asks for it, and three derivatives of one peak.
void time_gradients(const Work& work) {
  PeriodicResponse response(work.network, {{periodic::Measure::peak, 0}});
  NetworkValues zero = work.rows[0][0];
  zero.omega = 0.0;
  for (double& mass : zero.mass) mass = 0.0;
  for (double& element : zero.element) element = 0.0;
  for (auto& excitation : zero.excitation) excitation = {};
  std::vector<NetworkValues> directions(3, zero);
  directions[0].element[1] = 1.0;
  directions[1].element[2] = 1.0;
  directions[2].omega = 1.0;
  std::array<double, 3> gradient{};
  double peak = 0.0, orbits = 0.0, derivatives = 0.0;
  std::size_t points = 0;
  for (std::size_t row = 0; row < work.rows.size(); row += 7) {
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
  fmt::print("| {} | {:.2f} | {:.2f} |\n", work.name, orbits * per_point, derivatives * per_point);
}

}  // namespace

int main(int argc, char** argv) {
  const auto asked = [&](const char* option) {
    return std::any_of(argv + 1, argv + argc,
                       [&](const char* given) { return std::strcmp(given, option) == 0; });
  };
  const bool smoke = asked("--smoke");
  const int repetitions = smoke ? 1 : 5;
  const auto whole = [&](Work work) { return smoke ? thinned(std::move(work), 10, 20) : work; };
  fmt::print("{:%F}, g++ {}, {}\n\n", fmt::gmtime(std::time(nullptr)), __VERSION__,
             periodic::nonstop::fastest_kernel().name);

  fmt::print(
      "| map | points | us per orbit, peaks: shooting | fastest | ratio | standard: shooting | fastest | "
      "ratio | points solved by shooting | their share of the time (peaks) "
      "|\n|---|---|---|---|---|---|---|---|---|---|\n");
  const Work small = whole(one_mass()), large = whole(rig(smoke ? 3 : 42));
  compare_ways(small, repetitions);
  compare_ways(whole(den_hartog()), repetitions);
  compare_ways(large, smoke ? 1 : 3);
  compare_ways(whole(five_masses()), repetitions);
  for (const int storeys : {10, 20, 40, 60}) {
    if (smoke && storeys > 10) break;
    compare_ways(thinned(shear_building(storeys, storeys), 1, smoke ? 40 : storeys > 20 ? 10 : 1), 1);
  }

  fmt::print("\n| map | instruction set | million orbits/s, peaks | standard |\n|---|---|---|---|\n");
  compare_instruction_sets(small, repetitions);
  compare_instruction_sets(large, repetitions);

  fmt::print(
      "\n| map | us per orbit from new elements | us for three derivatives of a peak |\n|---|---|---|\n");
  time_gradients(small);
  time_gradients(whole(rig(3)));

  if (asked("--no-peer")) return 0;
  fmt::print(
      "\n| map | peer | s per point | median error | largest | speed-up of Frahm "
      "|\n|---|---|---|---|---|"
      "---|\n");
  compare_peers(small, one_mass_peak, smoke ? 8 : 97);
  compare_peers(whole(rig(3)), rig_peak, smoke ? 8 : 97);
}
