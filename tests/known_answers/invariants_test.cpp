#include "tests/invariants/invariants.hpp"

#include <catch2/catch.hpp>
#include <cmath>

// The program random_invariants looks for more; it shrinks what it finds.
namespace frahm::invariants {
namespace {

TEST_CASE("What leaves the motion of a random network as it is leaves its response as it is") {
  constexpr std::uint64_t kNetworks = 300;
  for (std::uint64_t seed = 1; seed <= kNetworks; ++seed) {
    for (const Violation& violation : violations_of(draw(seed))) {
      if (violation.standing != Standing::ok) continue;
      INFO("random_invariants --seed " << seed << ": " << violation.invariant << ": " << violation.figure
                                       << " = " << violation.found << ", expected " << violation.expected);
      CHECK(std::abs(violation.found - violation.expected) <= violation.allowed);
    }
  }
}

}  // namespace
}  // namespace frahm::invariants
