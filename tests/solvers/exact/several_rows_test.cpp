// Rows of systems that may have several responses: searched there and back, or swept.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "solvers/orbits/orbit.hpp"
#include "solvers/response/periodic_response.hpp"
#include "tests/known_answers/single_mass.hpp"

namespace frahm::periodic::several_rows_test {
namespace {

using Catch::Matchers::WithinAbs, Catch::Matchers::WithinRel;
using namespace mechanics;
using Show = OrbitsWanted::Show;

constexpr double kUpperFold = 2.0018066685, kLowerFold = 1.4086707284;  // of two independent methods
constexpr double kPrinted = 1e-7;                                       // their figures of peaks
constexpr double kClosed = 1e-10;                                       // of closed forms, relative

const Node ground{}, mass{NodeKind::mass, 0};

// zeta = 0.05, stops of stiffness 4 at a clearance of 1, or of infinity below: then one-sided.
NetworkValues between_stops(double r) {
  return {.omega = r,
          .mass = {1.0},
          .element = {1.0, 0.1, 4.0},
          .excitation = {{1.0, 0.0}},
          .second = {0.0, 0.0, 0.0},
          .bends = {{}, {}, {{1.0, 4.0, 0.0}, {1.0, 4.0, 0.0}}}};
}

// zeta = 0.05, stiffness 9 without clearance on one side.
NetworkValues on_a_stop(double r) {
  NetworkValues values = between_stops(r);
  values.element[2] = 9.0;
  values.bends[2] = {{0.0, 9.0, 0.0}};
  return values;
}

Network mass_on_a_stop() {
  return driven_mass({elastic_stops({-1.0})});
}

struct Row {
  std::vector<ResponseSummary> found;
  std::vector<double> peaks;
};

Row solve_row(const Network& network, const std::vector<NetworkValues>& points, const OrbitsWanted& wanted) {
  PeriodicResponse response(network, {{Measure::peak, 0}}, Path::fastest, wanted);
  Row row{.found = std::vector<ResponseSummary>(points.size()), .peaks = std::vector<double>(points.size())};
  response.solve_row(points, row.found, row.peaks);
  return row;
}

std::vector<NetworkValues> at(NetworkValues (*values)(double), const std::vector<double>& frequencies) {
  std::vector<NetworkValues> points;
  for (const double r : frequencies) points.push_back(values(r));
  return points;
}

double linear_peak(double r) {
  return 1.0 / std::hypot(1.0 - r * r, 0.1 * r);
}

const std::vector<double> frequencies{1.0,
                                      1.2,
                                      1.3,
                                      1.4,
                                      1.4086,
                                      kLowerFold - 1e-6,
                                      1.409,
                                      1.45,
                                      1.5,
                                      1.6,
                                      1.9,
                                      2.0,
                                      2.001,
                                      kUpperFold - 1e-7,
                                      kUpperFold + 1e-5,
                                      2.01,
                                      2.2};

TEST_CASE("A sweep up stays on the large orbit to the fold, one down on the small orbit to the other") {
  const std::vector<NetworkValues> points = at(between_stops, frequencies);
  const Row up = solve_row(mass_between_stops(), points, {.show = Show::up});
  const Row down = solve_row(mass_between_stops(), points, {.show = Show::down});
  for (std::size_t i = 0; i < frequencies.size(); ++i) {
    const double r = frequencies[i];
    INFO("r " << r << ", up " << up.peaks[i] << ", down " << down.peaks[i]);
    CHECK(up.found[i].status == Status::ok);
    CHECK(down.found[i].status == Status::ok);
    const bool is_small_up = r > kUpperFold, is_small_down = r > kLowerFold;
    if (is_small_up) CHECK_THAT(up.peaks[i], WithinRel(linear_peak(r), kClosed));
    if (!is_small_up) CHECK(up.peaks[i] > 1.4);
    if (r > 1.42) CHECK_THAT(down.peaks[i], WithinRel(linear_peak(r), kClosed));
    if (is_small_down) CHECK(down.peaks[i] < 1.02);
    if (!is_small_down) CHECK_THAT(down.peaks[i], WithinRel(up.peaks[i], kClosed));
  }
  CHECK_THAT(up.peaks[9], WithinAbs(2.4531427, kPrinted));
  CHECK_THAT(up.peaks[13], WithinAbs(4.9326330, 2e-3));  // of the fold itself; falls like the root beside it
}

TEST_CASE("A sweep takes the points in the order of their frequencies, whatever the row's") {
  std::vector<NetworkValues> points = at(between_stops, frequencies);
  for (const Show show : {Show::up, Show::down}) {
    const Row forth = solve_row(mass_between_stops(), points, {.show = show});
    std::ranges::reverse(points);
    Row back = solve_row(mass_between_stops(), points, {.show = show});
    std::ranges::reverse(back.peaks);
    std::ranges::reverse(points);
    CHECK(forth.peaks == back.peaks);
  }
}

TEST_CASE("A sweep in steps as wide as the region of two orbits still tells where the orbit ends") {
  const std::vector<NetworkValues> points = at(between_stops, {1.2, 1.6, 1.95, 2.3});
  const Row up = solve_row(mass_between_stops(), points, {.show = Show::up});
  CHECK_THAT(up.peaks[1], WithinAbs(2.4531427, kPrinted));
  CHECK(up.peaks[2] > 3.5);
  CHECK_THAT(up.peaks[3], WithinRel(linear_peak(2.3), kClosed));
}

// From 2.1 to 3.0 the orbit of one period becomes unstable, and orbits of two and four periods are born.
TEST_CASE("A sweep follows an orbit through doublings of its period and back") {
  std::vector<double> r;
  for (double each = 2.1; each < 3.3; each += 0.02) r.push_back(each);
  const std::vector<NetworkValues> points = at(on_a_stop, r);
  for (const Show show : {Show::up, Show::down}) {
    const Row row = solve_row(mass_on_a_stop(), points, {.show = show});
    const auto most = std::ranges::max_element(row.found, {}, &ResponseSummary::multiple);
    CHECK(row.found.front().multiple == 1);
    CHECK(most->multiple >= 2);
    for (std::size_t i = 0; i < r.size(); ++i) {
      INFO("r " << r[i] << " " << row.found[i].reason);
      CHECK((row.found[i].status == Status::ok || row.found[i].status == Status::not_periodic));
      CHECK(std::isnan(row.peaks[i]) == (row.found[i].status == Status::not_periodic));
    }
  }
}

TEST_CASE("After a stretch without a periodic motion a sweep goes on from where the motion is") {
  std::vector<double> r;
  for (double each = 2.1; each < 3.3; each += 0.02) r.push_back(each);
  const OrbitsWanted wanted{.most_multiple = 1, .show = Show::down};
  const Row row = solve_row(mass_on_a_stop(), at(on_a_stop, r), wanted);
  CHECK(row.found.back().status == Status::not_periodic);
  CHECK(row.found.back().reason.find("the motion of the sweep") == 0);
  CHECK(row.found.back().coexisting == 0);
  CHECK(row.found.front().status == Status::ok);  // the orbit of one period is stable again
}

// From the linear response alone the large orbit is found below 1.41 only, and the small one above.
TEST_CASE("A search along a row finds the orbits of the points before and of those after") {
  std::vector<double> r;
  for (double each = 1.2; each < 1.99; each += 0.02) r.push_back(each);
  for (const bool falls : {false, true}) {
    if (falls) std::ranges::reverse(r);
    const Row row = solve_row(mass_between_stops(), at(between_stops, r), {.starts = 1});
    for (std::size_t i = 0; i < r.size(); ++i) {
      INFO((falls ? "falling" : "rising") << " r " << r[i]);
      if (r[i] > 1.42) CHECK(row.found[i].coexisting == 2);
      if (r[i] < 1.405) CHECK(row.found[i].coexisting == 1);
    }
    CHECK(*std::ranges::min_element(row.peaks) > 1.2);  // the largest is told
  }
}

// The force reaches the static limit and no further: rest is periodic there, but the least disturbance breaks
// it loose.
TEST_CASE("Rest at the very limit of a static force is no stable orbit, just below it is one") {
  const auto coexisting_at = [&](double F_s) {
    const NetworkValues values{.omega = 0.8,
                               .mass = {1.0},
                               .element = {1.0, 0.1, 0.2},
                               .excitation = {{1.0, 0.0}},
                               .second = {0.0, 0.0, F_s}};
    return solve_row(driven_mass({static_friction()}), {values}, {}).found.front().coexisting;
  };
  CHECK(coexisting_at(1.0) == 1);
  CHECK(coexisting_at(1.01) == 2);
}

// At r = sqrt(1.99) the linear response only just touches the stops: no multipliers, but disturbances die
// out.
TEST_CASE("An orbit that only just touches its stops is stable where disturbances die out") {
  const Row row = solve_row(mass_between_stops(), {between_stops(std::sqrt(1.99))}, {.starts = 16});
  CHECK(row.found.front().coexisting == 2);
  const Row small = solve_row(mass_between_stops(), {between_stops(std::sqrt(1.99))},
                              {.starts = 16, .show = Show::smallest});
  CHECK_THAT(small.peaks.front(), WithinRel(1.0, kClosed));
}

}  // namespace
}  // namespace frahm::periodic::several_rows_test
