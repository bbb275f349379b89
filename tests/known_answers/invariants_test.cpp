#include "tests/invariants/invariants.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

// The program random_invariants looks for more; it shrinks what it finds.
namespace frahm::invariants {
namespace {

TEST_CASE("What leaves the motion of a random network as it is leaves its response as it is", "[slow]") {
  constexpr std::uint64_t kNetworks = 500;
  for (std::uint64_t seed = 1; seed <= kNetworks; ++seed) {
    std::string broken;
    for (const Violation& violation : violations_of(draw(seed))) {
      if (violation.standing != Standing::ok) continue;
      if (std::abs(violation.found - violation.expected) <= violation.allowed) continue;
      broken += fmt::format("{}: {} = {}, expected {}\n", violation.invariant, violation.figure,
                            violation.found, violation.expected);
    }
    INFO("random_invariants --seed " << seed);
    CHECK(broken == "");
  }
}

}  // namespace
}  // namespace frahm::invariants
