// block_on_belt.toml: stick and slip by its closed form.
#include <catch2/catch.hpp>

#include "tests/end_to_end/motion_file.hpp"
#include "tests/end_to_end/stick_and_slip.hpp"
#include "tests/study_path.hpp"

namespace block_on_belt_test {
namespace {

using Catch::Matchers::WithinRel;

TEST_CASE("block_on_belt.toml: period, time of sticking and amplitude are those of the closed form") {
  using namespace stick_and_slip;
  const runs::MotionFile file(study_path("block_on_belt"), "transient");
  check_times(file);
  CHECK(file["friction_stop_onset"].size() == 12);  // it rides from the start, then once in each period
  CHECK_THAT(file["block_peak"][0], WithinRel(peak, kExact));
  CHECK(file["energy_balance"][0] < 1e-10);
  CHECK(file["energy_input"][0] > file["friction_energy"][0]);  // the rest is in the spring at the end
}

}  // namespace
}  // namespace block_on_belt_test
