#include "tests/invariants/invariants.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

// The program random_invariants looks for more; it shrinks what it finds.
namespace frahm::invariants::invariants_test {
namespace {

// What of the invariants the network breaks, as text: by all answers, or those that stand without doubt.
enum class Of { all, ok };
std::string broken_by(std::uint64_t seed, Of answers) {
  std::string broken;
  for (const Violation& violation : violations_of(draw(seed))) {
    if (answers == Of::ok && violation.standing != Standing::ok) continue;
    if (std::abs(violation.found - violation.expected) <= violation.allowed) continue;
    broken += fmt::format("{}: {} = {}, expected {}\n", violation.invariant, violation.figure,
                          violation.found, violation.expected);
  }
  return broken;
}

TEST_CASE("What leaves the motion of a random network as it is leaves its response as it is", "[slow]") {
  constexpr std::uint64_t kNetworks = 500;
  for (std::uint64_t seed = 1; seed <= kNetworks; ++seed) {
    INFO("random_invariants --seed " << seed);
    CHECK(broken_by(seed, Of::ok) == "");
  }
}

// 503736: friction holds a mass against a force through 10^4 steps. 504224: two contacts hold for ever, one
// on a weak spring; the search came from afar. 603720, 626547, 666023, 673959, 668320, 623420: contacts in
// loops share forces, at their limits and off them again. 646138: one between masses that rest on the same
// support. 4929, 2001696: where a contact creeps to its limit for ever, the half-period map turned the state
// over and over. 2006082: of contacts in a loop one that rests by the others was taken for one that slides.
// 3510: one carries its limit at times while the others hold it, and another was let go. 2045923: held
// contacts were reported shares of a loop beyond their limits that others can carry. 2048026: Newton's method
// led to where friction of 10^6 holds a mass far off, and the map brings it back by 2 a period. 2250325,
// 2285211: a search that came from as far was left there, as a limit of 10^-5 was passed by the rounding of
// such forces. 2285794: a mass slides by 10^-7 around a place that a static force moves it to, whose work is
// rounded.
TEST_CASE("Networks that once broke an invariant keep them all") {
  for (const std::uint64_t seed : {3510,    4929,    503736,  504224,  603720,  605939,  623420,  626547,
                                   646138,  666023,  666224,  668320,  673959,  2001696, 2006082, 2045923,
                                   2048026, 2149564, 2178322, 2234578, 2285794, 2250325, 2285211}) {
    INFO("random_invariants --seed " << seed);
    CHECK(broken_by(seed, Of::all) == "");
  }
}

}  // namespace
}  // namespace frahm::invariants::invariants_test
