#include "solvers/branches/coexisting_branches.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "linear_values.hpp"
#include "one_mass.hpp"
#include "solvers/response/periodic_response.hpp"

namespace frahm::periodic::coexisting_branches_test {
namespace {

using Catch::Matchers::WithinAbs;
using namespace mechanics;
using namespace one_mass;

constexpr double kPrinted = 1e-7;  // of figures by two independent methods
constexpr double kSame = 1e-8;     // of one orbit found in two ways
const std::vector<Quantity> asked{{Measure::peak, 0}, {Measure::mean, 0}};

// x'' + c x' + x + a stop of stiffness k beyond x = D, on the other side too where both: cos(r tau).
struct Stopped {
  double c, k, D;
  bool both;

  Network network() const { return both ? mass_between_stops() : mass_before_a_stop(); }
  NetworkValues operator()(double r) const {
    NetworkValues values{.omega = r,
                         .mass = {1.0},
                         .element = {1.0, c, k},
                         .excitation = {{1.0, 0.0}},
                         .second = {0.0, 0.0, 0.0},
                         .bends = {{}, {}, {{D, k, 0.0}}}};
    if (both) values.bends[2].push_back({D, k, 0.0});
    return values;
  }
};

const Stopped between_stops{0.1, 4.0, 1.0, true}, before_a_stop{0.05, 20.0, 0.3, false};

std::vector<SearchedPlace> places(double low, double high, int count) {
  std::vector<SearchedPlace> places;
  for (int i = 0; i < count; ++i) places.push_back({low + (high - low) * i / (count - 1)});
  return places;
}

std::vector<Branch> followed(const Stopped& system, double low, double high,
                             const std::vector<SearchedPlace>& searched) {
  return follow_branches(system.network(), asked, linear(system), {.low = low, .high = high}, {.starts = 16},
                         searched);
}

TEST_CASE("The orbits of a mass between stops are one branch, however many are searched") {
  const std::vector<Branch> branches = followed(between_stops, 1.0, 2.4, places(1.0, 2.4, 29));
  REQUIRE(branches.size() == 1);
  const Branch& branch = branches.front();
  CHECK(branch.first_end == BranchEnd::range);
  CHECK(branch.last_end == BranchEnd::range);
  REQUIRE(branch.special.size() == 3);
  CHECK_THAT(branch.special[0].at.parameter, WithinAbs(2.0018066685, kPrinted));
  CHECK_THAT(branch.special[1].at.parameter, WithinAbs(1.4086707284, kPrinted));
}

TEST_CASE("Numbers of orbits known beforehand save the search and change no branch") {
  std::vector<SearchedPlace> known = places(1.0, 2.4, 29);
  for (SearchedPlace& each : known)
    each.stable = each.parameter > 1.4086707284 && each.parameter < 2.0018066685 ? 2 : 1;
  const auto with = followed(between_stops, 1.0, 2.4, known);
  const auto without = followed(between_stops, 1.0, 2.4, places(1.0, 2.4, 29));
  REQUIRE(with.size() == without.size());
  CHECK(with.front().points.size() == without.front().points.size());
  // A number that the branch has already: nothing is searched where it would be missed.
  for (SearchedPlace& each : known) each.stable = 0;
  CHECK(followed(between_stops, 1.0, 2.4, known).empty());
}

// The stable orbits of a branch at a parameter: the quantities, between its points.
std::vector<double> stable_peaks(const Branch& branch, double parameter) {
  std::vector<double> peaks;
  for (std::size_t i = 1; i < branch.points.size(); ++i) {
    const BranchPoint &a = branch.points[i - 1], &b = branch.points[i];
    if ((a.parameter <= parameter) == (b.parameter <= parameter) || !a.stable || !b.stable) continue;
    const double part = (parameter - a.parameter) / (b.parameter - a.parameter);
    peaks.push_back(std::lerp(a.quantities[0], b.quantities[0], part));
  }
  return peaks;
}

TEST_CASE("Every stable orbit that is found lies on one branch, subharmonics too", "[slow]") {
  constexpr double kCurve = 2e-3;  // of a chord between two points of a branch
  const std::vector<Branch> branches = followed(before_a_stop, 1.0, 5.0, places(1.0, 5.0, 33));
  CHECK(branches.size() >= 2);
  CHECK(std::ranges::any_of(branches, [](const Branch& each) { return each.points.front().multiple > 1; }));
  // A loop closes too where it comes back to its first orbit seen some periods later.
  for (const Branch& branch : branches) {
    CHECK(branch.first_end != BranchEnd::points);
    CHECK(branch.last_end != BranchEnd::points);
  }
  PeriodicResponse response(before_a_stop.network(), {{Measure::peak, 0}, {Measure::coexisting, 0}},
                            Path::fastest, {.starts = 16});
  for (const double r : {1.3, 1.9, 2.6, 3.2, 4.1, 4.9}) {
    INFO("r " << r);
    response.set_values(before_a_stop(r));
    if (response.solve().coexisting == 0) continue;
    double found[2];
    response.quantities(found);
    int here = 0;
    for (const Branch& branch : branches) {
      for (const double peak : stable_peaks(branch, r)) here += std::abs(peak - found[0]) < kCurve ? 1 : 0;
    }
    CHECK(here == 1);
  }
}

// x'' + 0.1 x' + x + rubbing with force f_k, held by up to f_s: cos(r tau).
struct Held {
  double f_k, f_s;

  NetworkValues operator()(double r) const {
    return NetworkValues{.omega = r,
                         .mass = {1.0},
                         .element = {1.0, 0.1, f_k},
                         .excitation = {{1.0, 0.0}},
                         .second = {0.0, 0.0, f_s}};
  }
};

std::vector<Branch> held_branches(double f_k, double f_s) {
  return follow_branches(held_mass(), asked, linear(Held{f_k, f_s}), {.low = 0.2, .high = 1.8}, {},
                         places(0.2, 1.8, 65));
}

std::vector<double> parameters_of(const Branch& branch, SpecialKind kind) {
  std::vector<double> found;
  for (const SpecialPoint& each : branch.special)
    if (each.kind == kind) found.push_back(each.at.parameter);
  return found;
}

TEST_CASE("A branch that goes into another ends there, so that no part is followed twice") {
  const std::vector<Branch> branches = held_branches(0.3, 1.2);
  const auto joins = [](const Branch& each) { return each.last_end == BranchEnd::joined; };
  const auto joining = std::ranges::find_if(branches, joins);
  REQUIRE(joining != branches.begin());
  REQUIRE(joining != branches.end());
  CHECK(joining->first_end == BranchEnd::joined);
  // The sliding response without stops, and rest.
  CHECK(std::ranges::count(branches, BranchEnd::range, &Branch::last_end) == 2);
  for (const BranchPoint& point : joining->points) CHECK(point.parameter < 0.77);
}

TEST_CASE("A branch ends where the static force throws the motion elsewhere, and says so") {
  const std::vector<Branch> branches = held_branches(0.1, 1.2);
  const std::vector<double> grazing = parameters_of(branches.front(), SpecialKind::grazing);
  REQUIRE(grazing.size() == 1);  // of both stops of the symmetric orbit at once
  std::vector<SpecialPoint> jumps;
  for (const Branch& each : branches) {
    if (each.points.front().multiple != 2) continue;
    CHECK(each.first_end == BranchEnd::jump);
    jumps.push_back(each.special.front());
    // Its other end is where orbits of half the period change their events.
    CHECK(each.last_end == BranchEnd::origin);
    CHECK_THAT(each.special.back().at.parameter, WithinAbs(grazing.front(), kSame));
    CHECK(each.special.back().at.arclength > each.points.back().arclength);
  }
  REQUIRE(jumps.size() == 2);  // mirror images of one another
  CHECK_THAT(jumps[0].at.parameter, WithinAbs(jumps[1].at.parameter, kSame));
  for (const SpecialPoint& jump : jumps) {
    CHECK(jump.kind == SpecialKind::jump);
    CHECK(jump.element == 2U);
    CHECK(jump.residual < 1e-9);
  }
}

// Below the value at which both stops of the symmetric orbit begin, three branches of stopping orbits begin.
TEST_CASE(
    "A branch that begins where a symmetric orbit grazes twice at once meets it there, without a jump") {
  const std::vector<Branch> branches = held_branches(0.2, 1.2);
  const std::vector<double> meeting = parameters_of(branches.front(), SpecialKind::grazing);
  REQUIRE(meeting.size() == 1);
  const auto joins = [](const Branch& each) { return each.first_end == BranchEnd::joined; };
  const auto joining = std::ranges::find_if(branches, joins);
  REQUIRE(joining != branches.end());
  CHECK(joining->last_end == BranchEnd::joined);
  for (const SpecialPoint& each : joining->special) CHECK(each.at.parameter < meeting.front());
  // It leads from an orbit to its mirror image, and both halves are alike.
  for (const SpecialKind kind : {SpecialKind::period_doubling, SpecialKind::grazing}) {
    const std::vector<double> both = parameters_of(*joining, kind);
    REQUIRE(both.size() == 2);
    CHECK_THAT(both[0], WithinAbs(both[1], kSame));
  }
  // Halfway it crosses the symmetric branch.
  const std::vector<double> fold = parameters_of(*joining, SpecialKind::fold);
  REQUIRE(fold.size() == 1);
  CHECK_THAT(fold.front(), WithinAbs(parameters_of(branches.front(), SpecialKind::branching).at(0), kSame));
}

TEST_CASE("A branch that comes round to a part of itself ends there, and tells nothing twice") {
  const Branch branch =
      follow_branch(held_mass(), asked, linear(Held{0.2, 0.9}), {.low = 0.2, .high = 1.8, .start = 1.5});
  CHECK(branch.first_end == BranchEnd::joined);
  CHECK(branch.last_end == BranchEnd::range);
  for (const SpecialKind kind : {SpecialKind::fold, SpecialKind::stability_jump})
    CHECK(parameters_of(branch, kind).size() == 1);
  CHECK(parameters_of(branch, SpecialKind::period_doubling).size() == 2);  // of an orbit and its mirror image
  CHECK(parameters_of(branch, SpecialKind::grazing).size() == 3);
}

TEST_CASE("A system of one response has one branch, followed once") {
  const auto values = [](double r) {
    return NetworkValues{.omega = r, .mass = {1.0}, .element = {1.0, 0.1, 0.2}, .excitation = {{1.0, 0.0}}};
  };
  const auto branches = follow_branches(single_mass(), asked, linear(values), {.low = 0.5, .high = 2.0}, {},
                                        places(0.5, 2.0, 7));
  REQUIRE(branches.size() == 1);
  CHECK(branches.front().points.front().parameter == 0.5);
  CHECK_THAT(branches.front().points.back().parameter, WithinAbs(2.0, kSame));
}

}  // namespace
}  // namespace frahm::periodic::coexisting_branches_test
