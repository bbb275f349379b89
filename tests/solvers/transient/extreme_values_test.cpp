#include <catch2/catch.hpp>

#include "solvers/transient/free_decay.hpp"

// Values of a size that no machine has: refused with their reason, never a crash.
namespace frahm::transient::extreme_values_test {
namespace {

using mechanics::ElementType, mechanics::Network, mechanics::NetworkValues, mechanics::Node,
    mechanics::NodeKind;

FreeDecay decay(double mass, double damping) {
  const Node ground{}, body{NodeKind::mass, 0};
  const Network network{.masses = {"body"},
                        .elements = {{"spring", ElementType::spring, ground, body},
                                     {"damper", ElementType::damper, ground, body}}};
  const NetworkValues values{.omega = 1.0, .mass = {mass}, .element = {1.0, damping}};
  return free_decay(network, values, {{1.0}, {0.0}}, {});
}

TEST_CASE("A decay whose fastest motion has no finite rate is refused with the reason") {
  const char* reason = "fastest motion has no finite rate";
  CHECK_THROWS_WITH(decay(1.0, 1e300), Catch::Contains(reason));
  CHECK_THROWS_WITH(decay(1e-300, 1e10), Catch::Contains(reason));
}

TEST_CASE("A decay that is too stiff to be followed far has its energies all the same") {
  const FreeDecay found = decay(1.0, 1e100);
  CHECK(found.end == DecayEnd::cut_off);
  REQUIRE(found.energy.dissipated.size() == 2);
  CHECK(found.energy.initial == 0.5);
}

}  // namespace
}  // namespace frahm::transient::extreme_values_test
