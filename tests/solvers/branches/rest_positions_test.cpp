#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "linear_values.hpp"
#include "one_mass.hpp"
#include "solvers/response/periodic_response.hpp"

// Branches on which what sticks for good rests at one of many positions, or at the end of them.
namespace frahm::periodic::rest_positions_test {
namespace {

using namespace mechanics;
using namespace one_mass;

constexpr double kPrinted = 1e-7;  // of orbits found in two ways

// A mass on a spring, a damper and a slider with a spring (stiffness 1), under a force and a steady one.
struct MassWithSlider {
  double frequency = 1.0, slip_force = 0.7, steady = 0.0;

  static Network network() {
    Network network = driven_mass({on_the_mass("slider", ElementType::jenkins)});
    network.excitations.push_back({ExcitationKind::force, 0, 0});
    return network;
  }
  NetworkValues values() const {
    return {.omega = frequency,
            .mass = {1.0},
            .element = {1.0, 0.1, 1.0},
            .excitation = {{1.0, 0.0}, {steady, 0.0}},
            .second = {0.0, 0.0, slip_force}};
  }
};

TEST_CASE("A branch along the force of a slider goes on where the slider slips at the section") {
  const auto values = [](double force) {
    return MassWithSlider{.frequency = 1.1, .slip_force = force}.values();
  };
  // Not the peak: where the slider is stuck for good its offset is one of many.
  const std::vector<Quantity> amplitude{{Measure::amplitude, 0}};
  PeriodicResponse response(MassWithSlider::network(), amplitude);
  double found = 0.0;
  for (const double start : {0.2, 1.0}) {
    const Branch branch = follow_branch(MassWithSlider::network(), amplitude, linear(values),
                                        {.low = 0.2, .high = 2.0, .start = start});
    INFO("from " << start << " " << branch.reason);
    CHECK(branch.first_end == BranchEnd::range);
    CHECK(branch.last_end == BranchEnd::range);
    for (const BranchPoint& point : branch.points) {
      response.set_values(values(point.parameter));
      REQUIRE(response.solve().status == Status::ok);
      response.quantities({&found, 1});
      CHECK(point.quantities[0] == Approx(found).epsilon(kPrinted));
    }
  }
}

// Stuck for good, the slider keeps its offset along the branch, until the end of the interval of offsets
// reaches it: at every place beyond the force would just reach its limit. The steady force does no work on
// the amplitude
//   X = P / sqrt((2 - r^2)^2 + (c r)^2), while the slider is stuck
TEST_CASE("A branch goes on where the rest position of a stuck slider meets the end of its interval") {
  constexpr double kDamping = 0.1;
  const auto values = [](double r) { return MassWithSlider{.frequency = r, .steady = 0.3}.values(); };
  const Branch branch = follow_branch(MassWithSlider::network(), {{Measure::amplitude, 0}}, linear(values),
                                      {.low = 0.3, .high = 3.0, .start = 2.5});
  CHECK(branch.first_end == BranchEnd::range);
  CHECK(branch.last_end == BranchEnd::range);
  CHECK(branch.points.size() < 1000);
  int stuck = 0;
  for (const BranchPoint& point : branch.points) {
    const double r = point.parameter;
    const double amplitude = 1.0 / std::hypot(2.0 - r * r, kDamping * r);
    if (amplitude > 0.7) continue;  // of the slip force
    CHECK(point.quantities[0] == Approx(amplitude).epsilon(kPrinted));
    ++stuck;
  }
  CHECK(stuck > 30);
}

TEST_CASE("A branch starts where what rests is at the end of its interval, at the end of the range too") {
  const auto values = [](double amplitude) {
    NetworkValues at = MassWithSlider{.frequency = 0.5, .slip_force = 0.5, .steady = 1.2}.values();
    at.excitation[0].amplitude = amplitude;
    return at;
  };
  const Branch branch = follow_branch(MassWithSlider::network(), {{Measure::peak, 0}}, linear(values),
                                      {.low = 0.1, .high = 2.0, .start = 0.1});
  INFO(branch.reason);
  CHECK(branch.reason.empty());
  CHECK(branch.last_end == BranchEnd::range);
}

}  // namespace
}  // namespace frahm::periodic::rest_positions_test
