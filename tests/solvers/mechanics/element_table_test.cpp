#include "solvers/mechanics/element_table.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "solvers/mechanics/linear_system.hpp"

namespace frahm::mechanics::element_table_test {
namespace {

using Catch::WithinAbs;

TEST_CASE("Each kind of element stands where its enumerator says, under a name of its own") {
  const auto kinds = element_kinds();
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    INFO(kinds[i].name);
    CHECK(static_cast<std::size_t>(kinds[i].type) == i);
    CHECK(&kind_of(kinds[i].type) == &kinds[i]);
    CHECK(kinds[i].value.exists());
    for (std::size_t j = 0; j < i; ++j) CHECK(std::string(kinds[i].name) != kinds[j].name);
  }
}

TEST_CASE("The derivative of what an element adds agrees with differences, of every kind") {
  constexpr double kStep = 1e-6, kTolerance = 1e-8;
  const Dual value{1.7, 0.6}, second{0.4, -0.9}, omega_h{2.3, 1.4};
  for (const ElementKind& kind : element_kinds()) {
    INFO(kind.name);
    const auto moved = [&](double by) {
      const auto at = [&](Dual number) { return number.value + by * number.derivative; };
      return kind.adds(at(value), at(second), at(omega_h));
    };
    const Added<double> above = moved(kStep), below = moved(-kStep), here = moved(0.0);
    const Added<Dual> added = kind.adds(value, second, omega_h);
    const auto agrees = [&](auto term) {
      CHECK((added.*(term.second)).value == here.*(term.first));
      CHECK_THAT((added.*(term.second)).derivative,
                 WithinAbs((above.*(term.first) - below.*(term.first)) / (2.0 * kStep), kTolerance));
    };
    agrees(std::pair{&Added<double>::stiffness, &Added<Dual>::stiffness});
    agrees(std::pair{&Added<double>::damping, &Added<Dual>::damping});
    agrees(std::pair{&Added<double>::inertance, &Added<Dual>::inertance});
    agrees(std::pair{&Added<double>::limit, &Added<Dual>::limit});
    agrees(std::pair{&Added<double>::internal_stiffness, &Added<Dual>::internal_stiffness});
    agrees(std::pair{&Added<double>::internal_rate, &Added<Dual>::internal_rate});
    agrees(std::pair{&Added<double>::internal_damping, &Added<Dual>::internal_damping});
  }
}

TEST_CASE("What a row says of its kind is what the kind adds") {
  for (const ElementKind& kind : element_kinds()) {
    INFO(kind.name);
    const Added<double> here = kind.adds(1.7, 0.4, 2.3), elsewhere = kind.adds(1.7, 0.4, 4.6);
    CHECK((here.limit != 0.0) == (kind.law != nullptr));
    CHECK((here.internal_stiffness != 0.0) == kind.has_internal_force);
    CHECK((here.stiffness != 0.0) == kind.holds);
    const bool loses = here.damping != 0.0 || here.internal_damping != 0.0 || here.limit != 0.0;
    CHECK((loses || kind.stop != nullptr) == kind.dissipates);
    CHECK((here.damping != elsewhere.damping) == kind.depends_on_frequency);
    CHECK(kind.is_inertia_alone() == (kind.type == ElementType::inerter));
    if (kind.law != nullptr) CHECK(kind.has_internal_force == !kind.law->holds_velocity);
  }
}

TEST_CASE("A contact knows its law, and that no internal force is its own under Coulomb's") {
  const Node ground{}, mass{NodeKind::mass, 0};
  const Network network{.masses = {"m"},
                        .elements = {{"k", ElementType::spring, ground, mass},
                                     {"z", ElementType::maxwell, ground, mass},
                                     {"f", ElementType::coulomb, ground, mass}}};
  const Assembly assembly(network);
  LinearSystem system;
  assembly.set_values({1.0, {1.0}, {1.0, 2.0, 0.5}, {}, {0.0, 4.0, 0.0}}, system);
  REQUIRE(system.law.size() == 1);
  CHECK(std::string(system.law[0]->name) == "coulomb");
  CHECK(system.contact_internal == std::vector<Eigen::Index>{-1});
  CHECK(system.coefficients[1].internal == 0);
  CHECK(system.coefficients[2].internal == -1);
  CHECK(system.internal_rate[0] == 0.5);
}

TEST_CASE(
    "A Jenkins element is a contact of its own, whose force is an internal one that no damper lets go") {
  const Node ground{}, mass{NodeKind::mass, 0};
  const Network network{.masses = {"m"},
                        .elements = {{"k", ElementType::spring, ground, mass},
                                     {"z", ElementType::maxwell, ground, mass},
                                     {"f", ElementType::coulomb, ground, mass},
                                     {"j1", ElementType::jenkins, mass, ground},
                                     {"j2", ElementType::jenkins, mass, ground}}};
  const Assembly assembly(network);
  LinearSystem system;
  assembly.set_values({1.0, {1.0}, {1.0, 2.0, 0.5, 3.0, 5.0}, {}, {0.0, 4.0, 0.0, 0.7, 0.8}}, system);
  REQUIRE(system.contacts() == 3);
  CHECK(std::string(system.law[1]->name) == "jenkins");
  CHECK(system.contact_internal == std::vector<Eigen::Index>{-1, 1, 2});
  CHECK(system.W.col(1) == system.D.col(1));
  CHECK(system.W(0, 1) == -1.0);
  CHECK(system.limit[1] == 0.7);
  CHECK(system.limit[2] == 0.8);
  CHECK(system.internal_stiffness[2] == 5.0);
  CHECK(system.internal_rate[1] == 0.0);
  CHECK(system.coefficients[3].internal_damping == 0.0);
  CHECK(system.K(0, 0) == 1.0);  // what only unloads holds nothing in its place
}

TEST_CASE("A massless node that a spring and a slider meet in is told of the jenkins element") {
  const Node ground{}, mass{NodeKind::mass, 0}, joint{NodeKind::mass, 1};
  const Network network{.masses = {"m", "joint"},
                        .elements = {{"k", ElementType::spring, ground, mass},
                                     {"brace", ElementType::spring, mass, joint},
                                     {"slider", ElementType::coulomb, ground, joint}}};
  const Assembly assembly(network);
  LinearSystem system;
  CHECK_THROWS_WITH(assembly.set_values({1.0, {1.0, 0.0}, {1.0, 3.0, 0.7}, {}}, system),
                    Catch::Contains("a spring and a slider in series are one jenkins element"));
}

}  // namespace
}  // namespace frahm::mechanics::element_table_test
