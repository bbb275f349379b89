#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "solvers/nonstop/nonstop_solver.hpp"
#include "solvers/orbits/orbit.hpp"
#include "solvers/response/periodic_response.hpp"
#include "tests/known_answers/random_network.hpp"
#include "tests/known_answers/rig.hpp"
#include "tests/known_answers/single_mass.hpp"
#include "tests/solvers/nonstop/two_ways.hpp"

#if defined(FRAHM_KERNELS_FROM_V3)
namespace frahm::periodic::nonstop {
Solve solve_portable;  // compiled with this program
}
#endif

// Orbits from the phases of their events, next to the same ones by shooting.
namespace frahm::periodic::nonstop_test {
namespace {

using Catch::Matchers::WithinAbs;
constexpr double kSame = 1e-10;      // of values, as difference() takes it
constexpr double kSamePhase = 1e-6;  // of an element's phase lag [rad], which may be that of a slight motion

struct Found {
  ResponseSummary summary;
  std::vector<double> values;
};

Found solved(const mechanics::Network& network, const mechanics::NetworkValues& values,
             const std::vector<Quantity>& quantities, Path path) {
  Found found{{}, std::vector<double>(quantities.size())};
  PeriodicResponse response(network, quantities, path);
  response.solve_row({&values, 1}, {&found.summary, 1}, found.values);
  return found;
}

// Networks of 1 to 6 masses with 0 to 4 contacts, odd and even orders, tiny and huge friction, strong
// dampers.
RandomNetwork drawn(unsigned seed) {
  static const std::vector<std::vector<int>> orders{{1}, {1, 3}, {1, 2}, {0, 1}, {1}, {2, 3}, {1, 5}, {1}};
  std::mt19937 random(seed);
  RandomNetworkOptions options;
  options.masses = 1 + static_cast<int>(seed % 6);
  options.contacts = static_cast<int>(seed / 6 % 5);
  options.maxwell_elements = seed % 7 == 0 ? 1 : 0;
  options.hysteretic = seed % 11 == 0;
  options.orders = orders[seed / 30 % orders.size()];
  options.largest_friction = std::pow(10.0, -3.0 + (seed % 13) / 4.0);
  options.shaken = seed % 17 != 0;
  RandomNetwork result = random_network(options, random);
  if (seed % 5 == 0) {
    for (std::size_t e = 0; e < result.network.elements.size(); ++e) {
      if (result.network.elements[e].type == mechanics::ElementType::damper) result.values.element[e] *= 30.0;
    }
  }
  return result;
}

double tolerance_of(Measure measure) {
  return measure == Measure::element_phase ? kSamePhase : kSame;
}

// Whether displacements are apart by no more than both ways say that they may be.
bool is_within_bounds(const std::vector<Quantity>& quantities, const Found& a, const Found& b) {
  double apart = 0.0;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    if (quantities[i].measure == Measure::peak) apart = std::max(apart, std::abs(a.values[i] - b.values[i]));
  }
  return apart <= value_of(Measure::error_bound, 0, quantities, a.values) +
                      value_of(Measure::error_bound, 0, quantities, b.values);
}

void compare_with_shooting(unsigned first_seed, unsigned count) {
  unsigned non_stop = 0, from_phases = 0;
  for (unsigned seed = first_seed; seed < first_seed + count; ++seed) {
    INFO("seed " << seed);
    const RandomNetwork network = drawn(seed);
    const std::vector<Quantity> quantities = all_quantities(network.network);
    const Found general = solved(network.network, network.values, quantities, Path::general);
    const Found fastest = solved(network.network, network.values, quantities, Path::fastest);
    CHECK(fastest.summary.status == general.summary.status);
    if (general.summary.status == Status::ok) {
      bool sticks = false;
      for (std::size_t i = 0; i < quantities.size(); ++i)
        sticks = sticks || (quantities[i].measure == Measure::stuck_fraction && general.values[i] > 0.0);
      if (!sticks) ++non_stop;
    }
    if (fastest.summary.way != Way::event_phases) continue;
    ++from_phases;
    for (std::size_t i = 0; i < quantities.size(); ++i) {
      const Measure measure = quantities[i].measure;
      if (is_of_computation(measure)) continue;
      const double apart = difference(i, quantities, general.values, fastest.values);
      if (apart <= tolerance_of(measure) || is_within_bounds(quantities, general, fastest)) continue;
      INFO(describe(quantities[i], network.network, false).name << " " << general.values[i] << " and "
                                                                << fastest.values[i]);
      CHECK(apart <= tolerance_of(measure));
    }
  }
  CHECK(from_phases > 0.7 * count);
  CHECK(from_phases > 0.97 * non_stop);  // those of several orders may have another number of reversals
}

TEST_CASE("random networks have the same non-stop orbits from their reversal phases as by shooting",
          "[slow]") {
  compare_with_shooting(0, 400);
}

TEST_CASE("3600 more random networks have the same orbits from their reversal phases", "[long]") {
  compare_with_shooting(400, 3600);
}

TEST_CASE("an orbit from its reversal phases keeps within the error bounds of both ways") {
  for (unsigned seed = 0; seed < 400; ++seed) {
    const RandomNetwork network = drawn(seed);
    const std::vector<Quantity> quantities = all_quantities(network.network);
    const Found general = solved(network.network, network.values, quantities, Path::general);
    const Found fastest = solved(network.network, network.values, quantities, Path::fastest);
    const double bound = value_of(Measure::error_bound, 0, quantities, general.values);
    if (fastest.summary.way != Way::event_phases || std::isnan(bound)) continue;
    INFO("seed " << seed);
    CHECK(std::isfinite(value_of(Measure::error_bound, 0, quantities, fastest.values)));
    CHECK(is_within_bounds(quantities, general, fastest));
  }
}

// f below which a single mass without damping never sticks (Den Hartog 1931), by what shooting says.
TEST_CASE("one mass sticks from its reversal phases where it sticks by shooting, and nowhere else") {
  const mechanics::Network network = single_mass();
  const std::vector<Quantity> quantities = all_quantities(network);
  int sticks = 0, slides = 0, close = 0;  // close: next to another orbit, and left to shooting
  for (double r = 0.15; r < 2.0; r += 0.037) {
    for (double f = 0.0; f < 1.05; f += 0.021) {
      INFO("r " << r << ", f " << f);
      const mechanics::NetworkValues values = single_mass_values(r, 0.02, f);
      const Found general = solved(network, values, quantities, Path::general);
      const Found fastest = solved(network, values, quantities, Path::fastest);
      const auto stops = [&](const Found& found) {
        return value_of(Measure::stops, 2, quantities, found.values);
      };
      CHECK(stops(fastest) == stops(general));
      const double stuck = value_of(Measure::stuck_fraction, 2, quantities, general.values);
      CHECK_THAT(value_of(Measure::stuck_fraction, 2, quantities, fastest.values), WithinAbs(stuck, kSame));
      if (stuck == 0.0 && fastest.summary.way == Way::shooting) ++close;
      if (fastest.summary.way == Way::event_phases) ++(stuck > 0.0 ? sticks : slides);
    }
  }
  CHECK(close < 0.005 * slides);
  CHECK(sticks > 300);
  CHECK(slides > 500);
}

// A row of frequencies of one mass.
std::vector<mechanics::NetworkValues> single_mass_row(double zeta, double f) {
  std::vector<mechanics::NetworkValues> row;
  for (double r = 0.1001; r < 2.0; r += 0.0095) row.push_back(single_mass_values(r, zeta, f));
  return row;
}

TEST_CASE("Den Hartog's map: of all points one in sixteen at most is left to shooting, and each closes") {
  const mechanics::Network network = single_mass();
  const std::vector<Quantity> quantities{{Measure::peak, 0}, {Measure::residual}};
  PeriodicResponse response(network, quantities);
  int points = 0, shot = 0;
  for (int i = 0; i <= 44; i += 4) {
    const auto row = single_mass_row(0.0, 0.025 * i);
    std::vector<ResponseSummary> found(row.size());
    std::vector<double> values(row.size() * quantities.size());
    response.solve_row(row, found, values);
    for (std::size_t k = 0; k < row.size(); ++k) {
      INFO("r " << row[k].omega << ", f " << 0.025 * i);
      CHECK(values[k * quantities.size() + 1] < 1e-12);
      ++points;
      if (found[k].way == Way::shooting) ++shot;
    }
  }
  CHECK(16 * shot < points);
}

TEST_CASE("a mass that the force only just cannot move rests, and grazes, both ways") {
  const mechanics::Network network = single_mass();
  const std::vector<Quantity> quantities = all_quantities(network);
  const mechanics::NetworkValues values = single_mass_values(0.7, 0.02, 1.0);
  for (const Path path : {Path::general, Path::fastest}) {
    const Found found = solved(network, values, quantities, path);
    CHECK(found.summary.status == Status::grazing);
    CHECK(value_of(Measure::stuck_fraction, 2, quantities, found.values) == 1.0);
    CHECK(value_of(Measure::peak, 0, quantities, found.values) == 0.0);
  }
  CHECK(solved(network, values, quantities, Path::fastest).summary.way == Way::event_phases);
}

// In a row an orbit by shooting begins where the one before did. Next to resonance the mass rests there, and
// what closes to 1e-14 of the static response is not equal to 1e-12 of the slight one on both sides.
TEST_CASE("the phase of a peak at a stop is the same both ways, wherever the orbit begins") {
  constexpr double kSamePeakPhase = 1e-9;  // [rad]
  const mechanics::Network network = single_mass();
  const std::vector<Quantity> quantities{{Measure::peak_phase, 0}};
  std::vector<mechanics::NetworkValues> row;
  for (const double r : {0.20000001,
                         0.209004,
                         0.23994,
                         0.25,
                         0.275456,
                         0.316228,
                         0.3333332333333333,
                         0.3333333333333333,
                         0.3333333333334333,
                         0.33333333433333334,
                         0.363035,
                         0.416771,
                         0.47846,
                         0.49999999,
                         0.5,
                         0.5000000001,
                         0.54928,
                         0.630583,
                         0.723921,
                         0.831074,
                         0.954087,
                         0.999999,
                         0.999999999,
                         0.99999999999999,
                         1.0,
                         1.000000000001,
                         1.000000001,
                         1.000001})
    row.push_back(single_mass_values(r, 0.001, 0.9));
  std::vector<ResponseSummary> found(row.size());
  std::vector<double> general(row.size()), fastest(row.size());
  PeriodicResponse(network, quantities, Path::general).solve_row(row, found, general);
  PeriodicResponse(network, quantities).solve_row(row, found, fastest);
  for (std::size_t k = 0; k < row.size(); ++k) {
    INFO("r " << row[k].omega);
    // Half a period later the peak is as high on the other side.
    CHECK_THAT(std::remainder(general[k] - fastest[k], std::numbers::pi), WithinAbs(0.0, kSamePeakPhase));
  }
}

// The rig's map: a row of frequencies.
std::vector<mechanics::NetworkValues> rig_row(double I, double share) {
  std::vector<mechanics::NetworkValues> row;
  for (double rpm = 150.0; rpm <= 350.0; rpm += 1.7)
    row.push_back(rig_values(rpm * std::numbers::pi / 30.0, I, share));
  return row;
}

// Those of the library, and the portable one.
std::vector<nonstop::Kernel> compared_kernels() {
  const auto all = nonstop::kernels();
  std::vector<nonstop::Kernel> compared(all.begin(), all.end());
#if defined(FRAHM_KERNELS_FROM_V3)
  compared.push_back({"portable", true, nonstop::solve_portable});
#endif
  return compared;
}

TEST_CASE("every instruction set gives the same bytes") {
  const mechanics::Network network = rig();
  const std::vector<Quantity> quantities = all_quantities(network);
  const mechanics::Assembly assembly(network);
  const std::vector<mechanics::NetworkValues> row = rig_row(8.81, 0.1);
  std::vector<std::vector<double>> of_kernel;
  for (const nonstop::Kernel& kernel : compared_kernels()) {
    if (!kernel.runs_here) continue;
    nonstop::NonstopSolver solver(assembly, quantities);
    solver.use(kernel);
    REQUIRE(solver.set_row(row));
    std::vector<double> values(nonstop::kLanes * quantities.size());
    for (int lane = 0; lane < nonstop::kLanes; ++lane)
      REQUIRE(solver.set_point(lane, row[static_cast<std::size_t>(7 * lane)]));
    solver.solve(nonstop::kLanes);
    for (int lane = 0; lane < nonstop::kLanes; ++lane) {
      REQUIRE(solver.is_found(lane));
      const auto first = static_cast<std::size_t>(lane) * quantities.size();
      REQUIRE(solver.quantities(lane, std::span(values).subspan(first, quantities.size())));
    }
    of_kernel.push_back(values);
  }
  REQUIRE(of_kernel.size() >= 2);
  for (const auto& values : of_kernel) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      INFO(describe(quantities[i % quantities.size()], network, false).name);
      const bool same =
          values[i] == of_kernel[0][i] || (std::isnan(values[i]) && std::isnan(of_kernel[0][i]));
      CHECK(same);
    }
  }
}

TEST_CASE("a point of a row has the same values alone, and in any company") {
  const mechanics::Network network = rig();
  const std::vector<Quantity> quantities = standard_quantities(network);
  const std::vector<mechanics::NetworkValues> row = rig_row(4.72, 0.2);
  PeriodicResponse response(network, quantities);
  const auto solve = [&](const std::vector<mechanics::NetworkValues>& points) {
    std::vector<ResponseSummary> found(points.size());
    std::vector<double> values(points.size() * quantities.size());
    response.solve_row(points, found, values);
    CHECK(std::ranges::all_of(found, [](const auto& point) { return point.way == Way::event_phases; }));
    return values;
  };
  const std::vector<double> forwards = solve(row);
  const std::vector<double> backwards = solve({row.rbegin(), row.rend()});
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::vector<double> alone = solve({row[i]});
    for (std::size_t q = 0; q < quantities.size(); ++q) {
      CHECK(alone[q] == forwards[i * quantities.size() + q]);
      CHECK(alone[q] == backwards[(row.size() - 1 - i) * quantities.size() + q]);
    }
  }
}

TEST_CASE("a point of a row whose values are refused has the reason, and the others their orbits") {
  const mechanics::Network network = single_mass();
  const std::vector<Quantity> quantities{{Measure::peak, 0}};
  std::vector<mechanics::NetworkValues> row;
  for (int i = 0; i < 20; ++i) row.push_back(single_mass_values(0.3 + 0.1 * i, 0.05, 0.1));
  row[7].omega = -1.0;
  row[13].excitation[0].amplitude = NAN;
  std::vector<ResponseSummary> found(row.size());
  std::vector<double> values(row.size());
  PeriodicResponse response(network, quantities);
  response.solve_row(row, found, values);
  for (std::size_t i = 0; i < row.size(); ++i) {
    INFO(i);
    const bool is_refused = i == 7 || i == 13;
    CHECK(found[i].status == (is_refused ? Status::not_computed : Status::ok));
    CHECK(found[i].reason.empty() == !is_refused);
  }
  CHECK_THAT(found[7].reason, Catch::Contains("angular frequency"));
}

TEST_CASE("a mass whose inverse is no number has no modes, and its points the reason") {
  mechanics::NetworkValues values = single_mass_values(0.9, 0.05, 0.2);
  for (const double mass : {1e-310, 1e-320}) {
    values.mass[0] = mass;
    const Found found = solved(single_mass(), values, {{Measure::peak, 0}}, Path::fastest);
    CHECK_THAT(found.summary.reason, Catch::Contains("no finite rate"));
  }
}

TEST_CASE("a row whose friction changes has the orbits of its points") {
  const mechanics::Network network = rig();
  const std::vector<Quantity> quantities = all_quantities(network);
  std::vector<mechanics::NetworkValues> row;
  for (int i = 0; i <= 20; ++i) row.push_back(rig_values(24.0, 6.0, 0.01 * i, 2.0 * i));
  std::vector<ResponseSummary> found(row.size());
  std::vector<double> values(row.size() * quantities.size());
  PeriodicResponse response(network, quantities);
  response.solve_row(row, found, values);
  for (std::size_t i = 0; i < row.size(); ++i) {
    const Found general = solved(network, row[i], quantities, Path::general);
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(i * quantities.size());
    const std::vector<double> own(first, first + static_cast<std::ptrdiff_t>(quantities.size()));
    CHECK(found[i].way == Way::event_phases);
    for (std::size_t q = 0; q < quantities.size(); ++q) {
      INFO(i << " " << describe(quantities[q], network, false).name);
      if (!is_of_computation(quantities[q].measure))
        CHECK(difference(q, quantities, general.values, own) <= tolerance_of(quantities[q].measure));
    }
  }
}

}  // namespace
}  // namespace frahm::periodic::nonstop_test
