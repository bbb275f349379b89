// pulled_trailer.toml: stick and slip by its closed form.
#include <catch2/catch.hpp>

#include "tests/end_to_end/motion_file.hpp"
#include "tests/end_to_end/stick_and_slip.hpp"
#include "tests/study_path.hpp"

namespace pulled_trailer_test {
namespace {

using Catch::Matchers::WithinRel;

TEST_CASE("pulled_trailer.toml: the block jumps at the times and as far as the closed form says") {
  using namespace stick_and_slip;
  const runs::MotionFile file(study_path("pulled_trailer"), "transient");
  check_times(file);
  // At each release the rope is f_s/k longer than at the start.
  CHECK_THAT(file["lag_peak"][0], WithinRel(peak, kExact));
  CHECK_THAT(file["block_displacement"].back() + file["lag_displacement"].back(), WithinRel(V * 5.0, kExact));
  CHECK(file["energy_balance"][0] < 1e-10);
}

}  // namespace
}  // namespace pulled_trailer_test
